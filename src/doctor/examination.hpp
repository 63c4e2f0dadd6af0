// All that the doctor looks at, for a robot, a backend, and how the controller is started.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "doctor/checks.hpp"

namespace pmg::doctor {

/// The computer, as a controller with these settings uses it.
struct ControllerNeeds {
  bool realtime = true;
  int priority = 80;  ///< the highest that it asks for
  RealtimeCpus cpus;
  std::vector<can::BusSetup> can_buses;  ///< that it drives motors on
  std::vector<std::string> cards;        ///< that EtherCAT has for itself
  std::optional<model::SerialImuModel> imu;
  std::filesystem::path log;  ///< empty: no log
};

/// What concerns a controller that is about to drive these motors.
Findings examine_for_controller(const Host& host, const ControllerNeeds& needs, const Limits& limits = {});

/// "ok    kernel: PREEMPT_RT", and for others a second line with what to do.
std::vector<std::string> to_lines(const Finding& finding);
nlohmann::ordered_json to_json(const Findings& findings);

/// One line of all failures: the first and the number of others. Empty: none.
std::string refusal(const Findings& findings);

}  // namespace pmg::doctor
