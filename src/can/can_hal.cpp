#include "can/can_hal.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <ctime>

#include "can/canopen_setup.hpp"
#include "hal/bus_cycle.hpp"

namespace pmg::can {

namespace {

constexpr std::size_t kIncoming = 64;  // frames a call: more than any bus carries in 2 ms

drives::MotorCommand joint_command(const model::JointCommand& command, int joint) noexcept {
  if (joint >= command.q.size()) return {};
  return {.q_rad = command.q[joint],
          .dq_rad_s = command.dq[joint],
          .kp_Nm_per_rad = command.kp[joint],
          .kd_Nm_s_per_rad = command.kd[joint],
          .torque_Nm = command.tau_ff[joint]};
}

bool stiff(const model::JointCommand& command) noexcept {
  return (command.kp.array() != 0.0).any() || (command.tau_ff.array() != 0.0).any();
}

}  // namespace

std::string describe(const BusTrouble& trouble, const drives::DriveSetup& setup) {
  if (trouble.bus < 0) return "the drives answer";
  const drives::BusSetup& bus = setup.buses[static_cast<std::size_t>(trouble.bus)];
  if (trouble.imu) return fmt::format("the IMU on {} does not speak", bus.name);
  if (trouble.motor < 0)
    return fmt::format("{} is {}", bus.name, trouble.health == BusHealth::kOff ? "off" : "error-passive");
  const drives::MotorSetup& motor = bus.motors[static_cast<std::size_t>(trouble.motor)];
  const std::string text = fmt::format("{} ({}, node {}) ", motor.joint, bus.name, motor.node);
  if (trouble.trouble == drives::Trouble::kFault) return text + "reports " + drives::to_string(trouble.fault);
  if (trouble.trouble == drives::Trouble::kNone) return text + "answers late";
  return text + drives::to_string(trouble.trouble);
}

CanHal::CanHal(const drives::DriveSetup& setup, const model::RobotModel& robot, const io::Clock& clock,
               std::vector<std::unique_ptr<Link>> links)
    : robot_(robot), clock_(clock), incoming_(kIncoming) {
  buses_.reserve(setup.buses.size());
  for (std::size_t b = 0; b < setup.buses.size(); ++b) {
    Bus bus;
    bus.setup = &setup.buses[b];
    bus.link = std::move(links.at(b));
    for (const drives::MotorSetup& motor : setup.buses[b].motors) bus.motors.emplace_back(motor, setup.buses[b]);
    bus.canopen = setup.buses[b].has_canopen();
    bus.outgoing.resize(bus.motors.size() + 2);
    bus.asked.resize(bus.outgoing.size());
    bus.wanted.resize(bus.motors.size());
    bus.readings.resize(bus.motors.size());
    for (const auto& linked : setup.buses[b].four_bars) bus.four_bars.push_back({.setup = &linked});
    for (const auto& linked : setup.buses[b].parallel) bus.parallel.push_back({.setup = &linked});
    polled_.push_back({.fd = bus.link->descriptor(), .events = POLLIN, .revents = 0});
    waits_ = waits_ || polled_.back().fd >= 0;
    buses_.push_back(std::move(bus));
  }
}

hal::BusStatus CanHal::exchange(const model::JointCommand& command, model::RobotState& state) noexcept {
  send(command);
  return receive(state);
}

void CanHal::send(const model::JointCommand& command) noexcept {
  drain();  // late answers belong to the cycle before
  const std::int64_t now_ns = clock_.now_ns();
  const bool paused = last_send_ns_ != 0 && now_ns - last_send_ns_ > kPause_ns;
  last_send_ns_ = now_ns;
  stiff_ = stiff(command);
  urgent_ =
      command.kp.size() != kp_.size() || command.kp != kp_ || command.kd.size() != kd_.size() || command.kd != kd_;
  kp_ = command.kp;
  kd_ = command.kd;
  imu_.begin_cycle();
  for (Bus& bus : buses_) send(bus, command, paused);
}

void CanHal::send(Bus& bus, const model::JointCommand& command, bool paused) noexcept {
  bool synced = bus.canopen;
  for (std::size_t m = 0; m < bus.motors.size(); ++m) {
    BusMotor& motor = bus.motors[m];
    motor.begin();
    if (paused) motor.interrupt();
    synced = synced && !motor.pauses_sync();
    bus.wanted[m] = joint_command(command, motor.setup().index);
  }
  for (const auto& linked : bus.four_bars) command_cranks(bus, linked);
  for (const auto& linked : bus.parallel) command_cranks(bus, linked);
  std::size_t count = 0;
  const auto put = [&](const Frame& frame, int asked) {
    bus.outgoing[count] = frame;
    bus.asked[count++] = asked;
  };
  if (synced) put(canopen::sync(), kAllCanopen);  // first: what it asks for is worth most when it is new
  for (std::size_t m = 0; m < bus.motors.size(); ++m) {
    const auto frame = bus.motors[m].ask(bus.wanted[m], {.stiff = stiff_, .urgent = urgent_, .synced = synced});
    if (!frame) continue;
    const bool answers = std::holds_alternative<drives::MitRanges>(bus.motors[m].setup().drive);
    put(*frame, answers ? static_cast<int>(m) : kNobody);
  }
  if (bus.canopen && cycles_ % kHeartbeatCycles == 0) put(canopen::heartbeat(), kNobody);
  for (std::size_t k = bus.link->send(std::span(bus.outgoing).first(count)); k < count; ++k) {
    if (bus.asked[k] >= 0) bus.motors[static_cast<std::size_t>(bus.asked[k])].not_asked();
    if (bus.asked[k] != kAllCanopen) continue;
    for (BusMotor& motor : bus.motors) {
      if (std::holds_alternative<drives::Cia402Settings>(motor.setup().drive)) motor.not_asked();
    }
  }
}

hal::BusStatus CanHal::receive(model::RobotState& state) noexcept {
  drain();
  const io::WallClock clock;
  const std::int64_t deadline_ns = clock.now_ns() + kWait_ns;
  while (waits_ && !all_answered() && wait(deadline_ns)) drain();
  for (Bus& bus : buses_) {
    send_targets(bus);
    read_joints(bus);
  }
  trouble_ = judge();
  tell();
  ++cycles_;
  if (trouble_.status != hal::BusStatus::kOk) return trouble_.status;
  state.age_ns = 0;
  const int joints = robot_.joint_index.size();
  for (JointVector* values : {&state.q, &state.dq, &state.tau, &state.temperature_degC}) values->resize(joints);
  for (const Bus& bus : buses_) {
    for (std::size_t m = 0; m < bus.motors.size(); ++m) {
      const drives::MotorReading& joint = bus.readings[m];
      const int index = bus.motors[m].setup().index;
      state.q[index] = joint.q_rad;
      state.dq[index] = joint.dq_rad_s;
      state.tau[index] = joint.torque_Nm;
      state.temperature_degC[index] = joint.temperature_degC;
      state.age_ns = std::max(state.age_ns, bus.motors[m].monitor().age_cycles() * hal::BusCycle::kPeriod_ns);
    }
  }
  imu_.read(state);
  state.bus_sample = cycles_;
  return trouble_.status;
}

void CanHal::send_targets(Bus& bus) noexcept {
  std::size_t count = 0;
  for (BusMotor& motor : bus.motors) {
    if (const auto frame = motor.targets()) bus.outgoing[count++] = *frame;
  }
  if (count > 0) bus.link->send(std::span(bus.outgoing).first(count));
}

// Cranks of motors that are limp get no torque: the joints' gains are zero.
template <int N>
void CanHal::command_cranks(Bus& bus, const Linked<N>& linked) noexcept {
  typename drives::RodLinkage<N>::Commands joints{};
  for (std::size_t i = 0; i < joints.size(); ++i) joints[i] = bus.wanted[linked.setup->motors[i]];
  const auto cranks = linked.setup->linkage.to_motors(joints, linked.q_rad, linked.dq_rad_s, linked.theta_rad);
  for (std::size_t i = 0; i < joints.size(); ++i) bus.wanted[linked.setup->motors[i]] = cranks[i];
}

// (crank angles, speeds, torques) => (the joints'): q by Newton from the last sample, dq = J^-1 dtheta,
// torque_q = J^T torque_theta.
template <int N>
void CanHal::read_joints(Bus& bus, Linked<N>& linked) noexcept {
  typename drives::RodLinkage<N>::Angles theta, dtheta, torque;
  for (int i = 0; i < N; ++i) {
    const drives::MotorReading& crank = bus.readings[linked.setup->motors[static_cast<std::size_t>(i)]];
    theta[i] = crank.q_rad;
    dtheta[i] = crank.dq_rad_s;
    torque[i] = crank.torque_Nm;
  }
  const auto q = linked.setup->linkage.joint_angles(theta, linked.q_rad);
  linked.solved = q.has_value();
  if (!q) return;
  const auto J = linked.setup->linkage.jacobian(theta, *q);
  linked.q_rad = *q;
  linked.theta_rad = theta;
  linked.dq_rad_s = J.inverse() * dtheta;
  const typename drives::RodLinkage<N>::Angles joint_torque = J.transpose() * torque;
  for (int i = 0; i < N; ++i) {
    drives::MotorReading& joint = bus.readings[linked.setup->motors[static_cast<std::size_t>(i)]];
    joint.q_rad = linked.q_rad[i];
    joint.dq_rad_s = linked.dq_rad_s[i];
    joint.torque_Nm = joint_torque[i];
  }
}

void CanHal::read_joints(Bus& bus) noexcept {
  for (std::size_t m = 0; m < bus.motors.size(); ++m) {
    bus.readings[m] = bus.motors[m].setup().transmission.to_joint(bus.motors[m].monitor().reading());
  }
  for (auto& linked : bus.four_bars) read_joints(bus, linked);
  for (auto& linked : bus.parallel) read_joints(bus, linked);
}

// Motor angles that no joint angles belong to: a reading is wrong. The first such motor; -1: none.
int CanHal::unsolved(const Bus& bus) noexcept {
  for (const auto& linked : bus.four_bars) {
    if (!linked.solved) return static_cast<int>(linked.setup->motors[0]);
  }
  for (const auto& linked : bus.parallel) {
    if (!linked.solved) return static_cast<int>(linked.setup->motors[0]);
  }
  return -1;
}

// A late answer alone is no news.
void CanHal::tell() noexcept {
  if (trouble_.status == hal::BusStatus::kStale || trouble_ == told_) return;
  told_ = trouble_;
  changes_.put(told_);
}

void CanHal::drain() noexcept {
  for (Bus& bus : buses_) drain(bus);
}

void CanHal::drain(Bus& bus) noexcept {
  while (true) {
    const std::size_t count = bus.link->receive(incoming_);
    for (std::size_t i = 0; i < count; ++i) hear(bus, incoming_[i]);
    if (count < incoming_.size()) return;
  }
}

void CanHal::hear(Bus& bus, const Frame& frame) noexcept {
  if (bus.setup->imu && imu_.hear(frame)) return;
  for (BusMotor& motor : bus.motors) {
    if (motor.hear(frame)) return;
  }
  ++(stranger(*bus.setup, frame) ? strangers_ : unreadable_);
}

bool CanHal::all_answered() const noexcept {
  return std::ranges::all_of(buses_, [](const Bus& bus) {
    return std::ranges::all_of(bus.motors, [](const BusMotor& motor) { return motor.monitor().settled(); });
  });
}

bool CanHal::wait(std::int64_t deadline_ns) noexcept {
  const io::WallClock clock;
  const std::int64_t left_ns = deadline_ns - clock.now_ns();
  if (left_ns <= 0) return false;
  const timespec timeout{.tv_sec = 0, .tv_nsec = left_ns};
  return ppoll(polled_.data(), polled_.size(), &timeout, nullptr) > 0;
}

BusTrouble CanHal::judge() const noexcept {
  BusTrouble late;
  for (std::size_t b = 0; b < buses_.size(); ++b) {
    const Bus& bus = buses_[b];
    const int at = static_cast<int>(b);
    if (bus.link->health() == BusHealth::kOff)
      return {.status = hal::BusStatus::kLost, .bus = at, .health = BusHealth::kOff};
    for (std::size_t m = 0; m < bus.motors.size(); ++m) {
      const drives::MotorMonitor& monitor = bus.motors[m].monitor();
      const drives::Condition condition = monitor.condition(stiff_);
      if (condition == drives::Condition::kGood) continue;
      const BusTrouble trouble = {
          .status = condition == drives::Condition::kLost ? hal::BusStatus::kLost : hal::BusStatus::kStale,
          .bus = at,
          .motor = static_cast<int>(m),
          .trouble = monitor.trouble(stiff_),
          .fault = monitor.reading().fault,
          .health = bus.link->health()};
      if (trouble.status == hal::BusStatus::kLost) return trouble;
      if (late.status == hal::BusStatus::kOk) late = trouble;
    }
    if (const int motor = unsolved(bus); motor >= 0) {
      return {.status = hal::BusStatus::kLost,
              .bus = at,
              .motor = motor,
              .trouble = drives::Trouble::kPositionJump,
              .health = bus.link->health()};
    }
    if (!bus.setup->imu || imu_.age_cycles() <= XsensImu::kLateCycles) continue;
    const bool silent = imu_.age_cycles() > XsensImu::kSilentCycles;
    const BusTrouble trouble = {
        .status = silent ? hal::BusStatus::kLost : hal::BusStatus::kStale, .bus = at, .imu = true};
    if (silent) return trouble;
    if (late.status == hal::BusStatus::kOk) late = trouble;
  }
  return late;
}

}  // namespace pmg::can
