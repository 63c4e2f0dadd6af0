// The protocols that robot.yaml may name.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "drives/drive_type.hpp"

namespace pmg::drives {

class DriveCatalogue {
 public:
  using Read = std::function<DriveKind(files::ConfigReader&)>;

  /// One more, or another meaning of a name. read: makes a kind from an entry of `drives`; it asks for every key it
  /// knows besides `protocol`.
  void add(const std::string& protocol, Read read);
  std::vector<std::string> protocols() const;  ///< the names, in the order in which they came
  /// One entry of `drives`. Throws files::ConfigError.
  DriveKind read(files::ConfigReader reader) const;

 private:
  std::vector<std::pair<std::string, Read>> read_;  // in the order of an error's text
};

}  // namespace pmg::drives
