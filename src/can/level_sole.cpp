#include "can/level_sole.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "can/linked_wiggle.hpp"
#include "can/plumb.hpp"
#include "model/hanging_load.hpp"
#include "pmg/types.hpp"

namespace pmg::can {

namespace {

// A floor, an IMU and three zeros are each a degree or two off.
constexpr double kLevel_rad = 5.0 * kRadPerDegree;
// Beyond it a sole isn't level: as much again, so that a true connection at the limit above is never ruled out.
constexpr double kNotLevel_rad = 2.0 * kLevel_rad;

}  // namespace

Verdict verdict_of_level_sole(const model::RobotModel& robot, const JointVector& q, const BusSetup& bus,
                              const drives::MotorSetup& motor, const Eigen::Vector3d& down_B) {
  using Tells = Verdict::Tells;
  const auto sole = std::ranges::find_if(
      robot.feet, [&](const model::FootModel& foot) { return model::beyond(robot, motor.joint, foot.link); });
  if (sole == robot.feet.end())
    throw std::invalid_argument(motor.joint + " is above no sole; expected a joint of a leg");
  const auto tilt_rad = [&](const JointVector& at) {
    const Eigen::Vector3d up_B = link_in_base(robot, sole->link, at) * Eigen::Vector3d::UnitZ();
    return std::acos(std::clamp(-down_B.dot(up_B), -1.0, 1.0));
  };
  std::vector<int> joints;
  for (const std::string& joint : linked_joints(bus, motor)) joints.push_back(robot.joint_index.at(joint));
  if (joints.empty()) joints = {motor.index};

  std::vector<std::string> possible, look;
  double least_rad = std::numbers::pi;
  for (const Connection& one : connections(bus, motor, cranks_at(bus, motor, q))) {
    JointVector at = q;
    for (std::size_t j = 0; j < joints.size(); ++j) at[joints[j]] = one.joint_rad[j];
    const double off_rad = tilt_rad(at);
    least_rad = std::min(least_rad, off_rad);
    if (off_rad > kNotLevel_rad) continue;
    possible.push_back(one.words);
    look.push_back(fmt::format("{}: the sole is {:.1f} deg off level",
                               one.words.empty() ? "as robot.yaml has it" : "if " + one.words,
                               off_rad / kRadPerDegree));
  }
  if (least_rad > kLevel_rad)
    return {
        Tells::kWrong,
        fmt::format("no way to connect these motors puts the sole level, the best is {:.1f} deg off: it doesn't lie "
                    "level, or another joint of the leg, a zero or the IMU is wrong",
                    least_rad / kRadPerDegree)};
  Verdict verdict = verdict_of(
      possible,
      {.name = "the sole's angle",
       .advice = "with the sole level, incline the shank by 10 degrees to the side and 25 forward or backward",
       .seems = "the sole lies"});
  if (possible.size() > 1) verdict.look = look;
  return verdict;
}

}  // namespace pmg::can
