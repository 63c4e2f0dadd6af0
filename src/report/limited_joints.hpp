// (LIMITED messages) => the joints whose targets the limiter changed, with times and reasons.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pmg_msgs/limited_t.hpp"

namespace pmg::report {

inline constexpr std::size_t kMostStretches = 4096;  ///< of a joint: more than a picture shows
inline constexpr std::array<const char*, 3> kLimitNames = {"range", "speed", "torque"};

struct LimitedJoint {
  std::size_t joint = 0;
  std::array<std::int64_t, 3> ticks{};  ///< by its range, its speed, its torque
  std::int64_t any_ticks = 0;           ///< by at least one of them

  struct Stretch {
    double from_s, to_s;
    std::array<bool, 3> by;
  };
  std::vector<Stretch> stretches;  ///< each with one set of reasons; beyond kMostStretches neighbours are joined
  double longest_s = 0.0;          ///< of the stretches before they were joined

  std::string reasons() const;  ///< "torque in 12 ticks, speed in 3"
};

class LimitedJoints {
 public:
  void add(double t_s, const pmg_msgs::limited_t& message);
  std::vector<LimitedJoint> most_first() const;  ///< by any_ticks

 private:
  std::vector<LimitedJoint> joints_;  ///< in the order of their first time
};

}  // namespace pmg::report
