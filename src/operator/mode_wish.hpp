// An operator's request for a mode: repeated every 50 ms until the answer, then watched until the robot has the mode.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "operator/operator_source.hpp"

namespace pmg::ops {

enum class Goal {
  kStop,     ///< the robot no longer moves by itself: damping, or passive already
  kDamping,  ///< the drives brake
  kPassive,  ///< the drives give no torque
  kStand,
  kWalk,
  kReset,  ///< leave a latched fault
};

enum class Progress { kPending, kReached, kFailed };

/// The outcome of the request at one robot.
struct Answer {
  std::string robot;
  bool acknowledged = false;
  Progress progress = Progress::kPending;
  std::string mode;  ///< the newest known mode
  std::string text;  ///< for people: why the request failed, or empty
  /// From the first request until this operator knew it [s]; nullopt: not yet.
  std::optional<double> acknowledged_after_s{}, reached_after_s{};
};

class ModeWish {
 public:
  static constexpr std::int64_t kRepeat_ns = 50'000'000;
  /// Controllers send 100 times a second. After this time without a message there is no controller.
  static constexpr std::int64_t kGather_ns = 200'000'000;
  /// After a refusal: in this time a living driver sends again (OperatorSource::silent_driver).
  static constexpr std::int64_t kDoubt_ns = 300'000'000;

  /// Keeps a reference and sends the first request. robot: empty means every robot on this address, only for kStop.
  ModeWish(OperatorSource& source, std::string robot, Goal goal, double timeout_s);

  /// Repeats the request when due and evaluates the answers. Call after each link.receive(). After a refusal because of
  /// a crashed source, the request waits for the end of that source's lease and starts again.
  Progress step();

  /// One for each addressed robot, also for a silent one.
  std::vector<Answer> answers() const;
  double elapsed_s() const;
  /// The source whose lease must end first: it drove, fell silent and did not let go. Empty: none.
  std::string waits_for() const;

 private:
  /// When an answer and its mode were first known [s after the first request].
  struct Times {
    std::optional<double> acknowledged_s, reached_s;
  };
  void note_times();
  Answer judge(const std::string& robot) const;
  /// Whether a refusal is final: another source drives and still sends.
  bool final(const HeardRobot& heard) const;
  /// Whether an operator stopped the robot, or a fault latched, after the refusal. Then the old request must not
  /// return.
  bool stopped_meanwhile(const HeardRobot& heard) const;
  void ask_again_after_lease();
  Answer judge_taken(Answer answer, const HeardRobot& heard) const;

  OperatorSource& source_;
  std::string robot_;
  Goal goal_;
  double timeout_s_;
  std::int64_t begin_ns_, repeat_at_ns_;
  std::int64_t refused_ns_ = -1;  ///< time of the first refusal; -1: none
  bool upright_when_refused_ = false;
  std::map<std::string, Times> times_;
};

}  // namespace pmg::ops
