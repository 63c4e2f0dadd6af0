#include "work/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <stdexcept>
#include <vector>

namespace pmg::work {
namespace {

TEST(Parallel, EveryPieceIsDoneOnceWhateverTheJobs) {
  for (const unsigned jobs : {1, 3, 50}) {
    std::vector<std::atomic<int>> done(20);
    std::vector<double> told;
    for_each_in_parallel(done.size(), jobs, [&](std::size_t piece) { ++done[piece]; },
                         {.report = [&told](double share, std::string_view) { told.push_back(share); }});
    for (const auto& count : done) EXPECT_EQ(count, 1);
    ASSERT_EQ(told.size(), done.size() + 1) << "before the first, and after each";
    for (std::size_t i = 0; i < told.size(); ++i) EXPECT_EQ(told[i], static_cast<double>(i) / 20.0);
  }
}

TEST(Parallel, AnInterruptionBeginsNothingMore) {
  std::atomic<int> done = 0;
  for_each_in_parallel(10, 1, [&](std::size_t) { ++done; }, {.interrupted = [&done] { return done >= 3; }});
  EXPECT_EQ(done, 3);
}

// The work has so many pieces that it never ends by itself: that the call returns shows that the error ended it. A few
// pieces more begin while the error is on its way, and how many depends on how long the machine holds that thread up.
TEST(Parallel, AnErrorEndsTheWorkAndIsTold) {
  for (const unsigned jobs : {1, 3}) {
    const auto work = [](std::size_t piece) {
      if (piece == 2) throw std::runtime_error("piece 2");
    };
    try {
      for_each_in_parallel(std::numeric_limits<std::size_t>::max() / 2, jobs, work);
      ADD_FAILURE() << "no error with " << jobs << " threads";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "piece 2");
    }
  }
}

}  // namespace
}  // namespace pmg::work
