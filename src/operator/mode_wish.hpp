// A mode that an operator wants: asked for every 50 ms until it is answered, then watched until it is reached.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "operator/operator_source.hpp"

namespace pmg::ops {

enum class Goal {
  kStop,     ///< no robot moves by its own: damping, or passive already
  kDamping,  ///< drives brake
  kPassive,  ///< drives limp
  kStand,
  kWalk,
  kReset,  ///< out of a latched fault
};

enum class Progress { kPending, kReached, kFailed };

/// What became of a wish at one robot.
struct Answer {
  std::string robot;
  bool acknowledged = false;
  Progress progress = Progress::kPending;
  std::string mode;  ///< the newest that is known
  std::string text;  ///< for people: why not, or empty
};

class ModeWish {
 public:
  static constexpr std::int64_t kRepeat_ns = 50'000'000;
  /// Controllers speak 100 times a second: those that were not heard in this time are not there.
  static constexpr std::int64_t kGather_ns = 200'000'000;
  /// After a refusal: until it shows whether the source that drives still sends (HeardRobot::silent_driver).
  static constexpr std::int64_t kDoubt_ns = 300'000'000;

  /// Keeps a reference, and asks for the first time. robot: empty for every robot on this address, for kStop alone.
  ModeWish(OperatorSource& source, std::string robot, Goal goal, double timeout_s);

  /// Asks again when it is due, and judges what was heard. To be called after every link.receive(). Refused because of
  /// a source that has crashed, it waits for the end of that one's lease and asks again.
  Progress step();

  /// One for each robot that this concerns, heard or not.
  std::vector<Answer> answers() const;
  double elapsed_s() const;
  /// The source whose lease is waited for: it drove, fell silent and did not let go. Empty: none.
  std::string waits_for() const;

 private:
  Answer judge(const std::string& robot) const;
  /// Whether a refusal is the last word: somebody drives, and goes on sending.
  bool final(const HeardRobot& heard) const;
  /// Somebody stopped the robot, or it faulted, after the refusal: what was asked before that is not asked again.
  bool stopped_meanwhile(const HeardRobot& heard) const;
  void ask_again_after_lease();
  Answer judge_taken(Answer answer, const HeardRobot& heard) const;

  OperatorSource& source_;
  std::string robot_;
  Goal goal_;
  double timeout_s_;
  std::int64_t begin_ns_, repeat_at_ns_;
  std::int64_t refused_ns_ = -1;  ///< the first time; -1: never
  bool upright_when_refused_ = false;
};

}  // namespace pmg::ops
