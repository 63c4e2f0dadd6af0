#include "evaluation/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace pmg::evaluation {
namespace {

TEST(Parallel, EveryPieceIsDoneOnceWhateverTheJobs) {
  for (const int jobs : {1, 3, 50}) {
    std::vector<std::atomic<int>> done(20);
    std::vector<std::size_t> told;
    const Supervision supervision{.jobs = jobs,
                                  .progress = [&told](std::size_t so_far, std::size_t) { told.push_back(so_far); },
                                  .interrupted = {}};
    for_each_piece(done.size(), supervision, [&](std::size_t piece) { ++done[piece]; });
    for (const auto& count : done) EXPECT_EQ(count, 1);
    ASSERT_EQ(told.size(), done.size() + 1) << "before the first, and after each";
    for (std::size_t i = 0; i < told.size(); ++i) EXPECT_EQ(told[i], i);
  }
}

TEST(Parallel, AnInterruptionBeginsNothingMore) {
  std::atomic<int> done = 0;
  const Supervision supervision{.jobs = 1, .progress = {}, .interrupted = [&done] { return done >= 3; }};
  for_each_piece(10, supervision, [&](std::size_t) { ++done; });
  EXPECT_EQ(done, 3);
}

TEST(Parallel, AnErrorEndsTheWorkAndIsTold) {
  for (const int jobs : {1, 3}) {
    std::atomic<int> begun = 0;
    const auto work = [&](std::size_t piece) {
      ++begun;
      if (piece == 2) throw std::runtime_error("piece 2");
    };
    EXPECT_THROW(for_each_piece(1000, {.jobs = jobs, .progress = {}, .interrupted = {}}, work), std::runtime_error);
    EXPECT_LT(begun, 1000);
  }
}

}  // namespace
}  // namespace pmg::evaluation
