// docs/reference/safety.md's table of faults, row by row, through bus cycle, guard, control cycle and tick: each cause
// is injected while the robot walks, and the reaction is counted in bus cycles at the drives.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include "control/control_rig.hpp"
#include "control/sit_down.hpp"
#include "folders.hpp"
#include "hal/bus_cycle.hpp"

namespace pmg::control {
namespace {

using test::BreakablePolicy;
using test::ControlRig;
using test::kCyclesPerTick;
using test::kNan;

/// A library that passes its checks and overflows when it is played: one step takes 6e-309 s.
ClipLibrary overflowing_clips() {
  ClipLibrary library = test::clips(test::biped());
  for (auto* clips : {&library.positive, &library.negative}) {
    for (auto& clip : *clips) {
      if (clip) clip->period_s = 6e-309;
    }
  }
  return library;
}

TickOptions options_of(faults::FaultCode code) {
  TickOptions options = tick_options(test::biped());
  // From rest to full speed in one tick, so the overflow comes in the tick of the injection.
  if (code == faults::FaultCode::kReferenceNotFinite) options.generator.limits.rate_per_s.fill(1e6);
  return options;
}

ClipLibrary clips_of(faults::FaultCode code) {
  return code == faults::FaultCode::kReferenceNotFinite ? overflowing_clips() : test::clips(test::biped());
}

template <typename Spoil>
auto in_state(Spoil spoil) {
  return [spoil](ControlRig& rig) { rig.bus.spoil = spoil; };
}

auto in_policy(BreakablePolicy::Break how) {
  return [how](ControlRig& rig) { rig.policy->how = how; };
}

void give_the_guard_a_nan(ControlRig& rig) {
  hal::ControlOutput output;
  output.joints = rig.tick.result().command;
  output.joints.q[2] = kNan;
  rig.link.commands.put(output);
}

/// The control thread wakes two bus cycles late and its policy takes four: together one too many, alone none.
void overrun(ControlRig& rig) {
  rig.control_delay_cycles = 2;
  rig.policy->meanwhile = [&rig] {
    for (int k = 0; k < 4; ++k) rig.world();
  };
}

struct InjectedFault {
  const char* name;
  faults::FaultCode code;
  std::function<void(ControlRig&)> inject;
  /// The reset is refused while the cause lasts. Otherwise the cause shows only when the robot stands again.
  bool reset_waits;

