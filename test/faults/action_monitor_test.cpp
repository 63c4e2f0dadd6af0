#include "faults/action_monitor.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace pmg::faults {
namespace {

constexpr ActionMonitorOptions kShort = {
    .bound_rad = 0.5, .persist_ticks = 3, .reversals = 2, .reversal_ticks = 2, .window_ticks = 6};

/// Plays ticks: a joint is above its reference by more than the bound (+), below it (-), or all are within the bound
/// (.). Returns the tick of the fault, counted from 0; -1: none.
int fault_tick(ActionMonitor& monitor, const std::string& ticks) {
  const JointVector q_ref = JointVector::LinSpaced(5, -1.0, 1.0), within = q_ref.array() + 0.49;
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    JointVector q_des = within;
    if (ticks[k] != '.') q_des[3] = q_ref[3] + (ticks[k] == '+' ? 0.51 : -0.51);
    const Fault fault = monitor.watch(q_des, q_ref);
    if (fault.code == FaultCode::kNone) continue;
    EXPECT_EQ(fault.code, FaultCode::kActionOutOfRange);
    EXPECT_EQ(fault.joint, 3);
    EXPECT_NEAR(fault.value, 0.51, 1e-12);
    EXPECT_EQ(fault.limit, 0.5);
    return static_cast<int>(k);
  }
  return -1;
}

int fault_tick(const std::string& ticks) {
  ActionMonitor monitor(kShort);
  return fault_tick(monitor, ticks);
}

TEST(ActionMonitor, AnActionThatStaysBeyondItsBoundIsAFault) {
  EXPECT_EQ(fault_tick("+++"), 2);
  EXPECT_EQ(fault_tick("---"), 2);
  EXPECT_EQ(fault_tick("++.++.++.++.++.++"), -1) << "interrupted: balance may need as much again and again";
}

TEST(ActionMonitor, AJointThatIsThrownToAndFroIsAFault) {
  EXPECT_EQ(fault_tick("+-+"), 2);
  EXPECT_EQ(fault_tick("+.-.+"), 4);
  EXPECT_EQ(fault_tick("+-...+-"), 6) << "the first reversal is in the window's last tick";
}

TEST(ActionMonitor, OneReversalOrASlowOneOrOnesFarApartAreNone) {
  EXPECT_EQ(fault_tick("+-"), -1);
  EXPECT_EQ(fault_tick("+..-..+..-..+..-"), -1) << "slower than reversal_ticks";
  EXPECT_EQ(fault_tick("+-....+-....+-"), -1) << "each has left the window when the next comes";
}

/// Tick of the fault when a joint goes beyond 0.7 rad on alternating sides, once every so many ticks; -1: none in 2 s.
int fault_tick_by_default(int every) {
  ActionMonitor monitor{ActionMonitorOptions{}};
  const JointVector q_ref = JointVector::Zero(5);
  for (int k = 0; k < 200; ++k) {
    JointVector q_des = q_ref;
    if (k % every == 0) q_des[3] = (k / every) % 2 == 0 ? 0.701 : -0.701;
    if (monitor.watch(q_des, q_ref).code != FaultCode::kNone) return k;
  }
  return -1;
}

TEST(ActionMonitor, ByDefaultTheSecondReversalInHalfASecondTripsAtOnceIfEachTakesAtMostAFifthOfASecond) {
  EXPECT_EQ(fault_tick_by_default(1), 2);
  EXPECT_EQ(fault_tick_by_default(20), 40) << "reversals after 0.2 s and 0.4 s";
  EXPECT_EQ(fault_tick_by_default(21), -1) << "0.21 s is no reversal";
}

TEST(ActionMonitor, TwoJointsOnOppositeSidesAreNoReversal) {
  ActionMonitor monitor(kShort);
  const JointVector q_ref = JointVector::Zero(5);
  for (int k = 0; k < 12; ++k) {
    JointVector q_des = q_ref;
    if (k % 3 != 2) q_des[k % 3] = k % 3 == 0 ? 0.51 : -0.51;
    EXPECT_EQ(monitor.watch(q_des, q_ref).code, FaultCode::kNone) << k;
  }
}

TEST(ActionMonitor, AResetForgetsEverything) {
  for (const char* before : {"++", "+-"}) {
    ActionMonitor monitor(kShort);
    EXPECT_EQ(fault_tick(monitor, before), -1);
    monitor.reset();
    EXPECT_EQ(fault_tick(monitor, "+"), -1) << before;
  }
}

TEST(ActionMonitor, RefusesABoundOrNumbersThatAreNone) {
  EXPECT_THROW(ActionMonitor({.bound_rad = 0.0}), std::invalid_argument);
  EXPECT_THROW(ActionMonitor({.bound_rad = -1.0}), std::invalid_argument);
  EXPECT_THROW(ActionMonitor({.persist_ticks = 0}), std::invalid_argument);
  EXPECT_THROW(ActionMonitor({.reversals = 0}), std::invalid_argument);
  EXPECT_THROW(ActionMonitor({.reversal_ticks = 0}), std::invalid_argument);
  EXPECT_THROW(ActionMonitor({.reversals = 7, .window_ticks = 6}), std::invalid_argument);
  EXPECT_THROW(ActionMonitor({.window_ticks = 65}), std::invalid_argument);
}

}  // namespace
}  // namespace pmg::faults
