// The whole controller with MuJoCo behind emulated drives. PMG_CAN_SOCKETS=1 in the environment: over the CAN
// interfaces that robot.yaml names (test/can/canrun makes them); otherwise over memory.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "can/can_backend.hpp"
#include "can/emulated_robot.hpp"
#include "can/memory_link.hpp"
#include "can/mixed_drives.hpp"
#include "can/socket_link.hpp"
#include "control/control_setup.hpp"
#include "control/fixtures.hpp"
#include "sil/lockstep.hpp"
#include "sil/sil_hal.hpp"
#include "sil/simulated_robot.hpp"

namespace pmg::sil {

inline bool over_sockets() { return std::getenv("PMG_CAN_SOCKETS") != nullptr; }

inline std::pair<test::Links, test::Links> links(const can::DriveSetup& setup) {
  if (!over_sockets()) return test::link_pairs<test::MemoryLink>(setup.buses.size());
  std::pair<test::Links, test::Links> ends;
  for (const can::BusSetup& bus : setup.buses) {
    ends.first.push_back(std::make_unique<can::SocketLink>(
        bus.name, std::vector<std::uint32_t>{0, can::kImuQuaternion, can::kImuRateOfTurn, can::kImuAcceleration},
        false));
    ends.second.push_back(std::make_unique<can::SocketLink>(bus.name, std::vector<std::uint32_t>{}, false));
  }
  return ends;
}

/// The robot's policy, until a test breaks it.
class BreakingPolicy final : public policy::Policy {
 public:
  enum class Break { kNone, kLate, kNotANumber, kFar };
  explicit BreakingPolicy(std::unique_ptr<policy::Policy> sound) : sound_(std::move(sound)) {}
  Variant variant() const override { return sound_->variant(); }
  std::optional<policy::DriveGains> gains() const override { return sound_->gains(); }
  std::optional<double> action_bound_rad() const override { return sound_->action_bound_rad(); }
  bool needs_ground() const override { return sound_->needs_ground(); }
  void reset() noexcept override { sound_->reset(); }
  void unsent() noexcept override { sound_->unsent(); }
  policy::Status act(const model::RobotState& state, const Reference& reference, const Command& observed,
                     JointVector& q_des) noexcept override {
    const policy::Status status = sound_->act(state, reference, observed, q_des);
    if (how == Break::kNotANumber) q_des[3] = std::numeric_limits<double>::quiet_NaN();
    if (how == Break::kFar) q_des[3] = reference.q[3] + *sound_->action_bound_rad() + 0.1;
    return how == Break::kLate ? policy::Status::kLate : status;
  }
  Break how = Break::kNone;

 private:
  std::unique_ptr<policy::Policy> sound_;
};

/// Z1, its policy and its world, once more for each run; Robot, derived from test::RobotBehindDrives, is its bus.
template <typename Robot>
struct StageOf {
  /// limits: the backend's; nullopt: none, for a run in process.
  StageOf(std::uint64_t seed, const std::optional<hal::BackendLimits>& limits) : loaded(load()) {
    auto breaking = std::make_unique<BreakingPolicy>(std::move(loaded.policy));
    policy = breaking.get();
    loaded.policy = std::move(breaking);
    if (limits) control::take_limits(*limits, loaded.options);
    world.emplace(loaded.robot, world_with_noise(seed, false));
  }
  static control::LoadedControl load() {
    control::ControlSetup setup;
    setup.robot = test::kZ1Folder;
    return control::load_control(setup);
  }
  RunOutcome run(const Scenario& scenario) {
    SilHal in_process(*world);
    hal::Hal& bus = robot ? static_cast<hal::Hal&>(*robot) : in_process;
    WorldPlant plant(*world);
    const std::unique_ptr<control::Tick> tick = control::make_tick(loaded, clock);
    Lockstep lockstep(loaded.robot, bus, plant, *tick, scenario, nullptr, {.balanced_by_policy = true});
    lockstep.after_tick = [&](const RunProgress& progress) {
      if (progress.result.mode == control::Mode::kFault) fault = progress.result.fault.code;
      sat_down |= control::sitting_down(progress.result.maker);
    };
    lockstep.control_sleeps = [this] { return control_frozen; };
    return lockstep.run();
  }

  io::WallClock clock;
  control::LoadedControl loaded;
  BreakingPolicy* policy = nullptr;
  std::optional<sim::World> world;
  can::DriveSetup setup;
  std::optional<Robot> robot;
  bool control_frozen = false;  ///< the control thread gives nothing
  faults::FaultCode fault = faults::FaultCode::kNone;
  bool sat_down = false;
};

struct Stage : StageOf<test::EmulatedRobot> {
  explicit Stage(std::uint64_t seed, bool over_can, bool mixed = false)
      : StageOf(seed, over_can ? std::optional(can::limits()) : std::nullopt) {
    if (!over_can) return;
    setup = mixed ? test::mixed_drives(loaded.robot) : can::load_drives(loaded.robot);
    auto [host, far] = links(setup);
    for (const auto& link : host) wires.push_back(dynamic_cast<test::MemoryLink*>(link.get()));
    robot.emplace(setup, loaded.robot, *world, std::move(host), std::move(far));
  }
  std::vector<test::MemoryLink*> wires;  ///< the host's end of each bus; null over sockets
};

inline Scenario walking(double stand_s, double walk_s) {
  Scenario scenario;
  scenario.name = "walk";
  scenario.steps.push_back(
      {.start_s = 0.0, .duration_s = stand_s, .text = "stand", .mode = control::Mode::kStand, .command = {}});
  scenario.steps.push_back({.start_s = stand_s,
                            .duration_s = walk_s,
                            .text = "walk",
                            .mode = control::Mode::kWalk,
                            .command = Command{{0.5, 0.0, 0.2, 0.0, 0.0, 0.0}}});
  return scenario;
}

inline std::string line(const char* name, const TrackingSummary& t) {
  return fmt::format("{}: velocity {:.4f} m/s, yaw {:.4f} rad/s, pitch {:.4f}, roll {:.4f} rad, height {:.4f} m", name,
                     t.lin_vel_mae_m_s, t.yaw_vel_mae_rad_s, t.pitch_mae_rad, t.roll_mae_rad, t.height_mae_m);
}

}  // namespace pmg::sil
