// Data faults: what is wrong with a bench's files while its joint is healthy.
#pragma once

#include <string>
#include <vector>

#include "recorder.hpp"
#include "rig.hpp"

namespace pmg::literature {

/// As a diagnosis names it: data_faults[].kind.
inline constexpr const char* kFaultKinds[] = {"units_of_feed_forward", "degrees",      "flipped_sign", "wrong_mass",
                                              "gain_factor",           "swapped_runs", "time_shift"};

/// Takes its turns among what is off the catalogue. The recorder loses the readings: it is no fault of files.
inline constexpr const char* kFrozenReadings = "frozen_readings";

struct DataFault {
  std::string kind;
  std::string column;                  ///< of runs/*.csv or runs.csv; empty where none is meant
  std::vector<std::size_t> runs;       ///< that have the fault, by index
  double factor = 1.0;                 ///< truth over what the files say, or what is written over the truth
  int shift = 0;                       ///< samples by which the column comes later
  std::string text;                    ///< for people
  std::vector<std::string> same_here;  ///< effects of the catalogue that would explain the same files
};

/// One run's row in runs.csv and its file.
struct FiledRun {
  std::size_t index = 0;
  Gains gains;
  Load load;
  Recording recording;
};

/// What a fault of that kind needs of its rig.
RigNeeds needs_of_fault(std::size_t kind);

/// Readings of all runs that are lost while somebody else has the bus.
DataFault frozen_readings(const Rig& rig);

/// A fault of that kind. units_of_feed_forward makes the rig feed forward.
DataFault draw_fault(Draw& draw, std::size_t kind, Rig& rig);

/// The rig whose load isn't what was weighed, for wrong_mass; of other kinds the rig itself.
Rig with_fault(const DataFault& fault, Rig rig);

/// Puts the fault into the files, which are those of all runs. Readings that froze are so already.
void spoil(const DataFault& fault, std::vector<FiledRun>& files);

}  // namespace pmg::literature
