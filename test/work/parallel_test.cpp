#include "work/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
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

TEST(Parallel, AnErrorEndsTheWorkAndIsTold) {
  for (const unsigned jobs : {1, 3}) {
    std::atomic<int> begun = 0;
    const auto work = [&](std::size_t piece) {
      ++begun;
      if (piece == 2) throw std::runtime_error("piece 2");
    };
    EXPECT_THROW(for_each_in_parallel(1000, jobs, work), std::runtime_error);
    EXPECT_LT(begun, 1000);
  }
}

}  // namespace
}  // namespace pmg::work
