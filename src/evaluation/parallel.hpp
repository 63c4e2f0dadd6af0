// Independent pieces of work on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace pmg::evaluation {

/// What a long evaluation tells and asks meanwhile.
struct Supervision {
  int jobs = 1;
  /// Called before the first piece and after each, one call at a time, from any thread; may be empty.
  std::function<void(std::size_t done, std::size_t count)> progress;
  std::function<bool()> interrupted;  ///< true: begin no more pieces and end those under way; may be empty

  bool over() const { return interrupted && interrupted(); }
};

/// Calls work(i) for every i below count, in rising order of their beginnings, and returns when all are done. The first
/// exception ends the beginnings and is thrown again here.
void for_each_piece(std::size_t count, const Supervision& supervision, const std::function<void(std::size_t)>& work);

}  // namespace pmg::evaluation
