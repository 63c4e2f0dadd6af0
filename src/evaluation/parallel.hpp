// Independent pieces of work on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace pmg::evaluation {

/// Progress and interruption of a long evaluation, and its number of threads.
struct Supervision {
  int jobs = 1;
  /// Called before the first piece and after each one, one call at a time, from any thread; may be empty.
  std::function<void(std::size_t done, std::size_t count)> progress;
  std::function<bool()> interrupted;  ///< true: start no further piece and end the running ones; may be empty

  bool over() const { return interrupted && interrupted(); }
};

/// Calls work(i) for every i below count, starting them in rising order, and returns when all are done. After the first
/// exception no further piece starts; the exception is rethrown here.
void for_each_piece(std::size_t count, const Supervision& supervision, const std::function<void(std::size_t)>& work);

}  // namespace pmg::evaluation
