#include "teleoperation/led_robot.hpp"

#include "arms/arm_setup.hpp"

namespace pmg::teleoperation {

namespace {

const Eigen::Vector3d kPalmHalfSize_m(0.04, 0.015, 0.045);  // ASSUMPTION: about the collision ball of Z1's hand
constexpr double kPalmFriction = 0.8;

}  // namespace

std::vector<sim::HandBox> palm_boxes(const model::RobotModel& robot) {
  std::vector<sim::HandBox> boxes;
  if (const auto setup = arms::read_arm_setup(robot)) {
    for (const arms::PalmSetup& palm : setup->palm)
      boxes.push_back(
          {.link = palm.link, .T_LH = palm.T_LP, .half_size_m = kPalmHalfSize_m, .friction = kPalmFriction});
  }
  return boxes;
}

LedRobot::LedRobot(control::LoadedControl& loaded, const sim::WorldOptions& world)
    : model_(loaded.robot),
      world_(loaded.robot, world),
      bus_(world_),
      comms_(link_, inbox_, outbox_, loaded.robot, run_, 1.0 / control::ControlCycle::kPeriod_s, clock_),
      tick_(control::make_tick(loaded, clock_)),
      bus_cycle_(bus_, bus_link_, loaded.robot, clock_, tick_->guard()),
      cycle_(*tick_, bus_link_, inbox_, clock_) {
  driver_.set_limits(loaded.robot.command_limits);
  if (const auto setup = arms::read_arm_setup(loaded.robot)) headset_.set_robot_span(arms::span_m(*setup));
  headset_.begin(clock_.now_ns());
}

void LedRobot::step(const vr::VrNews* news) {
  for (int cycle = 0; cycle < control::ControlCycle::kBusCycles; ++cycle) {
    clock_.advance_to(clock_.now_ns() + hal::BusCycle::kPeriod_ns);
    bus_cycle_.run();
  }
  link_.receive(0);
  cycle_.run(clock_.now_ns());
  outbox_.publish(cycle_.record());
  comms_.step(0);
  link_.receive(0);
  if (news != nullptr) headset_.take(*news, clock_.now_ns());
  headset_.learn(arms_.of(kName));
  const auto& robots = board_.robots();
  const auto found = robots.find(kName);
  driver_.step(found == robots.end() ? nullptr : &found->second);
  if (stand_) stand_->step();
}

void LedRobot::ask_for_stand() { stand_.emplace(source_, kName, ops::Goal::kStand, 10.0); }

std::optional<std::int8_t> LedRobot::mode() const {
  const ops::HeardRobot* heard = source_.heard(kName);
  return heard == nullptr || !heard->status ? std::nullopt : std::optional(heard->status->mode);
}

std::string LedRobot::text() const { return driver_.text(); }

}  // namespace pmg::teleoperation
