// Data faults planted into the recordings of a bench, for how often they are found.
#pragma once

#include <string>
#include <vector>

#include "bench/bench.hpp"

namespace pmg::test {

/// What was planted, in the words in which it should be found.
struct PlantedFault {
  std::string kind;                ///< as diagnosis.json calls it
  std::vector<std::string> where;  ///< one of these must stand in `where`
  std::vector<std::string> files;  ///< runs that it touches; empty: all
  double factor = 0.0;             ///< right correction; 0: not a factor
  double shift_s = 0.0;            ///< right correction of a time
};

/// The kinds that `plant` knows.
std::vector<std::string> planted_kinds();

/// Plants the fault into the runs, at places and sizes drawn from the seed. Empty kind: the bench can't have it.
PlantedFault plant(const std::string& what, unsigned seed, const bench::Bench& bench,
                   std::vector<bench::BenchRun>& runs);

}  // namespace pmg::test