  friend void PrintTo(const InjectedFault& row, std::ostream* out) { *out << row.name; }
};

std::vector<InjectedFault> rows() {
  return {
      {"BusLost", faults::FaultCode::kBusLost, [](ControlRig& rig) { rig.bus.status = hal::BusStatus::kLost; }, true},
      {"StaleState", faults::FaultCode::kStaleState, [](ControlRig& rig) { rig.bus.status = hal::BusStatus::kStale; },
       true},
      {"NanInPosition", faults::FaultCode::kStateNotFinite, in_state([](auto& s) { s.q[1] = kNan; }), true},
      {"NanInOrientation", faults::FaultCode::kStateNotFinite, in_state([](auto& s) { s.orientation_WI.x() = kNan; }),
       true},
      {"MissingJoints", faults::FaultCode::kStateNotFinite, in_state([](auto& s) { s.dq.conservativeResize(2); }),
       true},
      {"Hot", faults::FaultCode::kTemperature, in_state([](auto& s) { s.temperature_degC[2] = 95.0; }), true},
      {"ControlFrozen", faults::FaultCode::kControlFrozen, [](ControlRig& rig) { rig.control_frozen = true; }, false},
      {"CommandNan", faults::FaultCode::kCommandNotFinite, give_the_guard_a_nan, false},
      {"StalePolicy", faults::FaultCode::kStalePolicy, in_policy(BreakablePolicy::Break::kLate), false},
      {"Overrun", faults::FaultCode::kOverrun, overrun, false},
      {"AboveRange", faults::FaultCode::kJointLimit,
       in_state([](auto& s) { s.q[3] = test::biped().joints[3].upper_rad + 0.12; }), true},
      {"BelowRange", faults::FaultCode::kJointLimit,
       in_state([](auto& s) { s.q[3] = test::biped().joints[3].lower_rad - 0.12; }), true},
      {"TooFast", faults::FaultCode::kJointVelocity,
       in_state([](auto& s) { s.dq[3] = 1.6 * test::biped().joints[3].velocity_limit_rad_s; }), true},
      {"TooFastBackwards", faults::FaultCode::kJointVelocity,
       in_state([](auto& s) { s.dq[3] = -1.6 * test::biped().joints[3].velocity_limit_rad_s; }), true},
      {"Torque", faults::FaultCode::kJointTorque,
       in_state([](auto& s) { s.tau[3] = 1.3 * test::biped().joints[3].effort_limit_Nm; }), true},
      {"TorqueBackwards", faults::FaultCode::kJointTorque,
       in_state([](auto& s) { s.tau[3] = -1.3 * test::biped().joints[3].effort_limit_Nm; }), true},
      {"Tilt", faults::FaultCode::kTilt, in_state([](auto& s) {
         s.orientation_WI = Eigen::AngleAxisd(1.1, Eigen::Vector3d::UnitX()) * s.orientation_WI;
       }),
       true},
      {"TorsoAttitude", faults::FaultCode::kTorsoAttitude, in_state([](auto& s) {
         s.orientation_WI = Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitY()) * s.orientation_WI;
       }),
       false},
      {"Reference", faults::FaultCode::kReferenceNotFinite, [](ControlRig& rig) { rig.drive.command[kVx] = 9.0; },
       false},
      {"PolicyNan", faults::FaultCode::kPolicyNotFinite, in_policy(BreakablePolicy::Break::kNotANumber), false},
      {"PolicyFailed", faults::FaultCode::kPolicyNotFinite, in_policy(BreakablePolicy::Break::kStatus), false},
      {"FarAction", faults::FaultCode::kActionOutOfRange, in_policy(BreakablePolicy::Break::kFarAction), false},
  };
}

void heal(ControlRig& rig) {
  rig.bus.status = hal::BusStatus::kOk;
  rig.bus.spoil = nullptr;
  rig.control_frozen = rig.bus_frozen = rig.silent = false;
  rig.control_delay_cycles = 0;
  rig.policy->how = BreakablePolicy::Break::kNone;
  rig.policy->meanwhile = nullptr;
  rig.drive.command = Command{};
}

void include(int cycles, faults::CycleRange& range) {
  range.least = range.most < 0 ? cycles : std::min(range.least, cycles);
  range.most = std::max(range.most, cycles);
}

/// Reactions over all moments between two ticks at which the cause may appear. Of a robot that stands; where no policy
/// balances it afterwards, also of one that takes steps.
faults::Reaction reaction_of(const InjectedFault& row) {
  faults::Reaction range;
  for (const double speed_m_s : {0.0, 0.3}) {
    if (speed_m_s > 0.0 && faults::policy_is_sound_after(row.code)) continue;
    for (int moment = 0; moment < kCyclesPerTick; ++moment) {
      ControlRig rig(test::biped(), clips_of(row.code), options_of(row.code));
      rig.reach_walk();
      rig.drive.command[kVx] = speed_m_s;
      rig.run(speed_m_s > 0.0 ? 0.5 : 0.0);
      rig.align(moment);
      const ControlRig::Reaction measured = rig.reaction_to([&] { row.inject(rig); });
      EXPECT_GE(measured.to_damping, 0) << row.name << ": no reaction";
      include(measured.to_damping, range.damping);
      if (measured.to_sit_down >= 0) include(measured.to_sit_down, range.sit_down);
    }
  }
  return range;
}

/// The cells of a row of a Markdown table.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream row(line);
  for (std::string cell; std::getline(row, cell, '|');) cells.push_back(cell);
  return cells;
}

/// "1 to 5", "0", or "-" for never.
faults::CycleRange range_in(const std::string& cell) {
  faults::CycleRange range;
  std::string to;
  std::istringstream cycles(cell);
  if (!(cycles >> range.least)) return {};
  range.most = range.least;
  cycles >> to;
  if (to == "to") cycles >> range.most;
  return range;
}

