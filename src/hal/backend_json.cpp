#include "hal/backend_json.hpp"

#include <nlohmann/json.hpp>

namespace pmg::hal {

void add_to(nlohmann::ordered_json& json, const BackendDescription& description) {
  if (description.drive_sampling_s) json["drive_sampling_s"] = *description.drive_sampling_s;
  if (description.command_delay_s) json["command_delay_s"] = *description.command_delay_s;
  if (description.older_by_s > 0.0) {
    json["older_joints"] = description.older_joints;
    json["older_imu"] = description.older_imu;
    json["older_by_s"] = description.older_by_s;
  }
  if (!description.closed_by_bus.empty()) {
    json["closed_by_bus"] = description.closed_by_bus;
    json["bus_loop_age_s"] = description.bus_loop_age_s;
  }
  if (!description.own_gains.empty()) json["own_gains"] = description.own_gains;
  if (description.set_on_simulator) json["set_on_simulator"] = *description.set_on_simulator;
}

}  // namespace pmg::hal
