// What pmg_send is asked for.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "arms_operator/arms_lead.hpp"
#include "operator/mode_wish.hpp"
#include "pmg/command.hpp"

namespace pmg::apps {

struct SendArguments {
  std::string request;
  std::string robot, lcm_url, keys;
  double timeout_s = 0.0;  // 0: the default of each request
  double duration_s = 0.0;
  Command command;
  PerFoot<std::vector<double>> palm;  // x, y, z [m], and roll, pitch, yaw [rad] or nothing; empty: that arm isn't led
  bool hand_back = false;
  bool json = false;
};

struct SendRequest {
  const char* name;
  ops::Goal goal;
  double timeout_s;  ///< entering Stand takes 5 s at the longest
  const char* help;
};

inline constexpr SendRequest kSendRequests[] = {
    {"stop", ops::Goal::kStop, 2.0, "brake (damping) every robot on the address, or the one of --robot"},
    {"damping", ops::Goal::kDamping, 2.0, "drives brake, no position"},
    {"passive", ops::Goal::kPassive, 2.0, "drives limp; a robot that stands only brakes when told once"},
    {"stand", ops::Goal::kStand, 10.0, "stand, from the posture that is measured"},
    {"reset", ops::Goal::kReset, 2.0, "leave a latched fault for damping, if its cause is gone"},
};
inline constexpr double kDriveTimeout_s = 10.0;
/// 15 s to catch and lift a robot that lies on the ground, where the simulation keeps its time; it waits for a slow
/// computer. A hoist that falls silent is told at once.
inline constexpr double kHoistTimeout_s = 60.0;
inline constexpr const char *kLift = "lift", *kLower = "lower", *kArms = "arms";

void declare(CLI::App& app, SendArguments& arguments);

/// Of --left, --right and --hand-back. Throws std::invalid_argument when they ask for nothing, or for both.
PerFoot<ops::PalmGoal> palm_goals(const SendArguments& arguments);

}  // namespace pmg::apps
