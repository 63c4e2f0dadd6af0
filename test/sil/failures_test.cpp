// Failures from a file: strict reading, and each leads to the fault and within the bus cycles that the page promises.
#include "sil/failures.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "files/config_error.hpp"
#include "sil/failing_parts.hpp"
#include "sil/failure_report.hpp"
#include "sil/varied_robot.hpp"
#include "temporary_folder.hpp"

namespace pmg::sil {
namespace {

using faults::FaultCode;
using ::testing::HasSubstr;

class FailureFile : public testing::Test {
 protected:
  std::string refusal(const std::string& entry) const {
    std::ofstream(file_) << "failures:\n  - {" << entry << "}\n";
    try {
      load_failures(file_, test::z1());
    } catch (const files::ConfigError& error) {
      return error.what();
    }
    return "accepted";
  }
  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.file("failures.yaml");
};

TEST_F(FailureFile, EveryKindIsReadWithWhatItNeedsAndNothingElse) {
  EXPECT_EQ(refusal("kind: stall, at_s: 1, for_s: 0.25"), "accepted");
  EXPECT_EQ(refusal("kind: hot, at_s: 1, for_s: 1, joint: left_knee, value: 95"), "accepted");
  EXPECT_THAT(refusal("kind: hott, at_s: 1, for_s: 1"), HasSubstr("did you mean hot"));
  EXPECT_THAT(refusal("kind: hot, at_s: 1, for_s: 1, value: 95"), HasSubstr("joint"));
  EXPECT_THAT(refusal("kind: stall, at_s: 1, for_s: 1, joint: left_knee"), HasSubstr("joint: is unknown"));
  EXPECT_THAT(refusal("kind: packet_loss, at_s: 1, for_s: 1, value: 101"), HasSubstr("from 0 to 100"));
  EXPECT_THAT(refusal("kind: stall, at_s: -1, for_s: 1"), HasSubstr("at_s"));
}

struct Row {
  const char* name;
  Failure failure;
  FaultCode code;  ///< kNone: no fault
  /// Bus cycles that lockstep counts more than the page: an overrun's own command, which comes two cycles late there,
  /// is in time here; a command of the tick at the failure's beginning reaches the guard one cycle later.
  int more = 0;
};

class Injected : public testing::TestWithParam<Row> {};

TEST_P(Injected, LeadsToItsFaultWithinThePromisedCycles) {
  const Row& row = GetParam();
  FailureClock clock;
  const std::vector<Failure> failures = {row.failure};
  FailingTick failing_tick(failures, clock, false);
  test::VariedRobot it(
      0, "pmg", [&](auto own) { return std::make_unique<FailingPolicy>(std::move(own), failures, clock, false); },
      [&](control::TickOptions& options) { options.spoiler = &failing_tick; });
  FailingBus bus(it.drives, failures, it.robot, clock, false);
  test::ScriptedOperator driver;
  driver.then(1.5, control::Mode::kStand).then(4.5, control::Mode::kWalk, Command{{0.3, 0.0, 0.0, 0.0, 0.0, 0.0}});
  Lockstep lockstep(it.robot, bus, it.plant, *it.tick, driver.scenario, nullptr, {.balanced_by_policy = true});
  lockstep.bus_sleeps = [&] { return bus.bus_sleeps(); };
  lockstep.control_sleeps = [&] { return bus.control_sleeps(); };
  lockstep.overrun_s = [&] { return bus.overrun_s(); };
  lockstep.while_bus_sleeps = [&] { bus.idle(); };
  const RunOutcome outcome = lockstep.run();
  const nlohmann::ordered_json told = failures_json(failures, bus.reactions(), outcome.faults)[0];
  if (row.code == FaultCode::kNone) {
    EXPECT_TRUE(outcome.faults.empty()) << told.dump();
    return;
  }
  ASSERT_FALSE(outcome.faults.empty());
  EXPECT_EQ(outcome.faults[0].code, row.code) << told.dump();
  const faults::Reaction promised = faults::reaction(row.code);
  const int sit_more = promised.sit_down.most < 0 ? 0 : row.more;
  const FailureReaction& measured = bus.reactions()[0];
  EXPECT_GE(measured.cycles_to_damping, promised.damping.least + row.more) << told.dump();
  EXPECT_LE(measured.cycles_to_damping, promised.damping.most + row.more) << told.dump();
  EXPECT_GE(measured.cycles_to_sit_down, promised.sit_down.least + sit_more) << told.dump();
  EXPECT_LE(measured.cycles_to_sit_down, promised.sit_down.most + sit_more) << told.dump();
  EXPECT_THAT(failures_text(nlohmann::ordered_json::array({told})), HasSubstr(to_string(row.code)));
}

constexpr double kAt_s = 3.0;
const int kKnee = 3;

INSTANTIATE_TEST_SUITE_P(
    Kinds, Injected,
    testing::Values(
        Row{"EncoderLost", {FailureKind::kEncoderLost, kAt_s, 9, kKnee}, FaultCode::kStateNotFinite},
        Row{"EncoderOffset", {FailureKind::kEncoderOffset, kAt_s, 9, kKnee, -5.0}, FaultCode::kJointLimit},
        Row{"Speed", {FailureKind::kSpeedReading, kAt_s, 9, kKnee, 100.0}, FaultCode::kJointVelocity},
        Row{"Torque", {FailureKind::kTorqueReading, kAt_s, 9, kKnee, 500.0}, FaultCode::kJointTorque},
        Row{"Hot", {FailureKind::kHot, kAt_s, 9, kKnee, 95.0}, FaultCode::kTemperature},
        Row{"ImuLost", {FailureKind::kImuLost, kAt_s, 9}, FaultCode::kStateNotFinite},
        Row{"AllPacketsLost", {FailureKind::kPacketLoss, kAt_s, 9, -1, 100.0}, FaultCode::kStaleState},
        Row{"FewPacketsLost", {FailureKind::kPacketLoss, kAt_s, 9, -1, 5.0}, FaultCode::kNone},
        Row{"BusLost", {FailureKind::kBusLost, kAt_s, 9}, FaultCode::kBusLost},
        Row{"ControlStalls", {FailureKind::kStallControl, kAt_s, 0.2}, FaultCode::kControlFrozen},
        Row{"ShortStall", {FailureKind::kStall, kAt_s, 0.03}, FaultCode::kNone},
        Row{"PolicyLate", {FailureKind::kPolicyLate, kAt_s, 9}, FaultCode::kStalePolicy},
        Row{"PolicyNotFinite", {FailureKind::kPolicyNotFinite, kAt_s, 9}, FaultCode::kPolicyNotFinite},
        Row{"PolicyFar", {FailureKind::kPolicyFar, kAt_s, 9, 13, 2.5}, FaultCode::kActionOutOfRange},
        Row{"Overrun", {FailureKind::kOverrun, kAt_s, 9, -1, 0.012}, FaultCode::kOverrun, -2},
        Row{"ReferenceNotFinite", {FailureKind::kReferenceNotFinite, kAt_s, 9}, FaultCode::kReferenceNotFinite},
        Row{"CommandNotFinite", {FailureKind::kCommandNotFinite, kAt_s, 9}, FaultCode::kCommandNotFinite, 1}),
    [](const auto& row) { return std::string(row.param.name); });

}  // namespace
}  // namespace pmg::sil
