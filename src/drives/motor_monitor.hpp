// What is known of one motor from its answers: how old they are, whether they can be believed, whether the drive obeys.
#pragma once

#include <algorithm>
#include <cstdint>

#include "drives/answer_ledger.hpp"
#include "drives/motor.hpp"

namespace pmg::drives {

enum class Trouble : std::uint8_t {
  kNone = 0,
  kSilent,         ///< no answer for more than kSilentCycles
  kFault,          ///< the drive reports a fault of its own
  kNotEnabled,     ///< the drive answers, and doesn't follow commands
  kPositionJump,   ///< the position moved faster than the motor can: a wrapped or lost turn
  kFrozenEncoder,  ///< the position stands still although the motor turns
  kTwoOfOneNode,   ///< more answers than requests, again and again: two drives have this node number
  kOtherGains,     ///< the drive's own loop has other gains than the command
  kRestarted,      ///< the drive was powered anew and has lost its set-up
  kOldState,       ///< the drive answers, and what it says is old each time
};

const char* to_string(Trouble trouble) noexcept;

enum class Condition : std::uint8_t {
  kGood,  ///< its state belongs to this cycle's request or the one before (over a bridge, to the one before that)
  kLate,
  kLost,  ///< in trouble
};

/// No heap, no lock. One object a motor; values are those of the drive's output shaft. A cycle: begin(), ask() unless
/// pauses(), then answers.
class MotorMonitor {
 public:
  /// An answer to the last cycle's command may arrive in this one: seven drives on a bus of 1 Mbit/s fill both. Over a
  /// bridge both ways take a cycle.
  static constexpr int kFreshCycles = 1, kFreshOverBridge = 2;
  /// 10 ms. With the control thread's next tick the robot is damped within 10 cycles of the last answer.
  static constexpr int kSilentCycles = 5;
  /// Cycles in a row with an older state than a fresh one, though the drive answers. A gap of kSilentCycles whose
  /// requests were lost makes six.
  static constexpr int kOldCycles = 8;
  /// Such readings in a row are an encoder that lost its position; fewer are dropped as damaged.
  static constexpr int kJumps = 3;
  /// Answers nobody asked for within this time prove a second drive; a duplicated frame now and then doesn't.
  static constexpr int kUncalled = 3, kUncalledCycles = 50;
  /// A motor can't travel so far within one step of its encoder.
  static constexpr double kFrozenTravel_rad = 0.1;
  /// Offset of a drive's speed at rest that doesn't count as travel.
  static constexpr double kSpeedOffset_rad_s = 0.2;
  static constexpr double kPeriod_s = 0.002;

  /// A reading may move by what the drive's own speeds before and after say, 1.5 times, and by
  /// kJumpMargin + a t^2 / 4: a motor that speeds up and slows down again between the two, as hard as a limb's impact
  /// makes it. Never by more than 2 dq_limit t + kJumpMargin: twice the limit is beyond what the control thread takes
  /// for a fault (1.5 times). t is a cycle longer than the time between the two requests.
  static constexpr double kJumpMargin_rad = 0.05, kSpeedShare = 1.5, kMostAcceleration_rad_s2 = 3000.0;

  explicit MotorMonitor(const MotorLimits& limits, int fresh_cycles = kFreshCycles) noexcept
      : limits_(limits), fresh_cycles_(fresh_cycles), ledger_(fresh_cycles) {}

  void begin() noexcept;
  /// No request is to go out in this cycle: what comes all the same tells how late the motor answers.
  bool pauses() const noexcept { return ledger_.pauses(); }
  /// A command (or the request to enable) goes to the motor.
  void ask(bool enabling) noexcept;
  /// It didn't: the way to the bus had no room.
  void take_back() noexcept;
  /// An answer. False: not believed; the last reading stays.
  bool hear(const MotorReading& reading) noexcept;
  /// A part of an answer that belongs to none: nobody asked for it, or its other part was lost.
  void hear_stray() noexcept;
  /// The last command has gains that the drive can't have; or it has none of them any more.
  void refuse_gains(bool refused) noexcept { gains_refused_ = refused; }
  void restarted() noexcept { latched_ = Trouble::kRestarted; }
  /// The bus thread paused for so long that the drive's watchdog may have acted: enable anew.
  void interrupt() noexcept;

  /// stiff: the command in force holds a position or a torque, so a drive that doesn't follow is a loss.
  Condition condition(bool stiff) const noexcept;
  Trouble trouble(bool stiff) const noexcept;

  bool believed() const noexcept { return latched_ == Trouble::kNone; }  ///< its readings can be acted on
  bool enabled() const noexcept { return enabled_; }
  bool answered() const noexcept { return any_; }
  bool silent() const noexcept { return silence_ > kSilentCycles; }
  bool settled() const noexcept { return ledger_.owed() == 0; }  ///< every request is answered, or given up
  /// Of the last state that was believed, since it was asked for: never less than the truth.
  int age_cycles() const noexcept { return age_; }
  bool fresh() const noexcept { return age_ <= fresh_cycles_; }
  const MotorReading& reading() const noexcept { return reading_; }
  /// Requests that nobody answered; the newest may be under way.
  std::uint32_t lost() const noexcept { return lost_ + static_cast<std::uint32_t>(std::max(ledger_.owed() - 1, 0)); }
  std::uint32_t refused() const noexcept { return refused_; }    ///< answers not believed
  std::uint32_t uncalled() const noexcept { return uncalled_; }  ///< answers that nobody asked for

 private:
  static constexpr int kNever = 1'000'000;
  bool jumped(const MotorReading& reading) const noexcept;
  void watch_encoder(const MotorReading& reading) noexcept;
  void take(AnswerLedger::Belongs belongs) noexcept;
  bool two() const noexcept { return uncalled_lately_ >= kUncalled; }

  MotorLimits limits_;
  int fresh_cycles_;
  AnswerLedger ledger_;
  MotorReading reading_;
  bool any_ = false, enabled_ = false, gains_refused_ = false;
  int age_ = kNever, silence_ = kNever;  // cycles: of the state, since it came
  int old_cycles_ = 0;
  int enabled_after_ = 0;  // answers until the one to the oldest request to enable; 0: none is under way
  int jumps_ = 0, uncalled_lately_ = 0, cycles_since_uncalled_ = 0;
  double frozen_travel_rad_ = 0.0;
  Trouble latched_ = Trouble::kNone;
  std::uint32_t lost_ = 0, refused_ = 0, uncalled_ = 0;
};

}  // namespace pmg::drives
