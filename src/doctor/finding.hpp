// What the doctor says of one thing.
#pragma once

#include <string>
#include <vector>

namespace pmg::doctor {

enum class Verdict {
  kOk,
  kWarn,  ///< the robot can run; something is worse than it could be, or isn't known
  kFail,  ///< a robot with this must not stand
};

struct Finding {
  std::string check;  ///< what was looked at: "kernel", "can0 bit rate"
  Verdict verdict = Verdict::kOk;
  std::string found;   ///< what is so, and what was expected
  std::string remedy;  ///< the command that mends it; empty with kOk
};
using Findings = std::vector<Finding>;

inline Finding ok(std::string check, std::string found) {
  return {std::move(check), Verdict::kOk, std::move(found), {}};
}
inline Finding warn(std::string check, std::string found, std::string remedy) {
  return {std::move(check), Verdict::kWarn, std::move(found), std::move(remedy)};
}
inline Finding fail(std::string check, std::string found, std::string remedy) {
  return {std::move(check), Verdict::kFail, std::move(found), std::move(remedy)};
}

}  // namespace pmg::doctor
