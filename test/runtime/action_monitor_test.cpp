#include "runtime/action_monitor.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace pmg::runtime {
namespace {

TEST(ActionMonitor, AnActionBeyondItsBoundIsAFaultWhenItPersists) {
  for (const double sign : {1.0, -1.0}) {
    ActionMonitor monitor({.bound_rad = 0.5, .persist_ticks = 3});
    const JointVector q_ref = JointVector::LinSpaced(5, -1.0, 1.0);
    JointVector q_des = q_ref;
    q_des[3] += sign * 0.51;
    for (int k = 0; k < 10; ++k) {
      EXPECT_EQ(monitor.watch(q_des, q_ref).code, FaultCode::kNone);
      EXPECT_EQ(monitor.watch(q_des, q_ref).code, FaultCode::kNone);
      EXPECT_EQ(monitor.watch(q_ref, q_ref).code, FaultCode::kNone) << "interrupted";
    }
    monitor.watch(q_des, q_ref);
    monitor.watch(q_des, q_ref);
    const Fault fault = monitor.watch(q_des, q_ref);
    EXPECT_EQ(fault.code, FaultCode::kActionOutOfRange);
    EXPECT_EQ(fault.joint, 3);
    EXPECT_NEAR(fault.value, 0.51, 1e-12);
    EXPECT_EQ(fault.limit, 0.5);
  }
}

TEST(ActionMonitor, WithinItsBoundNothingIsAFault) {
  ActionMonitor monitor({.bound_rad = 0.5, .persist_ticks = 3});
  const JointVector q_ref = JointVector::Zero(5), q_des = JointVector::Constant(5, 0.49);
  for (int k = 0; k < 100; ++k) EXPECT_EQ(monitor.watch(q_des, q_ref).code, FaultCode::kNone);
}

TEST(ActionMonitor, RefusesABoundThatIsNone) {
  EXPECT_THROW(ActionMonitor({.bound_rad = 0.0, .persist_ticks = 3}), std::invalid_argument);
  EXPECT_THROW(ActionMonitor({.bound_rad = -1.0, .persist_ticks = 3}), std::invalid_argument);
}

}  // namespace
}  // namespace pmg::runtime
