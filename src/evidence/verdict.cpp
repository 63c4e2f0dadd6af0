#include "evidence/verdict.hpp"

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

}  // namespace pmg::evidence
