// Independent pieces of work on several threads.
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

/// Calls work(index) for every index below count on up to so many threads, in rising order of their beginnings, and
/// returns when all have ended. Progress is told before the first and after each ("3 of 20"); once it is over, or after
/// the first exception, which is thrown again here, no more begin.
template <typename Work>
void for_each_in_parallel(std::size_t count, unsigned threads, const Work& work, const Progress& progress = {}) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;  // of what follows
  std::size_t done = 0;
  std::exception_ptr thrown;
  const auto tell = [&] {
    if (progress.told)
      progress.told(static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(1, count)),
                    std::to_string(done) + " of " + std::to_string(count));
  };
  tell();
  const auto take_turns = [&] {
    for (std::size_t i = next++; i < count && !progress.over(); i = next++) {
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
