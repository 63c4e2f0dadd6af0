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

  /// Keeps a reference, and asks for the first time. robot: empty for every robot on this address, for kStop alone.
  ModeWish(OperatorSource& source, std::string robot, Goal goal, double timeout_s);

  /// Asks again when it is due, and judges what was heard. To be called after every link.receive().
  Progress step();

  /// One for each robot that this concerns, heard or not.
  std::vector<Answer> answers() const;
  double elapsed_s() const;

 private:
  Answer judge(const std::string& robot) const;
  Answer judge_taken(Answer answer, const HeardRobot& heard) const;

  OperatorSource& source_;
  std::string robot_;
  Goal goal_;
  double timeout_s_;
  std::int64_t begin_ns_, repeat_at_ns_;
};

}  // namespace pmg::ops
