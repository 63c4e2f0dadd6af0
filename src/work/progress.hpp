// Progress and interruption of long work.
#pragma once

#include <functional>
#include <limits>
#include <stdexcept>
#include <string_view>

namespace pmg::work {

inline constexpr double kUnknownShare = std::numeric_limits<double>::quiet_NaN();

/// Thrown by interrupted work whose partial result is of no use.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Each function may be empty: then nothing is reported, or nothing interrupts.
struct Progress {
  /// share: part of the work done, 0 to 1, or kUnknownShare; doing: the present step in words, or "". One call at a
  /// time.
  std::function<void(double share, std::string_view doing)> report{};
  /// True: end the work and keep the partial result. Called from any thread, at any time.
  std::function<bool()> interrupted{};

  bool interrupted_now() const { return interrupted && interrupted(); }
  /// Reports; returns true to go on.
  bool operator()(double share, std::string_view doing = {}) const {
    if (report) report(share, doing);
    return !interrupted_now();
  }
  /// Reports; throws Interrupted if interrupted.
  void report_or_throw(double share, std::string_view doing = {}) const {
    if (!(*this)(share, doing)) throw Interrupted();
  }
};

}  // namespace pmg::work
