// docs/reference/safety.md, row by row.
#include "control/supervisor.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "control/fixtures.hpp"

namespace pmg::control {
namespace {

using test::kNan;

class SupervisorTest : public testing::Test {
 protected:
  void ask(Mode mode, bool reset = false) {
    ModeRequest request;
    request.mode = mode;
    request.reset_fault = reset;
    supervisor_.request(request);
  }
  Mode update() {
    now_ns_ += 10'000'000;
    if (!frozen_stamp_) state_.stamp_ns = now_ns_;
    return supervisor_.update({.evidence = {.state = state_, .bus = bus_, .now_ns = now_ns_, .torso = torso_},
                               .command_age_s = command_age_s_,
                               .entry_done = entry_done_,
                               .at_rest = at_rest_});
  }
  Mode update(int times) {
    for (int i = 0; i < times; ++i) update();
    return supervisor_.mode();
  }
  void reach(Mode mode) {
    ask(mode);
    ASSERT_EQ(update(4), mode);
  }

  Supervisor supervisor_{test::biped(), {}};
  model::RobotState state_ = test::standing_state(test::biped());
  hal::BusStatus bus_ = hal::BusStatus::kOk;
  std::int64_t now_ns_ = 0;
  std::optional<faults::RollPitchAim> torso_ = faults::RollPitchAim{};
  bool frozen_stamp_ = false, entry_done_ = true, at_rest_ = true;
  double command_age_s_ = 0.0;
};

TEST_F(SupervisorTest, ClimbsOneModeATick) {
  ask(Mode::kWalk);
  EXPECT_EQ(update(), Mode::kDamping);
  EXPECT_EQ(update(), Mode::kStand);
  EXPECT_EQ(update(), Mode::kWalk);
}

TEST_F(SupervisorTest, StaysPassiveUntilAsked) { EXPECT_EQ(update(100), Mode::kPassive); }

TEST_F(SupervisorTest, WalksOnlyAfterTheEntryRamp) {
  entry_done_ = false;
  ask(Mode::kWalk);
  EXPECT_EQ(update(50), Mode::kStand);
  entry_done_ = true;
  EXPECT_EQ(update(), Mode::kWalk) << "the request has waited";
}

TEST_F(SupervisorTest, DampingIsReachedFromEveryModeInOneTick) {
  for (const Mode from : {Mode::kPassive, Mode::kDamping, Mode::kStand, Mode::kWalk}) {
    SCOPED_TRACE(to_string(from));
    if (from != Mode::kPassive) reach(from);
    at_rest_ = entry_done_ = from != Mode::kWalk;  // also in the middle of a step or a ramp
    ask(Mode::kDamping);
    EXPECT_EQ(update(), Mode::kDamping);
    at_rest_ = entry_done_ = true;
  }
}

TEST_F(SupervisorTest, GoesLimpOnlyFromDamping) {
  for (const Mode from : {Mode::kStand, Mode::kWalk}) {
    reach(from);
    ask(Mode::kPassive);
    EXPECT_EQ(update(), Mode::kDamping) << to_string(from);
    EXPECT_EQ(update(10), Mode::kDamping) << to_string(from);
    ask(Mode::kPassive);
    EXPECT_EQ(update(), Mode::kPassive) << to_string(from);
  }
}

TEST_F(SupervisorTest, StandRequestStopsWalkingFirst) {
  reach(Mode::kWalk);
  at_rest_ = false;
  ask(Mode::kStand);
  Command user;
  user[kVx] = 0.3;
  user[kPitch] = 0.1;
  EXPECT_EQ(update(10), Mode::kWalk);
  EXPECT_EQ(supervisor_.admit(user)[kVx], 0.0);
  EXPECT_EQ(supervisor_.admit(user)[kPitch], 0.1) << "the posture is kept while stopping";
  at_rest_ = true;
  EXPECT_EQ(update(), Mode::kStand);
  EXPECT_EQ(supervisor_.admit(user), Command{});
  reach(Mode::kWalk);
  at_rest_ = false;
  ask(Mode::kStand);
  EXPECT_EQ(update(50), Mode::kWalk);
  EXPECT_EQ(update(), Mode::kStand) << "0.5 s later, whatever the reference does";
}

TEST_F(SupervisorTest, StaleCommandEndsInStandAndIsNotLatched) {
  reach(Mode::kWalk);
  at_rest_ = false;
  command_age_s_ = 0.19;
  EXPECT_EQ(update(100), Mode::kWalk);
  command_age_s_ = 0.21;
  EXPECT_EQ(update(), Mode::kWalk);
  Command user;
  user[kOmega] = 0.4;
  EXPECT_EQ(supervisor_.admit(user)[kOmega], 0.0);
  EXPECT_EQ(update(49), Mode::kWalk);
  EXPECT_EQ(update(), Mode::kStand) << "0.5 s later, whatever the reference does";
  at_rest_ = true;
  command_age_s_ = 0.0;
  EXPECT_EQ(update(10), Mode::kStand) << "a link that comes back does not start the robot";
  ask(Mode::kWalk);
  EXPECT_EQ(update(), Mode::kWalk) << "but nothing has to be reset";
}

TEST_F(SupervisorTest, WalkIsRefusedWithoutAFreshCommand) {
  reach(Mode::kStand);
  for (const double age_s : {0.201, std::numeric_limits<double>::infinity()}) {
    command_age_s_ = age_s;
    ask(Mode::kWalk);
    EXPECT_EQ(update(21), Mode::kStand);
    command_age_s_ = 0.0;
    EXPECT_EQ(update(10), Mode::kStand) << "a refused request is forgotten";
  }
  command_age_s_ = 0.2;
  ask(Mode::kWalk);
  EXPECT_EQ(update(), Mode::kWalk);
}

TEST_F(SupervisorTest, AWalkRequestThatOvertookItsFirstCommandWaitsForItAsLongAsACommandMayBeOld) {
  for (const int ticks : {1, 19}) {
    reach(Mode::kStand);
    command_age_s_ = std::numeric_limits<double>::infinity();
    ask(Mode::kWalk);
    EXPECT_EQ(update(ticks), Mode::kStand);
    command_age_s_ = 0.0;
    EXPECT_EQ(update(), Mode::kWalk);
  }
  reach(Mode::kStand);
  command_age_s_ = std::numeric_limits<double>::infinity();
  ask(Mode::kWalk);
  update();
  ask(Mode::kStand);
  command_age_s_ = 0.0;
  EXPECT_EQ(update(10), Mode::kStand) << "a later request replaces it";
}

TEST_F(SupervisorTest, FaultIsLatchedUntilResetAndThenDamps) {
  reach(Mode::kWalk);
  bus_ = hal::BusStatus::kLost;
  EXPECT_EQ(update(), Mode::kFault);
  EXPECT_EQ(supervisor_.fault().code, faults::FaultCode::kBusLost);
  ask(Mode::kDamping, true);
  EXPECT_EQ(update(), Mode::kFault) << "its cause is still there";
  bus_ = hal::BusStatus::kOk;
  for (const Mode mode : {Mode::kPassive, Mode::kDamping, Mode::kStand, Mode::kWalk}) {
    ask(mode);
    EXPECT_EQ(update(3), Mode::kFault) << "a request is no reset";
  }
  ask(Mode::kDamping, true);
  EXPECT_EQ(update(), Mode::kDamping);
  EXPECT_EQ(supervisor_.fault().code, faults::FaultCode::kNone);
}

TEST_F(SupervisorTest, FirstFaultIsKept) {
  reach(Mode::kStand);
  state_.q[2] = kNan;
  update();
  bus_ = hal::BusStatus::kLost;
  update();
  EXPECT_EQ(supervisor_.fault().code, faults::FaultCode::kStateNotFinite);
  EXPECT_EQ(supervisor_.fault().joint, 2);
}

TEST_F(SupervisorTest, OfSeveralFaultsInOneTickTheFirstOfTheTableIsKept) {
  using faults::FaultCode;
  const auto spoil = [&](FaultCode code) {
    const model::Joint& joint = test::biped().joints[3];
    if (code == FaultCode::kBusLost) bus_ = hal::BusStatus::kLost;
    if (code == FaultCode::kStateNotFinite) state_.q[2] = kNan;
    if (code == FaultCode::kTemperature) state_.temperature_degC[4] = 91.0;
    if (code == FaultCode::kJointLimit) state_.q[3] = joint.upper_rad + 0.2;
    if (code == FaultCode::kJointVelocity) state_.dq[3] = 2.0 * joint.velocity_limit_rad_s;
    if (code == FaultCode::kJointTorque) state_.tau[3] = 2.0 * joint.effort_limit_Nm;
    if (code == FaultCode::kTilt) {  // beyond torso_attitude's limit, too
      state_.orientation_WI = Eigen::AngleAxisd(1.1, Eigen::Vector3d::UnitY()) * state_.orientation_WI;
    }
  };
  const std::vector<std::vector<FaultCode>> together = {
      {FaultCode::kBusLost, FaultCode::kStateNotFinite, FaultCode::kTemperature},
      {FaultCode::kJointLimit, FaultCode::kJointVelocity, FaultCode::kJointTorque, FaultCode::kTilt}};
  for (const std::vector<FaultCode>& codes : together) {
    for (std::size_t first = 0; first < codes.size(); ++first) {
      supervisor_ = Supervisor(test::biped(), {});
      state_ = test::standing_state(test::biped());
      bus_ = hal::BusStatus::kOk;
      reach(Mode::kStand);
      for (std::size_t k = codes.size(); k > first; --k) spoil(codes[k - 1]);
      EXPECT_EQ(update(3), Mode::kFault);
      EXPECT_EQ(supervisor_.fault().code, codes[first]);
    }
  }
}

TEST_F(SupervisorTest, AFaultCannotBeAskedFor) {
  reach(Mode::kStand);
  ask(Mode::kFault);
  EXPECT_EQ(update(3), Mode::kStand);
}

/// One row of the fault table: the corruption of a state, and the number of ticks until it must latch in a holding
/// mode.
struct Row {
  const char* name;
  faults::FaultCode code;
  void (*spoil)(model::RobotState&, const model::RobotModel&);
  int ticks;
  bool while_damping;  ///< also a fault when the robot doesn't hold itself
};

const std::vector<Row> kRows = {
    {"NanInQ", faults::FaultCode::kStateNotFinite, [](auto& s, auto&) { s.q[1] = kNan; }, 1, true},
    {"InfInDq", faults::FaultCode::kStateNotFinite,
     [](auto& s, auto&) { s.dq[1] = std::numeric_limits<double>::infinity(); }, 1, true},
    {"NanInTorque", faults::FaultCode::kStateNotFinite, [](auto& s, auto&) { s.tau[0] = kNan; }, 1, true},
    {"NanInGyro", faults::FaultCode::kStateNotFinite, [](auto& s, auto&) { s.gyro_rad_s.x() = kNan; }, 1, true},
    {"NanInAcceleration", faults::FaultCode::kStateNotFinite, [](auto& s, auto&) { s.acceleration_m_s2.z() = kNan; }, 1,
     true},
    {"NanInOrientation", faults::FaultCode::kStateNotFinite, [](auto& s, auto&) { s.orientation_WI.w() = kNan; }, 1,
     true},
    {"ZeroOrientation", faults::FaultCode::kStateNotFinite, [](auto& s, auto&) { s.orientation_WI.coeffs().setZero(); },
     1, true},
    {"MissingJoints", faults::FaultCode::kStateNotFinite, [](auto& s, auto&) { s.q.conservativeResize(3); }, 1, true},
    {"Hot", faults::FaultCode::kTemperature, [](auto& s, auto&) { s.temperature_degC[4] = 91.0; }, 1, true},
    {"NanTemperature", faults::FaultCode::kTemperature, [](auto& s, auto&) { s.temperature_degC[4] = kNan; }, 1, true},
    {"BeyondUpperLimit", faults::FaultCode::kJointLimit,
     [](auto& s, auto& robot) { s.q[3] = robot.joints[3].upper_rad + 0.11; }, 3, false},
    {"BeyondLowerLimit", faults::FaultCode::kJointLimit,
     [](auto& s, auto& robot) { s.q[3] = robot.joints[3].lower_rad - 0.11; }, 3, false},
    {"TooFast", faults::FaultCode::kJointVelocity,
     [](auto& s, auto& robot) { s.dq[3] = 1.51 * robot.joints[3].velocity_limit_rad_s; }, 3, false},
    {"TooFastBackwards", faults::FaultCode::kJointVelocity,
     [](auto& s, auto& robot) { s.dq[3] = -1.51 * robot.joints[3].velocity_limit_rad_s; }, 3, false},
    {"TooMuchTorque", faults::FaultCode::kJointTorque,
     [](auto& s, auto& robot) { s.tau[3] = 1.21 * robot.joints[3].effort_limit_Nm; }, 3, false},
    {"TiltedForward", faults::FaultCode::kTilt,
     [](auto& s, auto&) { s.orientation_WI = Eigen::AngleAxisd(1.01, Eigen::Vector3d::UnitY()) * s.orientation_WI; }, 3,
     false},
    {"TiltedAside", faults::FaultCode::kTilt,
     [](auto& s, auto&) { s.orientation_WI = Eigen::AngleAxisd(-1.01, Eigen::Vector3d::UnitX()) * s.orientation_WI; },
     3, false},
    {"TorsoNotAsCommanded", faults::FaultCode::kTorsoAttitude,
     [](auto& s, auto&) { s.orientation_WI = Eigen::AngleAxisd(-0.61, Eigen::Vector3d::UnitY()) * s.orientation_WI; },
     3, false},
};

class FaultRow : public SupervisorTest, public testing::WithParamInterface<Row> {};

TEST_P(FaultRow, LatchesWhileHoldingAfterItsTicks) {
  for (const Mode mode : {Mode::kStand, Mode::kWalk}) {
    supervisor_ = Supervisor(test::biped(), {});
    state_ = test::standing_state(test::biped());
    reach(mode);
    GetParam().spoil(state_, test::biped());
    EXPECT_EQ(update(GetParam().ticks - 1), mode) << "one glitch of a sensor is no fault";
    EXPECT_EQ(update(), Mode::kFault);
    EXPECT_EQ(supervisor_.fault().code, GetParam().code);
    EXPECT_EQ(supervisor_.fault().stamp_ns, now_ns_);
    EXPECT_EQ(faults::describe(supervisor_.fault(), test::biped()).find(to_string(GetParam().code)), 0u);
  }
}

TEST_P(FaultRow, InDampingOnlySensingCounts) {
  reach(Mode::kDamping);
  GetParam().spoil(state_, test::biped());
  EXPECT_EQ(update(10), GetParam().while_damping ? Mode::kFault : Mode::kDamping);
}

TEST_P(FaultRow, PassiveIsLeftAlone) {
  GetParam().spoil(state_, test::biped());
  EXPECT_EQ(update(10), Mode::kPassive);
}

INSTANTIATE_TEST_SUITE_P(Table, FaultRow, testing::ValuesIn(kRows),
                         [](const auto& row) { return std::string(row.param.name); });

TEST_F(SupervisorTest, WithinItsLimitsNothingIsAFault) {
  reach(Mode::kWalk);
  const model::Joint& joint = test::biped().joints[3];
  state_.q[3] = joint.upper_rad + 0.09;
  state_.dq[3] = 1.49 * joint.velocity_limit_rad_s;
  state_.tau[3] = 1.19 * joint.effort_limit_Nm;
  state_.temperature_degC[3] = 89.0;
  const Eigen::Quaterniond upright = state_.orientation_WI;
  state_.orientation_WI = Eigen::AngleAxisd(0.59, Eigen::Vector3d::UnitY()) * upright;
  EXPECT_EQ(update(100), Mode::kWalk);
  torso_.reset();
  state_.orientation_WI = Eigen::AngleAxisd(0.99, Eigen::Vector3d::UnitY()) * upright;
  EXPECT_EQ(update(100), Mode::kWalk);
}

TEST_F(SupervisorTest, AnInterruptedGlitchStartsCountingAnew) {
  reach(Mode::kStand);
  for (int i = 0; i < 10; ++i) {
    state_.tau[0] = 2.0 * test::biped().joints[0].effort_limit_Nm;
    EXPECT_EQ(update(2), Mode::kStand);
    state_.tau[0] = 0.0;
    EXPECT_EQ(update(), Mode::kStand);
  }
}

TEST_F(SupervisorTest, StaleStateIsAFaultInTheSecondTickThatFindsIt) {
  reach(Mode::kStand);
  frozen_stamp_ = true;
  EXPECT_EQ(update(3), Mode::kStand) << "10 and 20 ms are no age yet; 30 ms is, but a host may stop for so long";
  EXPECT_EQ(update(), Mode::kFault);
  EXPECT_EQ(supervisor_.fault().code, faults::FaultCode::kStaleState);
}

TEST_F(SupervisorTest, AHostThatStopsBothThreadsIsNoFault) {
  reach(Mode::kStand);
  now_ns_ += 300'000'000;
  frozen_stamp_ = true;  // the control thread runs first afterwards
  EXPECT_EQ(update(), Mode::kStand);
  frozen_stamp_ = false;
  EXPECT_EQ(update(10), Mode::kStand);
}

TEST_F(SupervisorTest, AfterAStallOfTheHostTheBusMayComeBackLaterThanTheControlThreadByTheAgeLimit) {
  reach(Mode::kStand);
  now_ns_ += 300'000'000;
  frozen_stamp_ = true;
  EXPECT_EQ(update(2), Mode::kStand) << "at once, and 10 ms later";
  frozen_stamp_ = false;
  EXPECT_EQ(update(10), Mode::kStand);
  now_ns_ += 300'000'000;
  frozen_stamp_ = true;
  EXPECT_EQ(update(2), Mode::kStand);
  EXPECT_EQ(update(), Mode::kFault) << "20 ms later";
  EXPECT_EQ(supervisor_.fault().code, faults::FaultCode::kStaleState);
}

TEST_F(SupervisorTest, AControlThreadThatIsHeldUpAgainAndAgainFindsASilentBus) {
  reach(Mode::kStand);
  frozen_stamp_ = true;
  now_ns_ += 40'000'000;
  EXPECT_EQ(update(), Mode::kStand);
  now_ns_ += 40'000'000;
  EXPECT_EQ(update(), Mode::kFault) << "the second stall gives the bus no more time";
}

TEST_F(SupervisorTest, AResetOutsideOfFaultChangesNothing) {
  for (const Mode mode : {Mode::kPassive, Mode::kDamping, Mode::kStand, Mode::kWalk}) {
    if (mode != Mode::kPassive) reach(mode);
    ask(Mode::kDamping, true);
    EXPECT_EQ(update(3), mode) << "an impatient second reset must not drop the robot";
  }
}

TEST_F(SupervisorTest, TheTorsoIsJudgedAgainstItsCommandAndOnlyWhereItHasOne) {
  reach(Mode::kWalk);
  torso_ = faults::RollPitchAim{.pitch_rad = 0.5, .roll_rad = 0.0};
  const Eigen::Quaterniond upright = state_.orientation_WI;
  const auto lean = [&](double pitch_rad) {
    // For any heading.
    state_.orientation_WI = Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()) *
                            Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) * upright;
  };
  lean(0.5 + 0.35);
  EXPECT_EQ(update(20), Mode::kWalk);
  torso_.reset();
  lean(-0.2);
  EXPECT_EQ(update(20), Mode::kWalk);
  torso_ = faults::RollPitchAim{.pitch_rad = 0.5, .roll_rad = 0.0};
  EXPECT_EQ(update(3), Mode::kFault) << "upright, but 0.7 rad from where it should be";
  EXPECT_EQ(supervisor_.fault().code, faults::FaultCode::kTorsoAttitude);
  EXPECT_GT(supervisor_.fault().value, supervisor_.fault().limit);
}

}  // namespace
}  // namespace pmg::control
