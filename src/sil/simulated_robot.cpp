#include "sil/simulated_robot.hpp"

#include <algorithm>
#include <cmath>

#include "control/control_setup.hpp"
#include "hal/bus_cycle.hpp"

namespace pmg::sil {

namespace {
constexpr double kBusPeriod_s = static_cast<double>(hal::BusCycle::kPeriod_ns) * 1e-9;
constexpr std::int64_t kCyclesPerPose = 5;  // a hundred a second: more than any screen shows
}  // namespace

sim::WorldOptions world_with_noise(std::uint64_t seed, bool gantry) {
  sim::WorldOptions options;
  options.gantry = gantry;
  options.seed = seed;
  options.gyro_noise_rad_s = kGyroNoise_rad_s;
  options.encoder_noise_rad = kEncoderNoise_rad;
  options.orientation_noise_rad = kOrientationNoise_rad;
  return options;
}

hal::BackendLimits limits_on_shared_host() {
  return {.guard = {}, .stale_state_s = 0.2, .overrun_ticks = 20, .waits = true};
}

void expect_shared_host(control::TickOptions& options) { control::take_limits(limits_on_shared_host(), options); }

SimulatedRobot::SimulatedRobot(sim::World& world, HoistedBy hoisted, bool keep_truth)
    : world_(world),
      bus_(world),
      hoisted_(hoisted),
      keep_truth_(keep_truth),
      weight_N_(world.mj_model()->body_subtreemass[0] * std::abs(world.mj_model()->opt.gravity[2])) {}

hal::BusStatus SimulatedRobot::exchange(const model::JointCommand& command, model::RobotState& state) noexcept {
  if (hoisted_ == HoistedBy::kScenario) move_gantry();
  if (hoisted_ == HoistedBy::kCrane) work_crane();
  const hal::BusStatus status = bus_.exchange(command, state);
  if (status != hal::BusStatus::kOk) {
    diverged_.store(true, std::memory_order_release);
    return status;
  }
  if (keep_truth_) {
    truth_.bus_sample = state.bus_sample;
    truth_.truth = world_.truth();
    truth_.hoisted = carried();
    truths_.push(truth_);  // one that doesn't fit is missing in the log
  }
  if (cycles_++ % kCyclesPerPose == 0) show();
  return status;
}

const hal::TruthSample* SimulatedRobot::take_truth(std::uint64_t bus_sample) noexcept {
  while (taken_.bus_sample < bus_sample && truths_.pop(taken_)) {
  }
  return taken_.bus_sample == bus_sample ? &taken_ : nullptr;
}

void SimulatedRobot::move_gantry() noexcept {
  hoist_.step(support_.load(std::memory_order_relaxed), kBusPeriod_s);
  world_.set_hoist(hoist_.lift_m(), hoist_.engaged());
}

void SimulatedRobot::work_crane() noexcept {
  const std::array<double, 2>& feet_N = world_.foot_force_N();
  crane_.step({.stands = hoist_line_.stands(),
               .stays_up = hoist_line_.stays_up(),
               .carried_share = (feet_N[0] + feet_N[1]) / weight_N_,
               .torso_height_m = world_.torso_height_m()},
              kBusPeriod_s);
  world_.set_hoist(crane_.lift_m(), crane_.engaged());
  hoist_line_.show(crane_.state());
}

bool SimulatedRobot::carried() const noexcept {
  switch (hoisted_) {
    case HoistedBy::kScenario:
      return hoist_.carrying();
    case HoistedBy::kGantry:
      return true;
    case HoistedBy::kCrane:
      return crane_.carrying();
  }
  return false;
}

void SimulatedRobot::show() noexcept {
  pose_.time_s = world_.time_s();
  pose_.count = std::min(static_cast<std::size_t>(world_.mj_model()->nq), PoseSample::kMaxPositions);
  std::copy_n(world_.mj_data()->qpos, pose_.count, pose_.qpos.begin());
  pose_.rope = world_.gantry_rope();
  poses_.put(pose_);
}

}  // namespace pmg::sil
