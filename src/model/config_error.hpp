// The one error that bad input raises: robot.yaml, URDF, clips, scenarios. Apps print what() and exit with 2.
#pragma once

#include <stdexcept>
#include <string>

namespace pmg::model {

/// what() is one line: "FILE:LINE:COLUMN: KEY: what is wrong; expected what". Line and column are left out where the input
/// has none.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace pmg::model
