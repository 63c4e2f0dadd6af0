// A parallel for loop with progress.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "work/progress.hpp"

namespace pmg::work {

/// Calls work(index) for every index below count on up to `threads` threads, and returns when all have ended. Indices
/// start in increasing order. Reports progress before the first and after each ("3 of 20"). After an interruption or an
/// exception no more start; the first exception is rethrown here.
template <typename Work>
void for_each_in_parallel(std::size_t count, unsigned threads, const Work& work, const Progress& progress = {}) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;  // guards done, thrown and the calls of progress
  std::size_t done = 0;
  std::exception_ptr thrown;
  const auto tell = [&] {
    if (progress.report)
      progress.report(static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(1, count)),
                      std::to_string(done) + " of " + std::to_string(count));
  };
  tell();
  const auto take_turns = [&] {
    for (std::size_t i = next++; i < count && !progress.interrupted_now(); i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!thrown) thrown = std::current_exception();
        next = count;
        return;
      }
      const std::lock_guard lock(mutex);
      ++done;
      tell();
    }
  };
  {
    std::vector<std::jthread> workers;
    for (std::size_t t = 1; t < std::min<std::size_t>(threads, count); ++t) workers.emplace_back(take_turns);
    take_turns();
  }
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace pmg::work
