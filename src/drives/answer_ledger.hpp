// Which request an answer belongs to, of a drive whose answers carry no number. What tells is how many were asked for,
// how many came, and when nothing more comes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace pmg::drives {

/// Answers come in the order of their requests, one each, at any later time: a queue may hold either back. Requests and
/// answers may be lost. So an answer is taken for that of the oldest request, and an age that is told is never too
/// small. What is lost shows in a pause: a cycle without a request in which nothing comes owes nothing any more.
/// No heap, no lock. A cycle: begin(), then ask() unless pauses(), then hear() for each answer.
class AnswerLedger {
 public:
  enum class Belongs {
    kToARequest,
    kToOneGivenUp,  ///< late, and older than what is known by now
    kToNone,        ///< more answers than requests: a frame that was doubled, or a second drive
  };

  /// Requests that an interface's queue holds at most, with one motor on its bus.
  static constexpr int kMostOwed = 1000;
  /// Answers that lag behind as a rule have a request under way; so has a drive that lost one: looked at after so many
  /// cycles. More than usual are looked at once.
  static constexpr int kBehindCycles = 3;
  /// Cycles that a pause lasts at most: drives let go after 10 without a command; and cycles between two.
  static constexpr int kMostPaused = 5, kLeastBetween = 5;
  /// A request that was given up too early is found by another pause so many cycles later.
  static constexpr int kCheckCycles = 50;
  /// Cycles with an answer, and none of those given up, after which none of these is under way any more: 1 s, in which
  /// a bus carries more frames than a queue holds.
  static constexpr int kForgetCycles = 500;

  /// usual: requests that may be under way when a cycle begins; one fewer are, until a pause says otherwise.
  explicit AnswerLedger(int usual = 1) noexcept : most_usual_(usual), usual_(usual - 1) {}

  /// Returns how many requests are given up now.
  int begin() noexcept;
  /// Leave this cycle's request out.
  bool pauses() const noexcept { return pausing_; }
  void ask() noexcept;
  void take_back() noexcept;  ///< the last request never left this computer
  Belongs hear() noexcept;
  /// A part of an answer whose other part is missing: it answers no request.
  Belongs hear_part() noexcept;

  int owed() const noexcept { return owed_; }  ///< requests that may still be answered
  int given_up() const noexcept { return overdue_; }
  /// Cycles from the request of the last answer until it came.
  int age_cycles() const noexcept { return age_; }

 private:
  Belongs hear_late() noexcept;
  std::uint32_t& asked(int request) noexcept {
    return asked_[static_cast<std::size_t>(first_ + request) % asked_.size()];
  }

  std::array<std::uint32_t, kMostOwed> asked_{};  // cycles of what is owed, a ring
  int first_ = 0;                                 // the oldest one's place
  std::uint32_t cycle_ = 0;
  int age_ = 0;
  int owed_ = 0, overdue_ = 0;  // requests: that may be answered, that were given up
  int heard_ = 0;               // answers in this cycle
  int most_usual_, usual_;      // requests under way as a rule: at most, by the last pause
  bool pausing_ = false;
  int paused_ = 0, came_ = 0;  // of this pause: cycles, answers
  int behind_ = 0, since_pause_ = kLeastBetween, flowing_ = 0;
  int check_in_ = 0;  // cycles; 0: no check is due
};

}  // namespace pmg::drives
