// Counts every allocation of the process, those inside libmujoco and its collision library included.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <memory>

#include "robots.hpp"
#include "sim/world.hpp"

namespace {
std::atomic<long> allocations = 0;
}

// glibc's own entry points; libmujoco's calls are resolved to these definitions as well. Sanitizers bring their own
// malloc.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PMG_COUNTS_ALLOCATIONS 1
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  ++allocations;
  return __libc_realloc(old, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  ++allocations;
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr;
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
}
#endif

namespace pmg {
namespace {

TEST(Heap, StepAndReadDontAllocate) {
#ifndef PMG_COUNTS_ALLOCATIONS
  GTEST_SKIP() << "the sanitizer owns malloc";
#endif
  sim::WorldOptions options;
  options.encoder_noise_rad = options.gyro_noise_rad_s = options.orientation_noise_rad = 0.001;
  sim::World world(z1(), options);
  model::JointCommand command = standing_command(z1());
  model::RobotState state;
  world.read(state);
  const long before_probe = allocations;
  const auto probe = std::make_unique<double>(1.0);
  ASSERT_GT(allocations, before_probe) << "the counter doesn't count";

  const long before = allocations;
  for (int i = 0; i < 1500; ++i) {
    if (i == 300) world.set_hoist(0.1, 1.0);
    if (i == 600) world.set_hoist(0.0, 0.0);
    if (i == 700) command.kp.setZero();  // collapses onto itself: contacts of every kind
    world.step(command);
    world.read(state);
    static_cast<void>(world.truth());
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_LT(world.truth().p_WB.z(), 0.7 * z1().standing_height_m) << "it was meant to collapse";
}

}  // namespace
}  // namespace pmg