/// The fault table (seven columns) of docs/reference/safety.md: codes with their bus cycles, in its order.
std::vector<std::pair<std::string, faults::Reaction>> documented_rows() {
  constexpr std::size_t kColumns = 7, kCode = 1, kSitDown = 5, kDamping = 6;  // the first cell is before the first bar
  std::ifstream file(std::filesystem::path(pmg::test::project_folder()) / "docs/reference/safety.md");
  std::vector<std::pair<std::string, faults::Reaction>> rows;
  for (std::string line; std::getline(file, line);) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() != kColumns + 1 || !cells[kCode].starts_with(" `")) continue;
    const std::string code = cells[kCode].substr(2, cells[kCode].rfind('`') - 2);
    rows.emplace_back(code, faults::Reaction{range_in(cells[kSitDown]), range_in(cells[kDamping])});
  }
  return rows;
}

std::map<std::string, faults::Reaction> documented_reactions() {
  std::map<std::string, faults::Reaction> reactions;
  for (const auto& [code, told] : documented_rows())
    EXPECT_TRUE(reactions.emplace(code, told).second) << code << " has two rows";
  return reactions;
}

/// "When one tick finds several, it keeps the first of this table."
TEST(FaultTable, IsInTheOrderInWhichACauseIsKept) {
  std::vector<std::string> kept, documented;
  for (std::size_t k = 1; k < faults::kFaultCodes; ++k) kept.emplace_back(to_string(static_cast<faults::FaultCode>(k)));
  for (const auto& row : documented_rows()) documented.push_back(row.first);
  EXPECT_EQ(documented, kept);
}

TEST(FaultTable, EveryCodeIsInjectedAndDocumentedAndNothingElseIs) {
  std::map<std::string, faults::Reaction> documented = documented_reactions();
  for (std::size_t k = 1; k < faults::kFaultCodes; ++k) {
    const auto code = static_cast<faults::FaultCode>(k);
    const std::vector<InjectedFault> all = rows();
    EXPECT_TRUE(std::ranges::any_of(all, [&](const InjectedFault& row) { return row.code == code; }))
        << to_string(code);
    EXPECT_EQ(documented[to_string(code)].sit_down, faults::reaction(code).sit_down) << to_string(code);
    EXPECT_EQ(documented[to_string(code)].damping, faults::reaction(code).damping) << to_string(code);
    EXPECT_EQ(documented.erase(to_string(code)), 1u) << to_string(code) << " has no row in docs/reference/safety.md";
    EXPECT_NE(std::string(advice(code)), "") << to_string(code);
  }
  EXPECT_TRUE(documented.empty()) << documented.begin()->first << " is documented, but no fault";
}

TEST(FaultTable, ASitDownTakesAsLongAsItsOptionsSay) {
  const SitDownOptions sit_down;
  const auto cycles = [&](const WayDown& way) {
    return static_cast<int>(std::lround((way.crouch_s + sit_down.settle_s) * 1e9 / hal::BusCycle::kPeriod_ns));
  };
  for (std::size_t k = 1; k < faults::kFaultCodes; ++k) {
    const auto code = static_cast<faults::FaultCode>(k);
    const faults::Reaction told = faults::reaction(code);
    if (told.sit_down == faults::CycleRange{}) continue;
    EXPECT_EQ(told.damping.most - told.sit_down.most, cycles(sit_down.balanced)) << to_string(code);
    const WayDown& soonest = faults::policy_is_sound_after(code) ? sit_down.balanced : sit_down.unbalanced;
    EXPECT_EQ(told.damping.least - told.sit_down.least, cycles(soonest)) << to_string(code);
  }
}

TEST(FaultTable, WhoIsToPutARobotUprightIsToldWhatLiftsASimulatedOne) {
  for (const faults::FaultCode code : {faults::FaultCode::kTilt, faults::FaultCode::kTorsoAttitude}) {
    const std::string told = advice(code);
    EXPECT_NE(told.find("put it upright"), std::string::npos) << told;
    EXPECT_NE(told.find("pmg_send lift"), std::string::npos) << told;
  }
}

