#include "pmg/command_inverse.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace pmg {
namespace {

/// Corrects vx by 0.1 at (vx 1, omega 2); all other nodes have no correction.
CommandInverse one_node_corrected() {
  std::vector<CommandInverse::Node> correction(2 * 1 * 2 * 1);
  correction[3] = {0.1, 0.0, -0.4, 0.0};
  return {{std::vector<double>{0.0, 1.0}, {0.0}, {0.0, 2.0}, {-0.1}}, correction};
}

Command command(double vx, double omega) {
  Command u;
  u[kVx] = vx;
  u[kOmega] = omega;
  return u;
}

TEST(CommandInverse, EmptyChangesNothing) { EXPECT_EQ(CommandInverse().apply(command(0.3, -0.2)), command(0.3, -0.2)); }

TEST(CommandInverse, IsMultilinearBetweenItsNodes) {
  const Command wanted = one_node_corrected().apply(command(0.5, 0.5));  // weight 1/2 * 1/4
  EXPECT_DOUBLE_EQ(wanted[kVx], 0.5 + 0.1 / 8.0);
  EXPECT_DOUBLE_EQ(wanted[kOmega], 0.5 - 0.4 / 8.0);
  EXPECT_EQ(wanted[kVy], 0.0);
  EXPECT_EQ(wanted[kPitch], 0.0);
}

TEST(CommandInverse, IsConstantBeyondItsGrid) {
  EXPECT_DOUBLE_EQ(one_node_corrected().apply(command(1.5, 9.0))[kVx], 1.6);
  EXPECT_EQ(one_node_corrected().apply(command(-1.0, 2.0)), command(-1.0, 2.0));
}

TEST(CommandInverse, LeavesACommandAloneThatIsntFinite) {
  Command broken = command(1.0, 2.0);
  broken[kHeight] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(one_node_corrected().apply(broken), broken);
}

}  // namespace
}  // namespace pmg
