#include "control/control_setup.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "files/config_reader.hpp"
#include "files/nearest_name.hpp"
#include "hal/bus_cycle.hpp"
#include "model/bundle.hpp"
#include "model/clip_library_file.hpp"
#include "model/standing_posture.hpp"
#include "policy/onnx_policy.hpp"
#include "policy/velocity_policy.hpp"

namespace pmg::control {

namespace {

namespace fs = std::filesystem;

/// What --policy may name of this robot, in order.
std::vector<std::string> policy_names(const model::RobotModel& robot) {
  std::vector<std::string> names{"none"};
  std::error_code error;
  for (fs::directory_iterator entry(robot.directory / "policies", error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path kind = entry->path().extension();
    if (kind == ".onnx" || kind == ".yaml") names.push_back(entry->path().stem().string());
  }
  std::ranges::sort(names);
  names.erase(std::ranges::unique(names).begin(), names.end());
  return names;
}

/// A policy of another project: its descriptor, not its network.
bool is_descriptor(const fs::path& file) { return file.extension() == ".yaml"; }

/// Below the robot's policies/, or the file itself. Where a descriptor stands beside a network, the descriptor.
fs::path place_of_policy(const std::string& name, const model::RobotModel& robot) {
  fs::path file(name);
  if (is_descriptor(file)) return file;
  if (file.extension() != ".onnx") file = robot.directory / "policies" / (name + ".onnx");
  const fs::path descriptor = fs::path(file).replace_extension(".yaml");
  return fs::exists(descriptor) ? descriptor : file;
}

/// Nothing for none.
std::optional<fs::path> policy_file(const std::string& name, const char* named_by, const model::RobotModel& robot) {
  if (name == "none") return std::nullopt;
  fs::path file = place_of_policy(name, robot);
  if (!fs::exists(file)) {
    const fs::path told(name);
    if (fs::exists(told) && told.extension() != ".onnx")
      throw std::invalid_argument(fmt::format(
          "{} {}: is no policy by its ending; expected an ONNX file (.onnx) or its descriptor (.yaml), the name of a "
          "policy of {}, or none",
          named_by, name, robot.name));
    const bool of_robot = told.extension() == ".onnx" && !told.has_parent_path();  // pmg.onnx for pmg
    const std::string meant = files::nearest_name(of_robot ? told.stem().string() : name, policy_names(robot));
    throw std::invalid_argument(
        meant.empty()
            ? fmt::format("{} {}: there is no {}; expected the name of a policy there, an ONNX file or its descriptor "
                          "(YAML), or none",
                          named_by, name, file.string())
            : fmt::format("{} {}: there is no {}; did you mean {}?", named_by, name, file.string(), meant));
  }
  return file;
}

/// Without clips: the posture in which this policy was trained to stand.
ClipLibrary standing_library(const model::RobotModel& robot, const JointVector& stand_rad) {
  ClipLibrary library;
  library.q_stand = stand_rad;
  library.q_lower = robot.q_lower();
  library.q_upper = robot.q_upper();
  library.mirror = robot.mirror;
  return library;
}

/// The velocities that robot and policy both can; no posture, of which such a policy knows nothing.
void narrow(const policy::VelocityRange& range, CommandLimits& limits) {
  for (std::size_t channel = 0; channel < kChannels; ++channel) {
    const bool velocity = channel < kVelocityChannels;
    limits.lower[channel] = velocity ? std::max(limits.lower[channel], range.lower[channel]) : 0.0;
    limits.upper[channel] = velocity ? std::min(limits.upper[channel], range.upper[channel]) : 0.0;
  }
}

/// (descriptor) => (policy, library, limits, names and files of it).
std::vector<fs::path> load_velocity_policy(const fs::path& descriptor, LoadedControl& loaded) {
  auto policy = std::make_unique<policy::VelocityPolicy>(descriptor, loaded.robot, 1.0 / loaded.options.dt_s);
  loaded.library = standing_library(loaded.robot, policy->stand_rad());
  narrow(policy->descriptor().command, loaded.options.generator.limits);
  std::vector<fs::path> files = policy->descriptor().files;
  files.push_back(descriptor);
  loaded.policy = std::move(policy);
  return files;
}

/// (policy's file, nothing for none; clips) => (library, policy, files of it).
std::vector<fs::path> load_trained_policy(const std::optional<fs::path>& file, LoadedControl& loaded) {
  if (!fs::exists(loaded.clips)) {
    throw std::invalid_argument(
        fmt::format("{}: there are no clips; pmg_clips synth makes them. A policy of another project needs none: "
                    "scripts/import-policy makes its descriptor",
                    loaded.clips.string()));
  }
  loaded.library = model::load_clip_library(loaded.clips, loaded.robot);
  if (!file) {
    loaded.policy = std::make_unique<policy::ReferencePolicy>();
    return {};
  }
  loaded.policy = std::make_unique<policy::OnnxPolicy>(*file, loaded.robot, model::clip_library_sha256(loaded.clips),
                                                       1.0 / loaded.options.dt_s);
  return {*file};
}

/// The one that runs unless another is asked for; none where robot.yaml names none.
std::string robots_own_policy(const model::RobotModel& robot) {
  files::ConfigReader reader = files::ConfigReader::from_file(robot.directory / "robot.yaml");
  return reader.has("policy") ? reader.required<std::string>("policy") : "none";
}

std::string chosen_policy(const ControlSetup& setup, const model::RobotModel& robot) {
  return setup.policy.empty() ? robots_own_policy(robot) : setup.policy;
}

Blend blend_named(const std::string& name, const ClipLibrary& library) {
  if (name == "library") return library.blend;
  const auto found = std::ranges::find(kBlendNames, name);
  if (found == kBlendNames.end()) {
    throw std::invalid_argument(
        fmt::format("--blend {}: expected library or one of {}", name, fmt::join(kBlendNames, ", ")));
  }
  return static_cast<Blend>(found - kBlendNames.begin());
}

/// Every option of the tick that a configuration shows, by its place there. Options: TickOptions, const or not.
template <typename Options, typename Visit>
void for_each_option(Options& tick, Visit&& visit) {
  visit("/control_period_s", tick.dt_s);
  auto& limits = tick.generator.limits;
  for (std::size_t i = 0; i < kChannels; ++i) {
    const std::string channel = kChannelNames[i];
    visit("/command/lower/" + channel, limits.lower[i]);
    visit("/command/upper/" + channel, limits.upper[i]);
    visit("/command/rate_per_s/" + channel, limits.rate_per_s[i]);
  }
  visit("/command/turn_s", tick.generator.turn_s);
  visit("/gco/prior_weight", tick.gco.prior_weight);
  visit("/gco/optimise_roll_pitch", tick.gco.optimise_roll_pitch);
  visit("/limiter/target_rate_factor", tick.limiter.target_rate_factor);
  visit("/guard/hold_cycles", tick.guard.hold_cycles);
  visit("/guard/max_kp_Nm_per_rad", tick.guard.max_kp_Nm_per_rad);
  visit("/guard/max_kd_Nm_s_per_rad", tick.guard.max_kd_Nm_s_per_rad);
  visit("/entry/speed_rad_s", tick.entry.speed_rad_s);
  visit("/entry/shortest_s", tick.entry.shortest_s);
  visit("/entry/longest_s", tick.entry.longest_s);
  visit("/foot_load/lost_share", tick.foot_load.lost_share);
  visit("/foot_load/lost_s", tick.foot_load.lost_s);
  visit("/foot_load/found_share", tick.foot_load.found_share);
  visit("/foot_load/found_s", tick.foot_load.found_s);
  visit("/foot_load/lost_walking_share", tick.foot_load.lost_walking_share);
  visit("/foot_load/least_walking_share", tick.foot_load.least_walking_share);
  visit("/foot_load/walking_s", tick.foot_load.walking_s);
  visit("/foot_load/held_share", tick.foot_load.held_share);
  visit("/foot_load/filter_s", tick.foot_load.filter_s);
  visit("/foot_load/change_per_sqrt_s", tick.foot_load.change_per_sqrt_s);
  visit("/foot_load/wrong_inertia_share", tick.foot_load.wrong_inertia_share);
  visit("/foot_load/acceleration_s", tick.foot_load.acceleration_s);
  visit("/foot_load/blind_share", tick.foot_load.blind_share);
  visit("/change_over/speed_rad_s", tick.change_over.speed_rad_s);
  visit("/change_over/shortest_s", tick.change_over.shortest_s);
  visit("/change_over/longest_s", tick.change_over.longest_s);
  visit("/rehearsal/duration_s", tick.rehearsal.duration_s);
  visit("/rehearsal/largest_step_rad", tick.rehearsal.largest_step_rad);
  visit("/rehearsal/refused_ticks", tick.rehearsal.refused_ticks);
  visit("/velocity_trim/gain_per_s", tick.velocity_trim.gain_per_s);
  visit("/velocity_trim/lag_s", tick.velocity_trim.lag_s);
  visit("/velocity_trim/settled_share", tick.velocity_trim.settled_share);
  visit("/velocity_trim/forgets_per_range", tick.velocity_trim.forgets_per_range);
  visit("/velocity_trim/most_share", tick.velocity_trim.most_share);
  visit("/velocity_trim/most_miss_share", tick.velocity_trim.most_miss_share);
  visit("/velocity_trim/full_above_share", tick.velocity_trim.full_above_share);
  visit("/sit_down/duration_s", tick.sit_down.balanced.crouch_s);
  visit("/sit_down/settle_s", tick.sit_down.settle_s);
  visit("/sit_down/reference_s", tick.sit_down.balanced.reference_s);
  visit("/sit_down/ahead_share", tick.sit_down.balanced.ahead_share);
  visit("/sit_down/unbalanced/reference_s", tick.sit_down.unbalanced.reference_s);
  visit("/sit_down/unbalanced/crouch_s", tick.sit_down.unbalanced.crouch_s);
  visit("/sit_down/unbalanced/ahead_share", tick.sit_down.unbalanced.ahead_share);
  visit("/sit_down/height_rate_m_s", tick.sit_down.height_rate_m_s);
  visit("/sit_down/brake_factor", tick.sit_down.brake_factor);
  visit("/supervisor/stale_command_s", tick.supervisor.stale_command_s);
  visit("/supervisor/stop_within_s", tick.supervisor.stop_within_s);
  visit("/supervisor/gco_held_ticks", tick.supervisor.gco_held_ticks);
  visit("/late_policy_ticks", tick.late_policy_ticks);
  if (tick.arms) visit("/arms/speed_rad_s", tick.arms->speed_rad_s);
  visit("/action_monitor/bound_rad", tick.action_monitor.bound_rad);
  visit("/action_monitor/persist_ticks", tick.action_monitor.persist_ticks);
  visit("/action_monitor/reversals", tick.action_monitor.reversals);
  visit("/action_monitor/reversal_ticks", tick.action_monitor.reversal_ticks);
  visit("/action_monitor/window_ticks", tick.action_monitor.window_ticks);
  auto& faults = tick.supervisor.fault_limits;
  visit("/faults/stale_state_s", faults.stale_state_s);
  visit("/faults/stale_state_again_s", faults.stale_state_again_s);
  visit("/faults/temperature_degC", faults.temperature_degC);
  visit("/faults/joint_limit_margin_rad", faults.joint_limit_margin_rad);
  visit("/faults/velocity_factor", faults.velocity_factor);
  visit("/faults/torque_factor", faults.torque_factor);
  visit("/faults/tilt_rad", faults.tilt_rad);
  visit("/faults/torso_error_rad", faults.torso_error_rad);
  visit("/faults/persist_ticks", faults.persist_ticks);
  visit("/faults/overrun_ticks", faults.overrun_ticks);
}

nlohmann::ordered_json tick_json(const TickOptions& tick) {
  nlohmann::ordered_json json;
  for_each_option(tick, [&json](const std::string& place, const auto& value) {
    json[nlohmann::ordered_json::json_pointer(place)] = value;
  });
  return json;
}

/// The clips that the chosen policy brings, if it does and the setup names no others.
std::optional<fs::path> own_clips(const ControlSetup& setup, const model::RobotModel& robot) {
  fs::path own = place_of_policy(chosen_policy(setup, robot), robot);
  if (!setup.clips.empty() || is_descriptor(own)) return std::nullopt;
  own = own.replace_extension() / "clips";
  return fs::is_directory(own) ? std::optional(std::move(own)) : std::nullopt;
}

}  // namespace

fs::path chosen_clips(const ControlSetup& setup, const model::RobotModel& robot) {
  const fs::path policy = place_of_policy(chosen_policy(setup, robot), robot);
  if (is_descriptor(policy)) {
    if (setup.clips.empty()) return {};
    throw std::invalid_argument(fmt::format("--clips {}: the policy of {} steps by itself and plays none",
                                            setup.clips.string(), policy.string()));
  }
  return own_clips(setup, robot).value_or(setup.clips.empty() ? robot.directory / "clips" : setup.clips);
}

model::RobotModel load_robot(const ControlSetup& setup) {
  model::RobotModel robot = model::load_robot(model::find_robot(setup.robot));
  const std::optional<fs::path> own = own_clips(setup, robot);
  if (!own) return robot;
  const JointVector q_stand = model::standing_posture(*own, robot);
  return model::standing_as(std::move(robot), q_stand);
}

LoadedControl load_control(const ControlSetup& setup) {
  LoadedControl loaded;
  loaded.robot = load_robot(setup);
  loaded.clips = chosen_clips(setup, loaded.robot);
  loaded.options = tick_options(loaded.robot);
  loaded.policy_name = chosen_policy(setup, loaded.robot);
  const std::optional<fs::path> policy =
      policy_file(loaded.policy_name, setup.policy.empty() ? "robot.yaml's policy" : "--policy", loaded.robot);
  const std::vector<fs::path> policy_files =
      policy && is_descriptor(*policy) ? load_velocity_policy(*policy, loaded) : load_trained_policy(policy, loaded);
  loaded.options.generator.blend = blend_named(setup.blend, loaded.library);
  loaded.variant = loaded.policy->variant();
  model::Bundle bundle = model::bundle(loaded.robot, loaded.clips, policy_files);
  loaded.bundle = std::move(bundle.sha256);
  loaded.files = std::move(bundle.files);
  return loaded;
}

void take_limits(const hal::BackendLimits& limits, TickOptions& options) {
  options.guard = limits.guard;
  faults::FaultLimits& faults = options.supervisor.fault_limits;
  faults.stale_state_s = limits.stale_state_s.value_or(faults.stale_state_s);
  faults.overrun_ticks = limits.overrun_ticks.value_or(faults.overrun_ticks);
}

std::string told_bundle(const ControlSetup& setup) {
  const LoadedControl loaded = load_control(setup);
  return fmt::format("{} (robot {}, policy {})", loaded.bundle, loaded.robot.name, loaded.policy_name);
}

std::unique_ptr<Tick> make_tick(LoadedControl& loaded, const io::Clock& stopwatch) {
  return std::make_unique<Tick>(loaded.robot, loaded.library, std::move(loaded.policy), stopwatch, loaded.options);
}

void restore_options(const nlohmann::ordered_json& json, TickOptions& options) {
  for_each_option(options, [&json](const std::string& place, auto& value) {
    const nlohmann::ordered_json::json_pointer pointer(place);
    if (json.is_object() && json.contains(pointer)) value = json[pointer].get<std::decay_t<decltype(value)>>();
  });
  // A controller that doesn't name these had none: its log is replayed without them.
  const auto unnamed = [&json](const char* place) {
    return json.is_object() && !json.empty() && !json.contains(nlohmann::ordered_json::json_pointer(place));
  };
  if (unnamed("/command/turn_s")) options.generator.turn_s = 0.0;
  if (unnamed("/rehearsal/duration_s")) options.rehearsal.duration_s = 0.0;
  if (unnamed("/velocity_trim/gain_per_s")) options.velocity_trim.gain_per_s = 0.0;
  if (unnamed("/sit_down/duration_s")) options.sit_down.balanced.crouch_s = 0.0;
  if (unnamed("/sit_down/unbalanced/crouch_s")) options.sit_down.unbalanced = options.sit_down.balanced;
  if (unnamed("/sit_down/brake_factor")) options.sit_down.brake_factor = 1.0;
}

nlohmann::ordered_json control_json(const LoadedControl& loaded) {
  nlohmann::ordered_json json = {{"robot", loaded.robot.directory.string()},
                                 {"clips", loaded.clips.string()},
                                 {"policy", loaded.policy_name},
                                 {"blend", kBlendNames[static_cast<std::size_t>(*loaded.options.generator.blend)]},
                                 {"bus_period_s", static_cast<double>(hal::BusCycle::kPeriod_ns) * 1e-9}};
  if (loaded.policy_name != "none") json["variant"] = to_string(loaded.variant);
  json.update(tick_json(loaded.options));
  // Operators say by it how far the robot leans: "up" of the IMU's link, in the IMU's frame.
  const Eigen::Vector3d up_I = faults::up_of_link(loaded.robot.imu);
  json["imu"]["up"] = {up_I.x(), up_I.y(), up_I.z()};
  // Operators say by it why a command is cut. The paper's blend has no such bound: it halves two that ask for half
  // each.
  const Blend blend = *loaded.options.generator.blend;
  if (blend != Blend::kPaper) json["command"]["velocities_together"] = blend == Blend::kCorners ? kCornerReach : 1.0;
  return json;
}

}  // namespace pmg::control
