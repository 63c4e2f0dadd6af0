#include "drives/drive_catalogue.hpp"

#include <algorithm>

#include "drives/canopen_drive.hpp"
#include "drives/damiao.hpp"
#include "drives/mini_cheetah.hpp"
#include "drives/mit_drive.hpp"
#include "drives/robstride.hpp"

namespace pmg::drives {

DriveCatalogue DriveCatalogue::standard() {
  DriveCatalogue catalogue;
  catalogue.add("mit", [](files::ConfigReader& reader) { return std::make_shared<MitDrive>(read_mit_ranges(reader)); });
  catalogue.add("damiao",
                [](files::ConfigReader& reader) { return std::make_shared<DamiaoDrive>(read_mit_ranges(reader)); });
  catalogue.add("mini_cheetah", [](files::ConfigReader& reader) {
    return std::make_shared<MiniCheetahDrive>(read_mit_ranges(reader));
  });
  catalogue.add("robstride", [](files::ConfigReader& reader) {
    return std::make_shared<RobstrideDrive>(read_mit_ranges(reader, RobstrideDrive::kReplyId));
  });
  catalogue.add("cia402",
                [](files::ConfigReader& reader) { return std::make_shared<CanopenDrive>(read_cia402(reader)); });
  return catalogue;
}

void DriveCatalogue::add(const std::string& protocol, Read read) {
  const auto known = std::ranges::find(read_, protocol, &std::pair<std::string, Read>::first);
  if (known == read_.end()) {
    read_.emplace_back(protocol, std::move(read));
  } else {
    known->second = std::move(read);
  }
}

DriveKind DriveCatalogue::read(files::ConfigReader reader) const {
  std::vector<std::string> names;
  for (const auto& known : read_) names.push_back(known.first);
  const std::string name = reader.one_of("protocol", names);
  const auto known = std::ranges::find(read_, name, &std::pair<std::string, Read>::first);
  DriveKind kind = known->second(reader);
  reader.finish();
  return kind;
}

}  // namespace pmg::drives
