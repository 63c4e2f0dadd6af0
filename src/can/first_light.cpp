#include "can/first_light.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "can/one_motor.hpp"
#include "drives/robot_drives.hpp"
#include "hal/bus_cycle.hpp"
#include "model/hanging_load.hpp"
#include "pmg/types.hpp"

namespace pmg::can {

namespace {

constexpr double kCycle_s = static_cast<double>(hal::BusCycle::kPeriod_ns) * 1e-9;
constexpr int kSettleCycles = 100;   // 0.2 s at each end
constexpr double kLeastShare = 0.5;  // of the way asked for, with soft gains and dry friction
constexpr double kLeastWay_rad = 3.0 * kRadPerDegree, kMostWay_rad = 20.0 * kRadPerDegree;
// Frictions that a load must have to be compared; friction of opposite ways cancels out of the mean of both.
constexpr double kSure = 3.0, kSureOfMean = 1.0;
constexpr double kWayMargin =
    1.5;  // soft gains don't reach the end, and a step of the drive's torque counts as friction

}  // namespace

double telling_way_rad(const model::RobotModel& robot, const JointVector& q, const std::string& joint) {
  const model::HangingLoad load = model::hanging_load(robot, joint, q);
  const double friction_Nm = robot.joints[static_cast<std::size_t>(robot.joint_index.at(joint))].friction_Nm;
  const double share = kWayMargin * kSure * friction_Nm / std::max(load.gravity_Nm, 1e-9);
  return std::clamp(std::asin(std::min(share, 1.0)), kLeastWay_rad, kMostWay_rad);
}

Wiggle wiggle(const model::RobotModel& robot, const JointVector& q, const BusSetup& bus,
              const drives::MotorSetup& motor, Link& link, const WiggleOptions& options,
              const std::function<void()>& tick, const std::function<bool()>& interrupted) {
  const model::Joint& joint = robot.joints[static_cast<std::size_t>(motor.index)];
  OneMotor one(bus, motor, link, tick);
  const double start_rad = one.joint().q_rad;
  if (start_rad < joint.lower_rad || start_rad > joint.upper_rad) {
    throw std::runtime_error(
        fmt::format("{} is at {:.3f} rad; expected a start within {:.3f} to {:.3f} rad: set its zero first",
                    name_of(bus, motor), start_rad, joint.lower_rad, joint.upper_rad));
  }
  one.switch_on();
  const bool own_gains = motor.drive->loop() == drives::LoopPlace::kOwnGains;
  const double share = own_gains ? 1.0 : options.gain_share;

  double target_rad = start_rad;
  const auto go_to = [&](double end_rad, double& q_rad, double& torque_Nm) {
    double q_sum = 0.0, torque_sum = 0.0;
    const double end = std::clamp(end_rad, joint.lower_rad, joint.upper_rad);
    for (int settled = 0; settled < kSettleCycles;) {
      if (interrupted && interrupted()) throw std::runtime_error("interrupted; the motor is switched off");
      target_rad += std::clamp(end - target_rad, -options.speed_rad_s * kCycle_s, options.speed_rad_s * kCycle_s);
      one.exchange({.q_rad = target_rad,
                    .kp_Nm_per_rad = share * joint.kp_Nm_per_rad,
                    .kd_Nm_s_per_rad = share * joint.kd_Nm_s_per_rad});
      if (target_rad != end) continue;
      ++settled;
      if (2 * settled <= kSettleCycles) continue;  // the second half is at rest
      q_sum += one.joint().q_rad;
      torque_sum += one.joint().torque_Nm;
    }
    constexpr int kRestCycles = kSettleCycles / 2;
    q_rad = q_sum / kRestCycles;
    torque_Nm = torque_sum / kRestCycles;
  };
  double q_up = 0.0, q_down = 0.0, q_back = 0.0, torque_up = 0.0, torque_down = 0.0, torque_back = 0.0;
  const double by_rad = options.by_rad.value_or(telling_way_rad(robot, q, motor.joint));
  const double up = std::min(start_rad + by_rad, joint.upper_rad);
  go_to(up, q_up, torque_up);
  go_to(start_rad - by_rad, q_down, torque_down);
  go_to(start_rad, q_back, torque_back);

  const model::HangingLoad load = model::hanging_load(robot, motor.joint, q);
  Wiggle result;
  result.asked_rad = up - start_rad;
  result.moved_rad = q_up - start_rad;
  result.held_Nm = 0.5 * (torque_up + torque_down);  // dry friction takes opposite signs on the two ways
  const double middle_rad = 0.5 * (q_up + q_down);
  result.model_Nm = load.gravity_Nm * std::sin(middle_rad - load.hangs_at_rad);
  // The joint is at -q then, and its torque has the other sign, too.
  result.model_inverted_Nm = load.gravity_Nm * std::sin(middle_rad + load.hangs_at_rad);
  const double model_up_Nm = load.gravity_Nm * std::sin(q_up - load.hangs_at_rad),
               model_down_Nm = load.gravity_Nm * std::sin(q_down - load.hangs_at_rad);
  const bool up_pulls_more = std::abs(model_up_Nm) > std::abs(model_down_Nm);
  result.held_end_Nm = up_pulls_more ? torque_up : torque_down;
  result.model_end_Nm = up_pulls_more ? model_up_Nm : model_down_Nm;
  result.friction_Nm = joint.friction_Nm + motor.drive->torque_step_Nm();
  return result;
}

std::string way_of(const model::RobotModel& robot, const JointVector& q, const std::string& joint, double by_rad) {
  const auto centre = [&](const JointVector& at) {
    // Centre of mass of the links beyond the joint, base upright: each link's frame from the base, by its own chain.
    KDL::Vector sum = KDL::Vector::Zero();
    double mass = 0.0;
    for (const auto& [name, element] : robot.tree.getSegments()) {
      KDL::Chain chain;
      if (!robot.tree.getChain(robot.base_link, name, chain)) continue;
      bool beyond = false;
      KDL::Frame frame = KDL::Frame::Identity();
      for (const KDL::Segment& segment : chain.segments) {
        const bool moves = segment.getJoint().getType() != KDL::Joint::Fixed;
        beyond = beyond || segment.getJoint().getName() == joint;
        frame = frame * segment.pose(moves ? at[robot.joint_index.at(segment.getJoint().getName())] : 0.0);
      }
      if (!beyond) continue;
      const KDL::RigidBodyInertia inertia = GetTreeElementSegment(element).getInertia();
      sum += inertia.getMass() * (frame * inertia.getCOG());
      mass += inertia.getMass();
    }
    return sum / mass;
  };
  JointVector moved = q;
  moved[robot.joint_index.at(joint)] += by_rad;
  const KDL::Vector way_mm = 1e3 * (centre(moved) - centre(q));
  constexpr std::array<std::array<const char*, 2>, 3> kWays = {
      {{"forward", "backward"}, {"to the left", "to the right"}, {"up", "down"}}};
  std::vector<std::pair<double, std::string>> parts;
  for (int i = 0; i < 3; ++i) {
    const double length_mm = std::abs(way_mm(i));
    if (length_mm < 0.5) continue;
    parts.emplace_back(-length_mm, fmt::format("{:.0f} mm {}", length_mm,
                                               kWays[static_cast<std::size_t>(i)][way_mm(i) > 0.0 ? 0 : 1]));
  }
  if (parts.empty()) return "turns in place";
  std::ranges::sort(parts);
  std::vector<std::string> texts;
  for (const auto& part : parts) texts.push_back(part.second);
  return fmt::format("{}", fmt::join(texts, ", "));
}

Verdict verdict(const Wiggle& wiggle) {
  using Tells = Verdict::Tells;
  if (wiggle.moved_rad < kLeastShare * wiggle.asked_rad) {
    return {Tells::kWrong,
            wiggle.moved_rad < 0.0
                ? "it moved the other way than its own drive was told: position and torque of the drive have opposite "
                  "signs"
                : "it moved less than half the way: a brake, a stop, too much friction, or another joint's motor"};
  }
  // An end's torque has the friction in it, once.
  const double least_Nm = 0.5 * wiggle.model_end_Nm - wiggle.friction_Nm,
               most_Nm = 2.0 * wiggle.model_end_Nm + wiggle.friction_Nm;
  const bool gear_known = std::abs(wiggle.model_end_Nm) >= kSure * wiggle.friction_Nm;
  const auto [lower_Nm, upper_Nm] = std::minmax({least_Nm, most_Nm});
  if (gear_known && (wiggle.held_end_Nm < lower_Nm || wiggle.held_end_Nm > upper_Nm))
    return {
        Tells::kWrong,
        fmt::format("the drive holds {:.1f} times the model's load: look at `gear`, at the drive's torque constant, "
                    "and at the joint's zero",
                    wiggle.held_end_Nm / wiggle.model_end_Nm)};
  const double apart_Nm = std::abs(wiggle.model_Nm - wiggle.model_inverted_Nm);
  const bool direction_known = apart_Nm >= kSureOfMean * wiggle.friction_Nm;
  if (direction_known &&
      std::abs(wiggle.held_Nm - wiggle.model_inverted_Nm) < std::abs(wiggle.held_Nm - wiggle.model_Nm))
    return {Tells::kWrong, "the load pulls the other way than the model's: `direction` in robot.yaml is wrong"};
  if (direction_known && gear_known) return {Tells::kAgrees, "direction and gear agree with the model"};
  if (gear_known)
    return {Tells::kNotAll,
            "its load agrees with the model's and would be the same the other way round: compare the way with the eye"};
  if (direction_known)
    return {Tells::kNotAll, "the direction agrees with the model; its load is too small to tell the gear"};
  return {Tells::kNotAll, "its load is too small to tell direction and gear: compare the way with the eye"};
}

}  // namespace pmg::can
