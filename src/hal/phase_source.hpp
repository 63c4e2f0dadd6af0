// Drives with a clock of their own, to which the bus thread's cycles are drawn.
#pragma once

#include <cstdint>

namespace pmg::hal {

/// A Hal that is one, too, has such drives.
class PhaseSource {
 public:
  virtual ~PhaseSource() = default;
  /// How much later than planned the next cycle is to begin, and all after it [ns]. After exchange(); some 20 us at
  /// most. 0: as planned.
  virtual std::int64_t phase_shift_ns() const noexcept = 0;
};

}  // namespace pmg::hal
