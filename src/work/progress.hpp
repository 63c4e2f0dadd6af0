// What long work tells, and asks, meanwhile.
#pragma once

#include <functional>
#include <limits>
#include <stdexcept>
#include <string_view>

namespace pmg::work {

inline constexpr double kUnknownShare = std::numeric_limits<double>::quiet_NaN();

/// Thrown by work of which an unfinished rest is of no use.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Both functions may be empty: then nobody is told, or nothing interrupts.
struct Progress {
  /// share: of the work that is done, 0 to 1, or kUnknownShare; doing: what is being done, or "". One call at a time.
  std::function<void(double share, std::string_view doing)> told{};
  /// True: end the work and keep what is done. From any thread, at any time.
  std::function<bool()> interrupted{};

  bool over() const { return interrupted && interrupted(); }
  /// Tells; true: go on.
  bool operator()(double share, std::string_view doing = {}) const {
    if (told) told(share, doing);
    return !over();
  }
  /// Tells; throws Interrupted where it is over.
  void go_on(double share, std::string_view doing = {}) const {
    if (!(*this)(share, doing)) throw Interrupted();
  }
};

}  // namespace pmg::work
