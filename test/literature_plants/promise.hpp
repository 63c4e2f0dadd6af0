// A promised share of plants, and what few plants say of it.
#pragma once

#include <string>

namespace pmg::literature {

/// A share that is promised, and how many of how many kept it.
struct Promise {
  std::string what;
  bool at_least = true;
  double promised = 0.0;
  int kept = 0, of = 0;
  /// The probability of no better a count than this if the promise just held.
  double chance() const;
  /// False if a diagnosis that just keeps the promise would give so bad a count once in fifty campaigns at most. With
  /// few plants a share says little: 15 of 18 is below 90 % and quite usual.
  bool is_likely() const { return chance() >= 0.02; }
};

}  // namespace pmg::literature
