// Who drives: one source at a time, for as long as its lease lasts, its command's age counted by the receiver's clock.
#pragma once

#include <cstdint>
#include <limits>

#include "runtime/mode.hpp"

namespace pmg::runtime {

/// Driving messages that were ignored since the start, by reason.
struct IgnoredCommands {
  std::int64_t accepted = 0;
  std::int64_t other_source = 0;
  std::int64_t out_of_order = 0;
  std::int64_t late = 0;
  std::int64_t not_finite = 0;
  std::int64_t no_lease = 0;
};

class CommandIntake {
 public:
  enum class DriveVerdict {
    kAccepted,
    kOtherSourceDrives,
    kOutOfOrder,  ///< sequence not above the last one of this session: repeated or overtaken
    kLate,        ///< spent too long on the way
    kNotFinite,
    kNoLease,  ///< lease not positive
  };

  /// Longest lease that is granted: a crashed operator station blocks the others for no longer.
  static constexpr double kLongestLease_s = 2.0;

  DriveVerdict accept(const DriveMessage& message, std::int64_t now_ns) noexcept;

  /// Stopping is for everyone; climbing and resetting for the driving source, or for anyone when none drives.
  Verdict judge(const ModeRequest& request, std::int64_t now_ns) noexcept;

  const IgnoredCommands& ignored() const noexcept { return ignored_; }

  const Command& command() const noexcept { return last_.command; }  ///< last accepted; zero before the first

  /// Infinite before the first accepted command.
  double age_s(std::int64_t now_ns) const noexcept;

  /// Nobody drives: empty name.
  Source driving(std::int64_t now_ns) const noexcept;

 private:
  bool leased(std::int64_t now_ns) const noexcept { return any_ && now_ns < lease_end_ns_; }

  IgnoredCommands ignored_;
  bool any_ = false;
  DriveMessage last_;
  std::int64_t received_ns_ = 0;
  std::int64_t lease_end_ns_ = 0;
};

}  // namespace pmg::runtime
