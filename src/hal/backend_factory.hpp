// The backends of a build, by name. apps/ calls register_backend() of every room that has one.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hal/backend.hpp"

namespace pmg::hal {

/// --NAME on the command line.
struct BackendOption {
  std::string name, help;
  OptionValue value;  ///< unless given; bool: a flag
};

struct BackendKind {
  std::string name;     ///< --hal NAME
  std::string summary;  ///< after the name: "MuJoCo in place of the drives"
  std::vector<BackendOption> options;
  std::function<std::unique_ptr<Backend>(const BackendSetup&)> make;
};

class BackendFactory {
 public:
  /// Throws std::logic_error when there is a backend of this name.
  void add(BackendKind kind);
  /// A backend that this build doesn't contain: help and errors say so. what: "CAN backend".
  void lacks(const std::string& name, const std::string& what);

  const std::vector<BackendKind>& kinds() const { return kinds_; }
  std::vector<std::string> names() const;  ///< that a user may know, those that lack included
  std::string help() const;                ///< of --hal

  /// Throws std::invalid_argument when this build has no such backend: the line names those that it has.
  const BackendKind& kind(const std::string& name) const;

 private:
  std::vector<BackendKind> kinds_;
  std::vector<std::pair<std::string, std::string>> lacking_;  // name, what
};

}  // namespace pmg::hal
