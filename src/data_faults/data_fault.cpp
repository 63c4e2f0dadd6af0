#include "data_faults/data_fault.hpp"

namespace pmg::data_faults {

const char* name(Kind kind) {
  switch (kind) {
    case Kind::kUnit:
      return "unit";
    case Kind::kSign:
      return "sign";
    case Kind::kTimeShift:
      return "time_shift";
    case Kind::kMass:
      return "mass";
    case Kind::kGainFactor:
      return "gain_factor";
    case Kind::kSwappedRuns:
      return "swapped_runs";
    case Kind::kRow:
      return "row";
    case Kind::kFrozenReadings:
      break;
  }
  return "frozen_readings";
}

}  // namespace pmg::data_faults
