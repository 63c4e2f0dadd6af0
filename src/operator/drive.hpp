// One stretch of driving: a command held for some seconds, and velocity brought to zero at its end.
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
      10;  ///< for each of the two, for a hoist to set the robot down, for a crashed source's lease to end
};

/// Sends at 50 Hz from construction on, so that Walk finds a fresh command.
class Drive {
 public:
  static constexpr std::int64_t kPeriod_ns = 20'000'000;
  static constexpr double kLease_s = 0.5;                  ///< a crashed station blocks the others for no longer
  static constexpr double kLastLease_s = 0.02;             ///< of the last command: the next source needn't wait
  static constexpr std::int64_t kRelease_ns = 50'000'000;  ///< until that lease is over: a script's next line may drive
  static constexpr std::int64_t kCalm_ns = 600'000'000;    ///< zero velocity at the end: the generator's ramp and some
  static constexpr std::int64_t kSettle_ns = 300'000'000;  ///< until the controller must show this source as driving

  /// Keeps a reference to source.
  Drive(OperatorSource& source, std::string robot, const Command& command, const DriveOptions& options);

  /// To be called after every link.receive(), every 20 ms or oftener.
  Progress step();
  /// Ends the stretch early, with zero velocity as ever.
  void end_early() noexcept;

  const std::string& text() const noexcept { return text_; }  ///< why it failed, in words
  bool driving() const noexcept { return phase_ == Phase::kDriving; }
  double driven_s() const;
  /// The source whose lease is waited for: it drove, fell silent and did not let go. Empty: none.
  std::string waits_for() const;

 private:
  /// Claiming: nothing is climbed, and commands of zero are sent until the controller shows this source as driving.
  enum class Phase { kClimbing, kClaiming, kDriving, kCalming, kDescending, kEnded };

  void enter(Phase phase);
  Progress fail(const std::string& text);
  Progress follow_climb();
  Progress follow_wish();
  Progress claim();
  /// What speaks against going on; empty: nothing.
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
