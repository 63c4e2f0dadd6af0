// Counts every allocation of the process, including those inside libmujoco and its collision library.
#include <gtest/gtest.h>

#include <memory>

#include "generator_core/allocation_count.hpp"
#include "robots.hpp"
#include "sim/world.hpp"

namespace pmg {
namespace {

TEST(Heap, StepAndReadDontAllocate) {
  PMG_SKIP_IF_HEAP_IS_NOT_COUNTED();
  sim::WorldOptions options;
  options.encoder_noise_rad = options.gyro_noise_rad_s = options.orientation_noise_rad = 0.001;
  sim::World world(z1(), options);
  model::JointCommand command = standing_command(z1());
  model::RobotState state;
  world.read(state);
  const long before_probe = test::allocation_count();
  const auto probe = std::make_unique<double>(1.0);
  ASSERT_GT(test::allocation_count(), before_probe) << "the counter doesn't count";

  const long before = test::allocation_count();
  for (int i = 0; i < 2000; ++i) {
    if (i == 300) world.set_hoist(0.1, 1.0);
    if (i == 600) world.set_hoist(0.0, 0.0);
    if (i == 700) command.kp.setZero();  // the robot collapses onto itself: contacts of every kind
    world.step(command);
    world.read(state);
    static_cast<void>(world.truth());
  }
  EXPECT_EQ(test::allocation_count() - before, 0);
  EXPECT_LT(world.truth().p_WB.z(), 0.7 * z1().standing_height_m) << "it was meant to collapse";
}

}  // namespace
}  // namespace pmg
