// Who drives: one source at a time, for as long as its lease lasts, its command's age counted by the receiver's clock.
#pragma once

#include <cstdint>
#include <limits>

#include "runtime/mode.hpp"

namespace pmg::runtime {

class CommandIntake {
 public:
  enum class Verdict {
    kAccepted,
    kOtherSourceDrives,
    kOutOfOrder,  ///< sequence not above the last one of this session: repeated or overtaken
    kNotFinite,
    kNoLease,  ///< lease not positive
  };

  /// Longest lease that is granted: a crashed operator station blocks the others for no longer.
  static constexpr double kLongestLease_s = 2.0;

  Verdict accept(const DriveMessage& message, std::int64_t now_ns) noexcept;

  /// Stopping is for everyone; climbing and resetting for the driving source, or for anyone when none drives.
  bool may_request(const ModeRequest& request, std::int64_t now_ns) const noexcept;

  const Command& command() const noexcept { return last_.command; }  ///< last accepted; zero before the first

  /// Infinite before the first accepted command.
  double age_s(std::int64_t now_ns) const noexcept;

  /// Nobody drives: empty name.
  Source driving(std::int64_t now_ns) const noexcept;

 private:
  bool leased(std::int64_t now_ns) const noexcept { return any_ && now_ns < lease_end_ns_; }

  bool any_ = false;
  DriveMessage last_;
  std::int64_t received_ns_ = 0;
  std::int64_t lease_end_ns_ = 0;
};

}  // namespace pmg::runtime
