// Decides who drives: one source at a time, while its lease lasts. The receiver's clock counts the age of its command.
#pragma once

#include <algorithm>
#include <cstdint>

#include "control/arms_message.hpp"
#include "control/mode.hpp"
#include "control/source_memory.hpp"

namespace pmg::control {

/// Counts of operators' messages since the start, commands, arms and requests alike, by verdict. All but the accepted
/// ones were ignored.
struct IgnoredCommands {
  std::int64_t accepted = 0;
  std::int64_t other_source = 0;
  std::int64_t out_of_order = 0;
  std::int64_t late = 0;
  std::int64_t not_finite = 0;
  std::int64_t no_lease = 0;
  std::int64_t no_arms = 0;  ///< arms' messages to a robot without any
};

class CommandIntake {
 public:
  enum class DriveVerdict {
    kAccepted,
    kOtherSourceDrives,
    kOutOfOrder,  ///< sequence not above the last one of this session, or an earlier session: repeated or overtaken
    kLate,        ///< spent too long on the way
    kNotFinite,   ///< arms: or no pose that a palm can have
    kNoLease,     ///< lease not positive
  };

  /// The answer to a request.
  struct Judgement {
    Verdict verdict = Verdict::kTaken;
    /// To be carried out. False for what is refused, and for the repetition of a request: it only gets the same answer
    /// again. A stop that isn't fresh (repeated, overtaken, late) still stops, but doesn't ask for limp drives a second
    /// time.
    bool fresh = false;
  };

  /// A driver whose commands have asked for no motion (velocity zero, posture unchanged) for so long only renews its
  /// lease. A request for a mode from another source then takes the robot over.
  static constexpr std::int64_t kAtRest_ns = 3'000'000'000;
  /// The lease of a source that has taken over, until its first command.
  static constexpr double kTakeOverLease_s = 0.5;

  /// Longest lease that is granted. A crashed operator station blocks the others for no longer.
  static constexpr double kLongestLease_s = 2.0;
  /// And of arms' messages: without a newer one arms go on towards their targets for no longer.
  static constexpr double kLongestArmsLease_s = 0.5;
  /// A palm's target is no farther from the torso, along each axis: beyond, it is a mistake.
  static constexpr double kFarthestPalm_m = 10.0;
  /// A target's quaternion differs no more from length 1: single precision and rounded text do by less.
  static constexpr double kUnitQuaternion = 1e-3;

  /// (command message, time) => (verdict). An accepted one becomes command(). Whatever the verdict is, its number is
  /// used up.
  DriveVerdict accept(const DriveMessage& message, std::int64_t now_ns) noexcept;
  /// The same for arms: only the source that drives leads them.
  DriveVerdict accept(const ArmsMessage& message, std::int64_t now_ns) noexcept;
  void ignore_arms() noexcept { ++ignored_.no_arms; }  ///< a message to a robot without arms

  /// (mode request, time) => (verdict). A request is judged once; repetitions get the same verdict. Anyone may stop at
  /// any time. Only the driving source may climb or reset; anyone
  /// may when none drives, or when the driver only renews its lease: then the request takes over. down: the robot lies,
  /// so nobody makes it stand up.
  Judgement judge(const ModeRequest& request, std::int64_t now_ns, bool down = false) noexcept;

  /// The stop line was pulled. The stop overtakes climbs and resets that were received until now, wherever they still
  /// wait.
  void stop(std::int64_t now_ns) noexcept { stopped_ns_ = std::max(stopped_ns_, now_ns); }

  const IgnoredCommands& ignored() const noexcept { return ignored_; }

  const Command& command() const noexcept { return last_.command; }  ///< last accepted; zero before the first

  /// Since the last accepted command was received; infinite before the first.
  double age_s(std::int64_t now_ns) const noexcept;

  /// Nobody drives: empty name.
  Source driving(std::int64_t now_ns) const noexcept;

  const ArmsMessage& arms() const noexcept { return arms_; }  ///< last accepted
  /// Whether it is in force as far as messages go: the driving source's, within its lease.
  ArmsOrder arms_order(std::int64_t now_ns) const noexcept;
  std::int64_t arms_refused() const noexcept { return arms_refused_; }  ///< since the start
  DriveVerdict arms_refusal() const noexcept { return arms_refusal_; }  ///< of the last refused; kAccepted: none was

 private:
  bool leased(std::int64_t now_ns) const noexcept { return any_ && now_ns < lease_end_ns_; }
  /// What a request is to its source's earlier ones.
  enum class Standing {
    kNew,
    kRepeated,
    kOverdue,  ///< of an ended session, overtaken, or the number of a request that asked for something else
    kNobodys,  ///< a stop that anybody may have sent
  };

  /// The driver's own name with another session: of a successor that must wait, or of a stranger.
  bool uses_drivers_name(const Source& source, std::int64_t now_ns) const noexcept;
  /// Judges the message's number and remembers it: kOutOfOrder, kLate or kAccepted. last: of this kind of messages.
  /// record: the source's; null: kOutOfOrder.
  template <typename Message>
  DriveVerdict take_number(const Message& message, std::int64_t SourceRecord::*last, std::int64_t received_ns,
                           std::int64_t now_ns, SourceRecord*& record) noexcept;
  DriveVerdict check(const DriveMessage& message, std::int64_t now_ns) const noexcept;
  DriveVerdict check(const ArmsMessage& message, std::int64_t now_ns) const noexcept;
  Standing standing(const ModeRequest& request, std::int64_t received_ns, std::int64_t now_ns) const noexcept;
  /// Of a new request. record: its source's.
  Judgement decide(const ModeRequest& request, const SourceRecord& record, std::int64_t received_ns,
                   std::int64_t now_ns, bool down) const noexcept;
  Judgement judge_new(const ModeRequest& request, std::int64_t received_ns, std::int64_t now_ns, bool down) noexcept;
  /// Its sender didn't know of the last stop, or it was received before it.
  bool before_stop(const ModeRequest& request, std::int64_t received_ns) const noexcept {
    return !request.stops() && (received_ns <= stopped_ns_ || request.heard_ns < stopped_ns_);
  }

  SourceMemory sources_;
  std::int64_t stopped_ns_ = -1;
  IgnoredCommands ignored_;
  bool any_ = false;
  DriveMessage last_;
  std::int64_t received_ns_ = 0;
  std::int64_t lease_end_ns_ = 0;
  ArmsMessage arms_;
  std::int64_t arms_end_ns_ = 0, arms_refused_ = 0;
  DriveVerdict arms_refusal_ = DriveVerdict::kAccepted;
  std::int64_t moved_ns_ = 0;  // when the driver began, or last asked for motion
};

}  // namespace pmg::control
