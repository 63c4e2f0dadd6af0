#include "evidence/verdict.hpp"

#include <fmt/format.h>

namespace pmg::evidence {

const char* name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kFound:
      return "found";
    case Verdict::kAmbiguous:
      return "ambiguous";
    case Verdict::kNone:
      return "none";
    case Verdict::kUnexplained:
      return "unexplained";
    case Verdict::kInterrupted:
      break;
  }
  return "interrupted";
}

std::string text_of(const Interval& interval, const std::string& unit, int digits) {
  return fmt::format("{:.{}g} ({:.{}g} to {:.{}g}){}{}", interval.value, digits, interval.low, digits, interval.high,
                     digits, unit.empty() ? "" : " ", unit);
}

}  // namespace pmg::evidence
