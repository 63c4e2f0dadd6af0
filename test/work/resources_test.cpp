#include "work/resources.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace pmg::work {
namespace {

TEST(Resources, ThePeakGrowsWithWhatIsHeldAndStaysAfterwards) {
  const double before_MiB = used_resources().peak_memory_MiB;
  EXPECT_GT(before_MiB, 0.0);
  const auto larger = static_cast<std::size_t>(before_MiB + 64.0);
  { const std::vector<char> held(larger << 20, 'x'); }
  EXPECT_GT(used_resources().peak_memory_MiB, before_MiB + 60.0);
}

TEST(Resources, WorkTakesProcessorTime) {
  const double before_s = used_resources().cpu_s;
  volatile double sum = 0.0;
  // Ends by the measure itself, so no machine is too fast or too slow for it.
  while (used_resources().cpu_s < before_s + 0.01) sum = sum + 1.0;
  EXPECT_GE(used_resources().cpu_s, before_s + 0.01);
}

}  // namespace
}  // namespace pmg::work
