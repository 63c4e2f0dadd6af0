// What is wrong with a bench's data before any physics: which column, run or row, and what it should have said.
#pragma once

#include <string>
#include <vector>

#include "bench/correction.hpp"

namespace pmg::data_faults {

enum class Kind {
  kUnit,            ///< a column in another unit than its name says
  kSign,            ///< a column with its sign turned
  kTimeShift,       ///< a column earlier or later than the others
  kMass,            ///< a load of bench.yaml that is heavier or lighter than written
  kGainFactor,      ///< a gain of runs.csv that acts by a factor of its number
  kSwappedRuns,     ///< two rows of runs.csv, or the readings of two runs, stand for each other
  kRow,             ///< a row of runs.csv with the gains or the load of other rows
  kFrozenReadings,  ///< readings that stand still while the joint moves
};

const char* name(Kind kind);

struct DataFault {
  Kind kind = Kind::kUnit;
  std::string where;                       ///< the column, run or row, by the names of the bench's files
  std::string correction;                  ///< one sentence for people
  std::vector<std::string> evidence{};     ///< sentences with numbers
  std::vector<bench::Correction> fixes{};  ///< the correction for machines
  std::vector<std::string> files{};        ///< runs that it touches; empty: all
};

}  // namespace pmg::data_faults