class FaultInjection : public testing::TestWithParam<InjectedFault> {};

TEST_P(FaultInjection, TheDrivesAreDampedWithinTheDocumentedBusCycles) {
  const InjectedFault& row = GetParam();
  const faults::Reaction measured = reaction_of(row), documented = documented_reactions()[to_string(row.code)];
  EXPECT_EQ(measured.damping.least, documented.damping.least) << row.name;
  EXPECT_EQ(measured.damping.most, documented.damping.most) << row.name;
}

TEST_P(FaultInjection, TheRobotSitsDownFirstWithinTheDocumentedBusCycles) {
  const InjectedFault& row = GetParam();
  const faults::Reaction measured = reaction_of(row), documented = documented_reactions()[to_string(row.code)];
  EXPECT_EQ(measured.sit_down.least, documented.sit_down.least) << row.name;
  EXPECT_EQ(measured.sit_down.most, documented.sit_down.most) << row.name;
  EXPECT_EQ(measured.sit_down.most >= 0, faults::allows_sit_down(row.code)) << row.name;
}

TEST_P(FaultInjection, IsLatchedWithItsCauseUntilAResetThatFindsNothingWrong) {
  const InjectedFault& row = GetParam();
  ControlRig rig(test::biped(), clips_of(row.code), options_of(row.code));
  rig.reach_walk();
  const int cycles = rig.cycles_to_damping([&] { row.inject(rig); });
  ASSERT_GE(cycles, 0);
  int undamped = 0, broken = 0;
  rig.after_cycle = [&] {
    undamped += rig.bus.damping() ? 0 : 1;
    broken += rig.bus.finite() ? 0 : 1;
  };
  if (row.code == faults::FaultCode::kControlFrozen) {
    rig.run(1.0);
    EXPECT_EQ(undamped, 0) << "the guard goes on damping alone";
    heal(rig);  // the thread returns
  }
  rig.run(0.1);
  EXPECT_EQ(rig.mode(), Mode::kFault);
  EXPECT_EQ(rig.fault(), row.code);
  const std::string words = faults::describe(rig.tick.result().fault, test::biped());
  EXPECT_EQ(words.find(std::string(to_string(row.code)) + ": "), 0u) << words;
  EXPECT_EQ(words.find("nan"), std::string::npos) << words;

  rig.ask(Mode::kStand);
  rig.run(0.1);
  EXPECT_EQ(rig.mode(), Mode::kFault) << "a request is no reset";
  if (row.reset_waits) {
    rig.reset();
    rig.run(0.1);
    EXPECT_EQ(rig.mode(), Mode::kFault) << "what was wrong still is";
    EXPECT_EQ(rig.fault(), row.code) << "the first fault is kept";
  }
  heal(rig);
  rig.run(0.1);
  EXPECT_EQ(rig.mode(), Mode::kFault) << "it is latched";
  rig.reset();
  rig.run(0.1);
  EXPECT_EQ(rig.mode(), Mode::kDamping);
  EXPECT_EQ(rig.fault(), faults::FaultCode::kNone);
  EXPECT_EQ(undamped, 0) << "all the time the drives brake";
  EXPECT_EQ(broken, 0);
  rig.after_cycle = nullptr;
  rig.reach_walk();
}

TEST_P(FaultInjection, IsNoFaultInPassive) {
  const InjectedFault& row = GetParam();
  ControlRig rig(test::biped(), clips_of(row.code), options_of(row.code));
  rig.run(0.1);
  row.inject(rig);
  int driven = 0;
  rig.after_cycle = [&] { driven += rig.bus.last_command.kp.sum() == 0.0 ? 0 : 1; };
  rig.run(0.2);
  rig.after_cycle = nullptr;
  heal(rig);
  rig.run(0.1);
  EXPECT_EQ(rig.mode(), Mode::kPassive);
  EXPECT_EQ(driven, 0);
}

INSTANTIATE_TEST_SUITE_P(Table, FaultInjection, testing::ValuesIn(rows()),
                         [](const auto& row) { return std::string(row.param.name); });

}  // namespace
}  // namespace pmg::control
