// What is known of one motor from its answers: how old they are, whether they can be believed, whether the drive obeys.
#pragma once

#include <cstdint>

#include "drives/motor.hpp"

namespace pmg::drives {

enum class Trouble : std::uint8_t {
  kNone = 0,
  kSilent,         ///< no answer for more than kSilentCycles
  kFault,          ///< the drive reports a fault of its own
  kNotEnabled,     ///< the drive answers, and doesn't follow commands
  kPositionJump,   ///< the position moved faster than the motor can: a wrapped or lost turn
  kFrozenEncoder,  ///< the position stands still although the motor turns
  kTwoOfOneNode,   ///< more answers than commands: two drives have this node number
  kOtherGains,     ///< the drive's own loop has other gains than the command
  kRestarted,      ///< the drive was powered anew and has lost its set-up
};

const char* to_string(Trouble trouble) noexcept;

enum class Condition : std::uint8_t {
  kGood,  ///< answered this cycle's command or the one before
  kLate,
  kLost,  ///< in trouble
};

/// No heap, no lock. One object a motor; values are those of the drive's output shaft.
class MotorMonitor {
 public:
  /// An answer to the last cycle's command may arrive in this one: seven drives on a bus of 1 Mbit/s fill both.
  static constexpr int kFreshCycles = 1;
  /// 10 ms. With the control thread's next tick the robot is damped within 10 cycles of the last answer.
  static constexpr int kSilentCycles = 5;
  /// Such readings in a row are an encoder that lost its position; fewer are dropped as damaged.
  static constexpr int kJumps = 3;
  /// Answers nobody asked for within this time prove a second drive; a duplicated frame now and then doesn't.
  static constexpr int kUncalled = 3, kUncalledCycles = 50;
  /// Answers that were given up may still come, bunched by a delay: all of the last kUncalledCycles.
  static constexpr int kOverdue = kUncalledCycles;
  /// A motor can't travel so far within one step of its encoder.
  static constexpr double kFrozenTravel_rad = 0.1;
  /// Offset of a drive's speed at rest that doesn't count as travel.
  static constexpr double kSpeedOffset_rad_s = 0.2;
  static constexpr double kPeriod_s = 0.002;

  /// A reading may move by 2 dq_limit t + kJumpMargin: twice the limit is beyond what the control thread takes for a
  /// fault (1.5 times).
  static constexpr double kJumpMargin_rad = 0.05;

  explicit MotorMonitor(const MotorLimits& limits) noexcept : limits_(limits) {}

  /// A bus cycle begins and a command (or the request to enable) goes to the motor.
  void ask(bool enabling) noexcept;
  /// An answer. False: not believed; the last reading stays.
  bool hear(const MotorReading& reading) noexcept;
  /// A part of an answer that belongs to none: nobody asked for it, or its other part was lost.
  void hear_stray() noexcept;
  /// The last command has gains that the drive can't have; or it has none of them any more.
  void refuse_gains(bool refused) noexcept { gains_refused_ = refused; }
  void restarted() noexcept { latched_ = Trouble::kRestarted; }
  /// The bus thread paused for so long that the drive's watchdog may have acted: enable anew.
  void interrupt() noexcept { enabled_ = false; }

  /// stiff: the command in force holds a position or a torque, so a drive that doesn't follow is a loss.
  Condition condition(bool stiff) const noexcept;
  Trouble trouble(bool stiff) const noexcept;

  bool believed() const noexcept { return latched_ == Trouble::kNone; }  ///< its readings can be acted on
  bool enabled() const noexcept { return enabled_; }
  bool answered() const noexcept { return any_; }
  int age_cycles() const noexcept { return age_; }  ///< since the last answer that was believed
  const MotorReading& reading() const noexcept { return reading_; }
  std::uint32_t lost() const noexcept { return lost_; }          ///< commands that nobody answered
  std::uint32_t refused() const noexcept { return refused_; }    ///< answers not believed
  std::uint32_t uncalled() const noexcept { return uncalled_; }  ///< answers that nobody asked for

 private:
  static constexpr int kNever = 1'000'000;
  bool jumped(const MotorReading& reading) const noexcept;
  void watch_encoder(const MotorReading& reading) noexcept;

  MotorLimits limits_;
  MotorReading reading_;
  bool any_ = false, enabled_ = false, enabling_ = false, gains_refused_ = false;
  int age_ = kNever;
  int owed_ = 0;     // answers, 2 at most
  int overdue_ = 0;  // answers that were given up
  int cycles_since_overdue_ = 0;
  int jumps_ = 0, uncalled_lately_ = 0, cycles_since_uncalled_ = 0;
  double frozen_travel_rad_ = 0.0;
  Trouble latched_ = Trouble::kNone;
  std::uint32_t lost_ = 0, refused_ = 0, uncalled_ = 0;
};

}  // namespace pmg::drives
