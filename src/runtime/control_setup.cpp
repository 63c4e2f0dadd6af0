#include "runtime/control_setup.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "hal/bus_cycle.hpp"
#include "model/bundle.hpp"
#include "model/clip_library_file.hpp"
#include "policy/onnx_policy.hpp"

namespace pmg::runtime {

namespace {

namespace fs = std::filesystem;

/// Below the robot's policies/, or the file itself. Nothing for none.
std::optional<fs::path> policy_file(const std::string& name, const model::RobotModel& robot) {
  if (name == "none") return std::nullopt;
  const fs::path file =
      fs::path(name).extension() == ".onnx" ? fs::path(name) : robot.directory / "policies" / (name + ".onnx");
  if (!fs::exists(file)) {
    throw std::invalid_argument(
        fmt::format("--policy {}: there is no {}; expected the name of a policy there, an ONNX file, or none", name,
                    file.string()));
  }
  return file;
}

std::unique_ptr<policy::Policy> load_policy(const std::optional<fs::path>& file, const LoadedControl& loaded) {
  if (!file) return std::make_unique<policy::ReferencePolicy>();
  return std::make_unique<policy::OnnxPolicy>(*file, loaded.robot, model::clip_library_sha256(loaded.clips),
                                              1.0 / loaded.options.dt_s);
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
           {{"stale_command_s", tick.supervisor.stale_command_s},
            {"stop_within_s", tick.supervisor.stop_within_s},
            {"gco_held_ticks", tick.supervisor.gco_held_ticks}}},
          {"late_policy_ticks", tick.late_policy_ticks},
          {"action_monitor",
           {{"bound_rad", tick.action_monitor.bound_rad}, {"persist_ticks", tick.action_monitor.persist_ticks}}},
          {"faults",
           {{"stale_state_s", faults.stale_state_s},
            {"stale_state_ticks", faults.stale_state_ticks},
            {"temperature_degC", faults.temperature_degC},
            {"joint_limit_margin_rad", faults.joint_limit_margin_rad},
            {"velocity_factor", faults.velocity_factor},
            {"torque_factor", faults.torque_factor},
            {"tilt_rad", faults.tilt_rad},
            {"torso_error_rad", faults.torso_error_rad},
            {"persist_ticks", faults.persist_ticks}}}};
}

}  // namespace

LoadedControl load_control(const ControlSetup& setup) {
  LoadedControl loaded;
  loaded.robot = model::load_robot(model::find_robot(setup.robot));
  loaded.clips = setup.clips.empty() ? loaded.robot.directory / "clips" : setup.clips;
  loaded.library = model::load_clip_library(loaded.clips, loaded.robot);
  loaded.options = tick_options(loaded.robot);
  loaded.options.generator.blend = blend_named(setup.blend);
  const std::optional<fs::path> policy = policy_file(setup.policy, loaded.robot);
  loaded.policy = load_policy(policy, loaded);
  std::vector<fs::path> policies;
  if (policy) policies.push_back(*policy);
  model::Bundle bundle = model::bundle(loaded.robot, loaded.clips, policies);
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
