#include "runtime/action_monitor.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace pmg::runtime {
namespace {

/// Plays ticks, '#' beyond the bound and '.' within it. In which one the fault came, counted from 0; -1: in none.
int fault_tick(ActionMonitor& monitor, const std::string& ticks) {
  const JointVector q_ref = JointVector::Zero(5), within = JointVector::Constant(5, 0.49);
  JointVector beyond = within;
  beyond[3] = -0.51;
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    if (monitor.watch(ticks[k] == '#' ? beyond : within, q_ref).code != FaultCode::kNone) return static_cast<int>(k);
  }
  return -1;
}

int fault_tick(const std::string& ticks) {
  ActionMonitor monitor({.bound_rad = 0.5, .persist_ticks = 3, .window_ticks = 6});
  return fault_tick(monitor, ticks);
}

TEST(ActionMonitor, TheFaultNamesTheJointThatIsFarthestFromItsReference) {
  for (const double sign : {1.0, -1.0}) {
    ActionMonitor monitor({.bound_rad = 0.5, .persist_ticks = 3, .window_ticks = 6});
    const JointVector q_ref = JointVector::LinSpaced(5, -1.0, 1.0);
    JointVector q_des = q_ref;
    q_des[3] += sign * 0.51;
    EXPECT_EQ(monitor.watch(q_des, q_ref).code, FaultCode::kNone);
    EXPECT_EQ(monitor.watch(q_des, q_ref).code, FaultCode::kNone);
    const Fault fault = monitor.watch(q_des, q_ref);
    EXPECT_EQ(fault.code, FaultCode::kActionOutOfRange);
    EXPECT_EQ(fault.joint, 3);
    EXPECT_NEAR(fault.value, 0.51, 1e-12);
    EXPECT_EQ(fault.limit, 0.5);
  }
}

TEST(ActionMonitor, SoManyTicksOfTheWindowBeyondTheBoundAreAFaultInARowOrNot) {
  EXPECT_EQ(fault_tick("###"), 2);
  EXPECT_EQ(fault_tick("#.#.#"), 4) << "thrown from one clamp to the other";
  EXPECT_EQ(fault_tick("##...#"), 5) << "the window's last tick";
  EXPECT_EQ(fault_tick("##....##....##....##"), -1) << "what is older than the window is forgotten";
  EXPECT_EQ(fault_tick(std::string(100, '.')), -1);
}

TEST(ActionMonitor, AResetForgetsTheWindow) {
  ActionMonitor monitor({.bound_rad = 0.5, .persist_ticks = 3, .window_ticks = 6});
  EXPECT_EQ(fault_tick(monitor, "##"), -1);
  monitor.reset();
  EXPECT_EQ(fault_tick(monitor, "##"), -1);
  EXPECT_EQ(fault_tick(monitor, "#"), 0);
}

TEST(ActionMonitor, TheLongestWindowRemembersAllOfItsTicks) {
  ActionMonitor monitor({.bound_rad = 0.5, .persist_ticks = 2, .window_ticks = ActionMonitor::kLongestWindow});
  EXPECT_EQ(fault_tick(monitor, "#" + std::string(62, '.') + "#"), 63);
  monitor.reset();
  EXPECT_EQ(fault_tick(monitor, "#" + std::string(63, '.') + "#"), -1);
}

TEST(ActionMonitor, RefusesABoundOrAWindowThatIsNone) {
  EXPECT_THROW(ActionMonitor({.bound_rad = 0.0}), std::invalid_argument);
  EXPECT_THROW(ActionMonitor({.bound_rad = -1.0}), std::invalid_argument);
  EXPECT_THROW(ActionMonitor({.persist_ticks = 0}), std::invalid_argument);
  EXPECT_THROW(ActionMonitor({.persist_ticks = 7, .window_ticks = 6}), std::invalid_argument);
  EXPECT_THROW(ActionMonitor({.persist_ticks = 7, .window_ticks = 65}), std::invalid_argument);
}

}  // namespace
}  // namespace pmg::runtime
