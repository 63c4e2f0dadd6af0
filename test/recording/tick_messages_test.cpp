// Messages hold what the controller's values say: no field is forgotten, and what is read back is what was written.
#include "recording/tick_messages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "control/fixtures.hpp"
#include "folders.hpp"
#include "pmg_msgs/message_fields.hpp"

namespace pmg::recording {
namespace {

template <typename T>
void poison(T& value, int seed) {
  value = static_cast<T>(seed);
}
void poison(std::string& value, int seed) { value = "left over " + std::to_string(seed); }
template <typename T, std::size_t N>
void poison(T (&values)[N], int seed) {
  for (T& value : values) poison(value, seed);
}
template <typename T>
void poison(std::vector<T>& values, int seed) {
  values.resize(1);
  poison(values.front(), seed);
}

template <typename T>
bool same(const T& a, const T& b) {
  if constexpr (std::is_array_v<T>) {
    return std::ranges::equal(a, b);
  } else {
    return a == b;
  }
}

/// Fields that keep what the message held before.
template <typename Message, typename Fill>
std::vector<std::string> untouched(Fill&& fill_it) {
  Message one{}, other{};
  std::vector<std::string> names;
  const auto each = [](auto&& apply) {
    std::apply([&](const auto&... field) { (apply(field), ...); }, pmg_msgs::kFields<Message>);
  };
  each([&](const auto& field) {
    poison(one.*field.access, 3);
    poison(other.*field.access, 5);
  });
  fill_it(one);
  fill_it(other);
  each([&](const auto& field) {
    if (!same(one.*field.access, other.*field.access)) names.emplace_back(field.name);
  });
  return names;
}

class TickMessages : public testing::Test {
 protected:
  TickMessages() {
    record_->state = test::standing_state(robot_);
    record_->result.reference.q = record_->result.reference.dq = robot_.q_stand();
    model::JointCommand& command = record_->result.command;
    for (JointVector* values : {&command.q, &command.dq, &command.kp, &command.kd, &command.tau_ff})
      *values = robot_.q_stand();
    record_->drive_count = record_->request_count = record_->arms_count = 1;
    record_->result.limited.by[2] = 1;
  }
  const model::RobotModel robot_ = model::load_robot(pmg::test::project_folder() + "/config/robots/z1");
  const int joints_ = robot_.joint_index.size();
  const RunInfo run_{.robot = "z1", .files = {{"robot.yaml", "00"}}, .refused = {"memory locking"}};
  const std::unique_ptr<control::TickRecord> record_ = std::make_unique<control::TickRecord>();  // records are large
};

TEST_F(TickMessages, NoFieldOfAMessageIsForgotten) {
  using namespace pmg_msgs;
  using Names = std::vector<std::string>;
  const Names none, robot = {"robot"};  // TickLog and Comms set the robot's name once
  const control::TickRecord& record = *record_;
  EXPECT_EQ(untouched<robot_info_t>([&](auto& m) { fill(run_, robot_, 100.0, 7, m); }), none);
  EXPECT_EQ(untouched<robot_state_t>([&](auto& m) { fill(record, joints_, m); }), robot);
  EXPECT_EQ(untouched<reference_t>([&](auto& m) { fill(record, joints_, m); }), robot);
  EXPECT_EQ(untouched<motor_command_t>([&](auto& m) { fill(record, joints_, m); }), robot);
  EXPECT_EQ(untouched<status_t>([&](auto& m) { fill(record, run_, robot_, m); }), none);
  EXPECT_EQ(untouched<limited_t>([&](auto& m) { fill(record, m); }), none);
  EXPECT_EQ(untouched<tick_input_t>([&](auto& m) { fill(record, m); }), none);
  EXPECT_EQ(untouched<timing_t>([&](auto& m) { fill(record, BusTiming{}, control::DroppedItems{}, m); }), robot);
  EXPECT_EQ(untouched<fault_t>([&](auto& m) { fill(record, run_, robot_, m); }), none);
  EXPECT_EQ(untouched<command_t>([&](auto& m) { fill(record.drives[0], run_, m); }), none);
  EXPECT_EQ(untouched<pmg_msgs::mode_t>([&](auto& m) { fill(record.requests[0], run_, m); }), none);
  EXPECT_EQ(untouched<arms_t>([&](auto& m) { fill(record.arms[0], run_, m); }), none);
  EXPECT_EQ(untouched<arms_input_t>([&](auto& m) { fill(record, m); }), none);
  EXPECT_EQ(untouched<arms_state_t>([&](auto& m) { fill(record, run_, m); }), none);
  EXPECT_EQ(untouched<ack_t>([&](auto& m) { fill(control::ModeAck{}, run_, 7, m); }), none);
  EXPECT_EQ(untouched<ground_truth_t>([&](auto& m) { fill(7, model::GroundTruth{}, false, m); }), none);
}

TEST_F(TickMessages, OfOneTickCarryTheStampOfItsStatusAndAStateThatOfItsSample) {
  record_->now_ns = 77;
  record_->state.stamp_ns = 75;
  pmg_msgs::status_t status;
  pmg_msgs::reference_t reference;
  pmg_msgs::motor_command_t command;
  pmg_msgs::timing_t timing;
  pmg_msgs::robot_state_t state;
  fill(*record_, run_, robot_, status);
  fill(*record_, joints_, reference);
  fill(*record_, joints_, command);
  fill(*record_, BusTiming{}, control::DroppedItems{}, timing);
  fill(*record_, joints_, state);
  EXPECT_EQ(status.stamp_ns, 77);
  EXPECT_EQ(reference.stamp_ns, 77);
  EXPECT_EQ(command.stamp_ns, 77);
  EXPECT_EQ(timing.stamp_ns, 77);
  EXPECT_EQ(state.stamp_ns, 75);
}

TEST_F(TickMessages, AStatusSaysThatTheRobotSitsDownUntilTheDrivesDamp) {
  pmg_msgs::status_t status;
  record_->result.fault.code = faults::FaultCode::kTemperature;
  record_->result.fault.joint = 2;
  record_->result.maker = control::TargetMaker::kLoweredByPolicy;
  fill(*record_, run_, robot_, status);
  EXPECT_TRUE(status.fault.starts_with("sitting down; temperature")) << status.fault;
  record_->result.maker = control::TargetMaker::kNobody;
  fill(*record_, run_, robot_, status);
  EXPECT_TRUE(status.fault.starts_with("temperature")) << status.fault;
}

TEST_F(TickMessages, AStateIsReadBackAsItWas) {
  model::RobotState& state = record_->state;
  state.stamp_ns = 12;
  state.bus_sample = 60;
  for (Eigen::Index i = 0; i < joints_; ++i) {
    const auto number = static_cast<double>(i);
    state.q[i] += 0.001 * number;
    state.dq[i] = 0.1 + number;
    state.tau[i] = -number;
    state.temperature_degC[i] = 20.0 + number;
  }
  state.gyro_rad_s = {1.0, 2.0, 3.0};
  state.acceleration_m_s2 = {4.0, 5.0, 6.0};
  state.orientation_WI = {0.1, 0.2, 0.3, 0.4};
  pmg_msgs::robot_state_t message;
  fill(*record_, joints_, message);
  EXPECT_EQ(message.orientation_WI[0], 0.1) << "w first";
  model::RobotState read;
  ASSERT_TRUE(robot_state(message, joints_, read));
  EXPECT_EQ(read.stamp_ns, state.stamp_ns);
  EXPECT_EQ(read.bus_sample, state.bus_sample);
  EXPECT_EQ(read.q, state.q);
  EXPECT_EQ(read.dq, state.dq);
  EXPECT_EQ(read.tau, state.tau);
  EXPECT_EQ(read.temperature_degC, state.temperature_degC);
  EXPECT_EQ(read.gyro_rad_s, state.gyro_rad_s);
  EXPECT_EQ(read.acceleration_m_s2, state.acceleration_m_s2);
  EXPECT_EQ(read.orientation_WI.coeffs(), state.orientation_WI.coeffs());
  message.torque_Nm.pop_back();
  EXPECT_FALSE(robot_state(message, joints_, read)) << "a vector of another robot";
}

TEST_F(TickMessages, AnOperatorsMessagesAreReadBackAsTheyWere) {
  control::DriveMessage drive{.source = control::Source::make("gamepad", 5),
                              .sequence = 9,
                              .stamp_ns = 11,
                              .received_ns = 13,
                              .lease_s = 0.25,
                              .command = {{0.1, 0.2, 0.3, 0.4, 0.5, 0.6}}};
  pmg_msgs::command_t command;
  fill(drive, run_, command);
  const control::DriveMessage driven = drive_message(command, 13);
  EXPECT_EQ(driven.source, drive.source);
  EXPECT_EQ(driven.sequence, drive.sequence);
  EXPECT_EQ(driven.stamp_ns, drive.stamp_ns);
  EXPECT_EQ(driven.received_ns, drive.received_ns);
  EXPECT_EQ(driven.lease_s, drive.lease_s);
  EXPECT_EQ(driven.command.u, drive.command.u);
  EXPECT_EQ(command.roll_rad, 0.5);

  control::ModeRequest request;
  request.source = drive.source;
  request.mode = control::Mode::kStand;
  request.reset_fault = true;
  pmg_msgs::mode_t mode;
  fill(request, run_, mode);
  const control::ModeRequest asked = mode_request(mode, 17);
  EXPECT_EQ(asked.source, request.source);
  EXPECT_EQ(asked.mode, request.mode);
  EXPECT_TRUE(asked.reset_fault);
  EXPECT_EQ(asked.received_ns, 17);
  EXPECT_TRUE(asked.sealed);
  request.sealed = false;
  fill(request, run_, mode);
  EXPECT_FALSE(mode_request(mode, 17).sealed) << "a replay must know that a stop came without a seal";
  mode.version = 1;
  EXPECT_TRUE(mode_request(mode, 17).sealed) << "logs from before seals";
}

TEST_F(TickMessages, ArmsAreReadBackAsTheyWere) {
  control::ArmsMessage arms{
      .source = control::Source::make("vr", 5), .sequence = 9, .stamp_ns = 11, .received_ns = 13, .lease_s = 0.25};
  arms.arm[kLeft] = {.wish = control::ArmWish::kAim, .palm = {.p_m = {0.1, 0.2, 0.3}, .R = {0.5, 0.5, -0.5, 0.5}}};
  arms.arm[kRight] = {.wish = control::ArmWish::kHandBack, .palm = {.p_m = {4.0, 5.0, 6.0}, .R = {0.0, 0.6, 0.0, 0.8}}};
  pmg_msgs::arms_t message;
  fill(arms, run_, message);
  EXPECT_EQ(message.version, pmg_msgs::arms_t::VERSION);
  EXPECT_EQ(message.left_orientation[2], -0.5) << "w first";
  const control::ArmsMessage read = arms_message(message, 13);
  EXPECT_EQ(read.source, arms.source);
  EXPECT_EQ(read.sequence, 9);
  EXPECT_EQ(read.stamp_ns, 11);
  EXPECT_EQ(read.received_ns, 13);
  EXPECT_EQ(read.lease_s, 0.25);
  EXPECT_EQ(read.arm, arms.arm);
}

TEST_F(TickMessages, ConstantsOfArmsAreTheControllersNumbers) {
  using State = pmg_msgs::arms_state_t;
  using control::ArmsOrder;
  using Verdict = control::CommandIntake::DriveVerdict;
  const auto number = [](auto value) { return static_cast<std::int8_t>(value); };
  EXPECT_EQ(number(control::ArmWish::kHandBack), pmg_msgs::arms_t::HAND_BACK);
  EXPECT_EQ(number(arms::ArmActivity::kReference), State::REFERENCE);
  EXPECT_EQ(number(arms::ArmActivity::kReturning), State::RETURNING);
  EXPECT_EQ(number(arms::ArmActivity::kBlocked), State::BLOCKED);
  EXPECT_EQ(number(ArmsOrder::kInForce), State::IN_FORCE);
  EXPECT_EQ(number(ArmsOrder::kNoneCame), State::NONE_CAME);
  EXPECT_EQ(number(ArmsOrder::kLeaseOver), State::LEASE_OVER);
  EXPECT_EQ(number(ArmsOrder::kNotWalking), State::NOT_WALKING);
  EXPECT_EQ(number(Verdict::kAccepted), State::NEVER);
  EXPECT_EQ(number(Verdict::kOtherSourceDrives), State::OTHER_SOURCE);
  EXPECT_EQ(number(Verdict::kOutOfOrder), State::OUT_OF_ORDER);
  EXPECT_EQ(number(Verdict::kLate), State::LATE);
  EXPECT_EQ(number(Verdict::kNotFinite), State::NO_POSE);
  EXPECT_EQ(number(Verdict::kNoLease), State::NO_LEASE);
}

}  // namespace
}  // namespace pmg::recording
