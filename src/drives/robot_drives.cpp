#include "drives/robot_drives.hpp"

#include <algorithm>

#include "model/constants.hpp"

namespace pmg::drives {

namespace {

constexpr std::int64_t kCycle_ns = 2'000'000;
static_assert(kCycle_ns == 1e9 * model::kBusPeriod_s);

MotorCommand joint_command(const model::JointCommand& command, int joint) noexcept {
  if (joint >= command.q.size()) return {};
  return {.q_rad = command.q[joint],
          .dq_rad_s = command.dq[joint],
          .kp_Nm_per_rad = command.kp[joint],
          .kd_Nm_s_per_rad = command.kd[joint],
          .torque_Nm = command.tau_ff[joint]};
}

}  // namespace

std::string words_of(Trouble trouble, DriveFault fault) {
  if (trouble == Trouble::kFault) return std::string("reports ") + to_string(fault);
  return trouble == Trouble::kNone ? "answers late" : to_string(trouble);
}

RobotDrives::RobotDrives(const std::vector<Way>& ways, int joints) : joints_(joints) {
  for (const Way& way : ways) {
    Group& group = groups_.emplace_back();
    for (const MotorSetup& motor : way.group->motors)
      group.motors.push_back({.setup = &motor, .monitor = MotorMonitor(motor.limits, way.fresh_cycles)});
    for (const auto& linked : way.group->four_bars) group.four_bars.push_back({.setup = &linked});
    for (const auto& linked : way.group->parallel) group.parallel.push_back({.setup = &linked});
  }
}

void RobotDrives::begin(const model::JointCommand& command, std::int64_t now_ns) noexcept {
  paused_ = last_begin_ns_ != 0 && now_ns - last_begin_ns_ > kPause_ns;
  last_begin_ns_ = now_ns;
  stiff_ = (command.kp.array() != 0.0).any() || (command.tau_ff.array() != 0.0).any();
  urgent_ =
      command.kp.size() != kp_.size() || command.kp != kp_ || command.kd.size() != kd_.size() || command.kd != kd_;
  kp_ = command.kp;
  kd_ = command.kd;
  for (Group& group : groups_) {
    for (Motor& motor : group.motors) {
      motor.monitor.begin();
      motor.wanted = joint_command(command, motor.setup->index);
    }
    for (const auto& linked : group.four_bars) command_cranks(group, linked);
    for (const auto& linked : group.parallel) command_cranks(group, linked);
  }
}

// Cranks of motors that are limp get no torque: the joints' gains are zero.
template <int N>
void RobotDrives::command_cranks(Group& group, const Linked<N>& linked) noexcept {
  typename RodLinkage<N>::Commands joints{};
  for (std::size_t i = 0; i < joints.size(); ++i) joints[i] = group.motors[linked.setup->motors[i]].wanted;
  const auto cranks = linked.setup->linkage.to_motors(joints, linked.q_rad, linked.dq_rad_s, linked.theta_rad);
  for (std::size_t i = 0; i < joints.size(); ++i) group.motors[linked.setup->motors[i]].wanted = cranks[i];
}

bool RobotDrives::all_settled() const noexcept {
  return std::ranges::all_of(groups_, [](const Group& group) {
    return std::ranges::all_of(group.motors, [](const Motor& motor) { return motor.monitor.settled(); });
  });
}

void RobotDrives::read() noexcept {
  for (Group& group : groups_) {
    for (Motor& motor : group.motors) motor.joint = motor.setup->transmission.to_joint(motor.monitor.reading());
    for (auto& linked : group.four_bars) read_joints(group, linked);
    for (auto& linked : group.parallel) read_joints(group, linked);
  }
}

// (crank angles, speeds, torques) => (the joints'), from the last sample as guess.
template <int N>
void RobotDrives::read_joints(Group& group, Linked<N>& linked) noexcept {
  const auto motor = [&](std::size_t i) -> MotorReading& { return group.motors[linked.setup->motors[i]].joint; };
  typename RodLinkage<N>::Readings cranks{};
  for (std::size_t i = 0; i < cranks.size(); ++i) cranks[i] = motor(i);
  const auto joints = linked.setup->linkage.to_joints(cranks, linked.q_rad);
  linked.solved = joints.has_value();
  if (!joints) return;
  for (std::size_t i = 0; i < cranks.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    linked.q_rad[at] = (*joints)[i].q_rad;
    linked.dq_rad_s[at] = (*joints)[i].dq_rad_s;
    linked.theta_rad[at] = cranks[i].q_rad;
    motor(i) = (*joints)[i];
  }
}

// Motor angles that no joint angles belong to: a reading is wrong. The first such motor; -1: none.
int RobotDrives::unsolved(const Group& group) noexcept {
  for (const auto& linked : group.four_bars) {
    if (!linked.solved) return static_cast<int>(linked.setup->motors[0]);
  }
  for (const auto& linked : group.parallel) {
    if (!linked.solved) return static_cast<int>(linked.setup->motors[0]);
  }
  return -1;
}

MotorTrouble RobotDrives::judge(std::size_t group) const noexcept {
  MotorTrouble late;
  const std::vector<Motor>& motors = groups_[group].motors;
  for (std::size_t m = 0; m < motors.size(); ++m) {
    const MotorMonitor& monitor = motors[m].monitor;
    const Condition condition = monitor.condition(stiff_);
    if (condition == Condition::kGood) continue;
    const MotorTrouble trouble = {.condition = condition,
                                  .motor = static_cast<int>(m),
                                  .trouble = monitor.trouble(stiff_),
                                  .fault = monitor.reading().fault};
    if (condition == Condition::kLost) return trouble;
    if (late.motor < 0) late = trouble;
  }
  if (const int motor = unsolved(groups_[group]); motor >= 0)
    return {.condition = Condition::kLost, .motor = motor, .trouble = Trouble::kPositionJump};
  return late;
}

void RobotDrives::fill(model::RobotState& state) const noexcept {
  state.age_ns = 0;
  for (JointVector* values : {&state.q, &state.dq, &state.tau, &state.temperature_degC}) values->resize(joints_);
  for (const Group& group : groups_) {
    for (const Motor& motor : group.motors) {
      const int index = motor.setup->index;
      state.q[index] = motor.joint.q_rad;
      state.dq[index] = motor.joint.dq_rad_s;
      state.tau[index] = motor.joint.torque_Nm;
      state.temperature_degC[index] = motor.joint.temperature_degC;
      state.age_ns = std::max(state.age_ns, motor.monitor.age_cycles() * kCycle_ns);
    }
  }
}

}  // namespace pmg::drives
