#include "runtime/control_setup.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "hal/bus_cycle.hpp"
#include "model/bundle.hpp"
#include "model/clip_library_file.hpp"

namespace pmg::runtime {

namespace {

namespace fs = std::filesystem;

std::unique_ptr<policy::Policy> load_policy(const std::string& name, const model::RobotModel& robot) {
  if (name == "none") return std::make_unique<policy::ReferencePolicy>();
  const fs::path file = robot.directory / "policies" / (name + ".onnx");
  if (!fs::exists(file)) {
    throw std::invalid_argument(
        fmt::format("--policy {}: there is no {}; expected the name of a policy there, or none", name, file.string()));
  }
  throw std::invalid_argument(fmt::format("--policy {}: this build can't run ONNX policies yet; expected none", name));
}

Blend blend_named(const std::string& name) {
  if (name == "gain") return Blend::kGain;
  if (name == "paper") return Blend::kPaper;
  throw std::invalid_argument(fmt::format("--blend {}: expected gain or paper", name));
}

nlohmann::ordered_json channels_json(const std::array<double, kChannels>& values) {
  nlohmann::ordered_json json;
  for (std::size_t i = 0; i < kChannels; ++i) json[kChannelNames[i]] = values[i];
  return json;
}

nlohmann::ordered_json tick_json(const TickOptions& tick) {
  const FaultLimits& faults = tick.supervisor.fault_limits;
  return {{"control_period_s", tick.dt_s},
          {"command",
           {{"lower", channels_json(tick.generator.limits.lower)},
            {"upper", channels_json(tick.generator.limits.upper)},
            {"rate_per_s", channels_json(tick.generator.limits.rate_per_s)}}},
          {"gco", {{"prior_weight", tick.gco.prior_weight}, {"optimise_roll_pitch", tick.gco.optimise_roll_pitch}}},
          {"limiter", {{"target_rate_factor", tick.limiter.target_rate_factor}}},
          {"entry",
           {{"speed_rad_s", tick.entry.speed_rad_s},
            {"shortest_s", tick.entry.shortest_s},
            {"longest_s", tick.entry.longest_s}}},
          {"supervisor",
           {{"stale_command_s", tick.supervisor.stale_command_s}, {"stop_within_s", tick.supervisor.stop_within_s}}},
          {"faults",
           {{"stale_state_s", faults.stale_state_s},
            {"temperature_degC", faults.temperature_degC},
            {"joint_limit_margin_rad", faults.joint_limit_margin_rad},
            {"velocity_factor", faults.velocity_factor},
            {"torque_factor", faults.torque_factor},
            {"tilt_rad", faults.tilt_rad},
            {"persist_ticks", faults.persist_ticks}}}};
}

}  // namespace

LoadedControl load_control(const ControlSetup& setup) {
  LoadedControl loaded;
  loaded.robot = model::load_robot(model::find_robot(setup.robot));
  loaded.clips = setup.clips.empty() ? loaded.robot.directory / "clips" : setup.clips;
  loaded.library = model::load_clip_library(loaded.clips, loaded.robot);
  loaded.policy = load_policy(setup.policy, loaded.robot);
  loaded.options = tick_options(loaded.robot);
  loaded.options.generator.blend = blend_named(setup.blend);
  model::Bundle bundle = model::bundle(loaded.robot, loaded.clips);
  loaded.bundle = std::move(bundle.sha256);
  loaded.files = std::move(bundle.files);
  return loaded;
}

std::unique_ptr<Tick> make_tick(LoadedControl& loaded, const io::Clock& stopwatch) {
  return std::make_unique<Tick>(loaded.robot, std::move(loaded.library), std::move(loaded.policy), stopwatch,
                                loaded.options);
}

nlohmann::ordered_json control_json(const ControlSetup& setup, const LoadedControl& loaded) {
  nlohmann::ordered_json json = {{"robot", loaded.robot.directory.string()},
                                 {"clips", loaded.clips.string()},
                                 {"policy", setup.policy},
                                 {"blend", setup.blend},
                                 {"bus_period_s", static_cast<double>(hal::BusCycle::kPeriod_ns) * 1e-9}};
  json.update(tick_json(loaded.options));
  return json;
}

}  // namespace pmg::runtime
