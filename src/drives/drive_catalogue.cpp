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

std::vector<std::string> DriveCatalogue::protocols() const {
  std::vector<std::string> names;
  for (const auto& known : read_) names.push_back(known.first);
  return names;
}

DriveKind DriveCatalogue::read(files::ConfigReader reader) const {
  const std::string name = reader.one_of("protocol", protocols());
  const auto known = std::ranges::find(read_, name, &std::pair<std::string, Read>::first);
  DriveKind kind = known->second(reader);
  reader.finish();
  return kind;
}

}  // namespace pmg::drives
