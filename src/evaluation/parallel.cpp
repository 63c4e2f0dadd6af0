#include "evaluation/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace pmg::evaluation {

void for_each_piece(std::size_t count, const Supervision& supervision, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;  // guards `done`, `failure` and the progress call
  std::size_t done = 0;
  std::exception_ptr failure;
  if (supervision.progress) supervision.progress(0, count);
  const auto run = [&] {
    for (std::size_t piece = next++; piece < count && !supervision.over(); piece = next++) {
      try {
        work(piece);
      } catch (...) {
        const std::scoped_lock lock(mutex);
        if (!failure) failure = std::current_exception();
        next = count;
        return;
      }
      const std::scoped_lock lock(mutex);
      ++done;
      if (supervision.progress) supervision.progress(done, count);
    }
  };
  {
    std::vector<std::jthread> threads;
    const std::size_t jobs = std::min(count, static_cast<std::size_t>(std::max(1, supervision.jobs)));
    for (std::size_t i = 1; i < jobs; ++i) threads.emplace_back(run);
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace pmg::evaluation
