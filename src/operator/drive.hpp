// One stretch of driving: a command for some seconds, then zero velocity.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "operator/climb.hpp"
#include "operator/mode_wish.hpp"
#include "operator/operator_source.hpp"
#include "pmg/command.hpp"

namespace pmg::ops {

struct DriveOptions {
  double duration_s = 0.0;
  bool climb = false;  ///< ask for Walk first, and for Stand at the end
  double timeout_s =
      10;  ///< for each of the two requests, for a hoist to set the robot down, for a crashed source's lease to end
};

/// Sends at 50 Hz from construction on, because the controller needs a fresh command to enter Walk.
class Drive {
 public:
  static constexpr std::int64_t kPeriod_ns = 20'000'000;
  static constexpr double kLease_s = 0.5;       ///< a crashed station blocks the others for this time at most
  static constexpr double kLastLease_s = 0.02;  ///< of the last command, so that the next source need not wait
  static constexpr std::int64_t kRelease_ns =
      50'000'000;  ///< until that lease is over and the next line of a script may drive
  static constexpr std::int64_t kCalm_ns =
      600'000'000;  ///< zero velocity at the end: the generator's ramp and a margin
  static constexpr std::int64_t kSettle_ns =
      300'000'000;  ///< after this time the controller must show this source as driving

  /// Keeps a reference to source.
  Drive(OperatorSource& source, std::string robot, const Command& command, const DriveOptions& options);

  /// Call after each link.receive(), at least every 20 ms.
  Progress step();
  /// Ends the stretch early, also with zero velocity.
  void end_early() noexcept;

  const std::string& text() const noexcept { return text_; }  ///< why it failed, in words
  bool driving() const noexcept { return phase_ == Phase::kDriving; }
  double driven_s() const;
  /// The source whose lease must end first: it drove, fell silent and did not let go. Empty: none.
  std::string waits_for() const;

 private:
  /// kClaiming: no climb is needed; the drive sends zero commands until the controller shows this source as driving.
  enum class Phase { kClimbing, kClaiming, kDriving, kCalming, kDescending, kEnded };

  void enter(Phase phase);
  Progress fail(const std::string& text);
  Progress follow_climb();
  Progress follow_wish();
  Progress claim();
  /// The reason to stop; empty: none.
  std::string trouble() const;
  void send_if_due();

  OperatorSource& source_;
  std::string robot_;
  Command command_;
  DriveOptions options_;
  Phase phase_ = Phase::kDriving;
  std::int64_t begin_ns_, phase_since_ns_ = 0, send_at_ns_ = 0;
  double driven_s_ = 0.0;
  bool end_early_ = false;
  std::optional<Climb> climb_;
  std::optional<ModeWish> wish_;
  std::string text_;
};

}  // namespace pmg::ops
