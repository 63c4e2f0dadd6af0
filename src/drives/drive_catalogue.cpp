#include "drives/drive_catalogue.hpp"

#include <algorithm>

namespace pmg::drives {

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
