// Threads, progress and interruption of a long evaluation.
#pragma once

#include "work/parallel.hpp"

namespace pmg::evaluation {

struct Supervision {
  int jobs = 1;  ///< threads
  work::Progress progress{};
  bool interrupted_now() const { return progress.interrupted_now(); }
};

/// Calls work(i) for every i below count (work/parallel.hpp).
template <typename Work>
void for_each_piece(std::size_t count, const Supervision& supervision, const Work& piece) {
  work::for_each_in_parallel(count, static_cast<unsigned>(supervision.jobs), piece, supervision.progress);
}

}  // namespace pmg::evaluation
