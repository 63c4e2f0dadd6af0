// What an operator does next so that the robot stands: (what controller and hoist say) => steps, in a device's words.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "operator/device.hpp"
#include "operator/operator_source.hpp"
#include "operator/robot_board.hpp"

namespace pmg::ops {

/// What is known of a robot, as far as it decides the way up.
struct Posture {
  std::int8_t mode = 0;                    ///< of pmg_msgs::mode_t
  std::optional<double> tilt_rad{};        ///< of the IMU's link from upright; nothing: not known
  bool down = false;                       ///< it leans farther than a robot may that is to stand up
  std::optional<std::int8_t> hoist{};      ///< of pmg_msgs::hoist_state_t; nothing: there is no hoist, or it is silent
  bool stays_up = false, hanging = false;  ///< as hoist_state_t and status_t have them
};

/// news: null: STATE and ROBOT_INFO aren't known, so nothing tells how far the robot leans.
Posture posture(const HeardRobot& heard, const RobotNews* news, std::int64_t now_ns);
Posture posture(const RobotNews& news, std::int64_t now_ns);

/// One thing to do, or to wait for.
enum class Step : std::uint8_t {
  kLift,        ///< by the hoist
  kPutUp,       ///< by people or a crane that listens to nobody
  kAwaitHoist,  ///< it is on its way up
  kReset,
  kStand,
  kSetDown,
};

/// In their order; empty: the robot stands on its feet or walks.
std::vector<Step> steps_up(const Posture& posture);

/// "lies (1.38 rad from upright): H lifts it, then R resets it, then Enter makes it stand up". Empty: as steps_up().
std::string way_up(const Posture& posture, const DeviceManner& manner);

/// The manner of somebody at a shell.
DeviceManner shell_manner();

}  // namespace pmg::ops
