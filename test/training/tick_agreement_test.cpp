// Training and the controller's tick compose the same: for every variant, the same commands give the same references,
// the same observed command and, for the same robot states, the same observation, bit for bit.
#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "control/fixtures.hpp"
#include "pmg_batch.h"
#include "policy/observation.hpp"

namespace pmg::test {
namespace {

/// Follows the reference, and keeps what it was given and what the controller's network would have seen of it.
class Witness final : public policy::Policy {
 public:
  Witness(const model::RobotModel& robot, Variant variant)
      : own_variant(variant), observation(robot), action(Eigen::VectorXf::Zero(actions(observation))) {}
  static Eigen::Index actions(const policy::Observation& observation) {
    return static_cast<Eigen::Index>(observation.layout().action_joints().size());
  }
  Variant variant() const override { return own_variant; }
  bool needs_ground() const override { return false; }  // its robot has no torques
  void reset() noexcept override {
    observation.reset();
    ++resets;
  }
  policy::Status act(const model::RobotState& state, const Reference& given, const Command& command,
                     JointVector& q_des) noexcept override {
    ++calls;
    reference = given;
    observed = command;
    seen = observation.assemble(state, given, command, action);
    q_des = given.q;
    return policy::Status::kOk;
  }

  Variant own_variant;
  policy::Observation observation;
  Eigen::VectorXf action;
  int calls = 0, resets = 0;
  Reference reference;
  Command observed;
  Eigen::VectorXf seen;
};

/// The other side: one stream of the library that training loads.
class Trained {
 public:
  Trained(const model::RobotModel& robot, Variant variant)
      : batch_(pmg_batch_create(robot.directory.c_str(), to_string(variant), 1, 1, 1), pmg_batch_destroy),
        description_(nlohmann::json::parse(pmg_batch_description(batch_.get()))),
        row_(description_["row_size"].get<std::size_t>()),
        seen_(description_["observation"]["size"].get<std::size_t>()) {}

  void reset() { pmg_batch_reset(batch_.get()); }
  void step(const Command& user) {
    const std::vector<float> asked(user.u.begin(), user.u.end());
    ASSERT_EQ(pmg_batch_run(batch_.get(), 1, asked.data(), row_.data()), 0);
  }
  const std::vector<float>& observe(bool first, const model::RobotState& state, const Eigen::VectorXf& action) {
    const Eigen::Quaterniond& quat = state.orientation_WI;
    const double wxyz[] = {quat.w(), quat.x(), quat.y(), quat.z()};
    pmg_batch_observe(batch_.get(), first ? 1 : 0, state.gyro_rad_s.data(), wxyz, state.q.data(), state.dq.data(),
                      action.data(), seen_.data());
    return seen_;
  }
  template <typename Values>
  void expect_field(const std::string& name, const Values& values) const {
    std::size_t at = field(name);
    for (const auto& value : values) ASSERT_EQ(row_[at++], static_cast<float>(value)) << name;
  }

 private:
  std::size_t field(const std::string& name) const {
    for (const auto& field : description_["fields"]) {
      if (field["name"] == name) return field["offset"].get<std::size_t>();
    }
    ADD_FAILURE() << "no field " << name;
    return 0;
  }

  std::unique_ptr<pmg_batch, void (*)(pmg_batch*)> batch_;
  nlohmann::json description_;
  std::vector<float> row_, seen_;
};

class TickAgreement : public testing::TestWithParam<Variant> {
 protected:
  double random(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  /// Beyond the ranges too; numbers that a float holds, because that is what training hands over.
  Command random_command(const model::RobotModel& robot) {
    Command command;
    for (std::size_t c = 0; c < kChannels; ++c) {
      if (random(0.0, 1.0) < 0.3) continue;
      const double value = 1.2 * random(robot.command_limits.lower[c], robot.command_limits.upper[c]);
      command.u[c] = static_cast<double>(static_cast<float>(value));
    }
    return command;
  }
  /// A robot that stands nearly well: no fault ends the comparison.
  model::RobotState random_state(const model::RobotModel& robot, model::RobotState state) {
    state.q = robot.q_stand();
    for (Eigen::Index i = 0; i < state.q.size(); ++i) {
      state.q[i] += random(-0.02, 0.02);
      state.dq[i] = random(-0.2, 0.2);
    }
    state.gyro_rad_s = {random(-0.2, 0.2), random(-0.2, 0.2), random(-0.2, 0.2)};
    return state;
  }

  std::mt19937_64 random_{20};
};

TEST_P(TickAgreement, ReferenceObservedCommandAndObservationAreTrainingsBitForBit) {
  const model::RobotModel& robot = z1();
  auto own = std::make_unique<Witness>(robot, GetParam());
  Witness& witness = *own;
  const io::SimulationClock clock;
  control::TickOptions options = control::tick_options(robot);
  // Random states don't follow their commands; what that means for a robot is not the matter here.
  options.supervisor.fault_limits.torso_error_rad = options.supervisor.fault_limits.tilt_rad = 10.0;
  control::Tick tick(robot, clips(robot), std::move(own), clock, options);
  Trained training(robot, GetParam());

  control::DriveMessage drive;
  control::ModeRequest request;
  drive.source = request.source = control::Source::make("test", 1);
  drive.lease_s = 0.5;
  model::RobotState state = standing_state(robot);
  std::int64_t now_ns = 0;
  int walked = 0;
  for (int k = 0; k < 1500; ++k) {
    // In the middle it is laid down and picked up again.
    request.mode = k >= 800 && k < 820 ? control::Mode::kDamping : control::Mode::kWalk;
    if (k % 150 == 0) drive.command = random_command(robot);
    state = random_state(robot, state);
    now_ns += 10'000'000;
    state.stamp_ns = drive.stamp_ns = drive.received_ns = request.stamp_ns = request.received_ns = now_ns;
    state.bus_sample += 5;
    ++drive.sequence;
    ++request.sequence;
    const int calls = witness.calls, resets = witness.resets;
    const control::TickResult& result =
        tick.step({.state = state, .now_ns = now_ns, .drives = {&drive, 1}, .requests = {&request, 1}});
    ASSERT_EQ(result.fault.code, faults::FaultCode::kNone) << describe(result.fault, robot);
    if (witness.resets > resets) training.reset();
    if (witness.calls == calls) continue;
    walked += result.mode == control::Mode::kWalk;

    training.step(result.user);
    SCOPED_TRACE("tick " + std::to_string(k));
    training.expect_field("command", witness.reference.command.u);
    training.expect_field("optimised", witness.observed.u);
    training.expect_field("q_ref", witness.reference.q);
    training.expect_field("dq_ref", witness.reference.dq);
    training.expect_field("contact", witness.reference.contact);
    training.expect_field("contact_weight", witness.reference.contact_weight);
    const std::vector<float>& seen = training.observe(witness.resets > resets, state, witness.action);
    ASSERT_EQ(seen, std::vector<float>(witness.seen.begin(), witness.seen.end()));
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(walked, 1000) << "the comparison must see a walk";
  EXPECT_EQ(witness.resets, 2);
}

INSTANTIATE_TEST_SUITE_P(TableI, TickAgreement,
                         testing::Values(Variant::kPmg, Variant::kWithoutGco, Variant::kSingleGait),
                         [](const auto& variant) { return std::string(to_string(variant.param)); });

}  // namespace
}  // namespace pmg::test
