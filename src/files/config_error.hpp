// The error of every bad input: robot.yaml, URDF, clips, scenarios. Apps print what() and exit with 2.
#pragma once

#include <stdexcept>
#include <string>

namespace pmg::files {

/// what() is one line: "FILE:LINE:COLUMN: KEY: what is wrong; expected what". Line and column are missing where the
/// input has none.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A position in an input. Line and column count from 1; 0 means that the input has none.
struct Place {
  std::string file;
  int line = 0;
  int column = 0;
};

/// Throws the ConfigError with this text. The key may be empty.
[[noreturn]] inline void raise(const Place& place, const std::string& key, const std::string& wrong,
                               const std::string& expected) {
  std::string text = place.file;
  if (place.line > 0) text += ":" + std::to_string(place.line);
  if (place.line > 0 && place.column > 0) text += ":" + std::to_string(place.column);
  text += ": ";
  if (!key.empty()) text += key + ": ";
  text += wrong;
  if (!expected.empty()) text += "; expected " + expected;
  throw ConfigError(text);
}

}  // namespace pmg::files
