#include "drives/answer_ledger.hpp"

#include <algorithm>
#include <utility>

namespace pmg::drives {

int AnswerLedger::begin() noexcept {
  ++cycle_;
  const int heard = std::exchange(heard_, 0);
  if (heard > 0 && overdue_ > 0 && ++flowing_ > kForgetCycles) overdue_ = 0;
  if (pausing_) {
    came_ += heard;
    ++paused_;
    if (heard > 0 && paused_ < kMostPaused) return 0;
    pausing_ = false;
    since_pause_ = behind_ = 0;
    if (heard > 0) return 0;  // still more to come
    usual_ = std::min(came_, most_usual_);
    const int given_up = std::exchange(owed_, 0);
    overdue_ = std::min(overdue_ + given_up, kMostOwed);
    if (given_up > 0) check_in_ = kCheckCycles;
    return given_up;
  }
  ++since_pause_;
  behind_ = heard > 0 && owed_ > usual_ ? behind_ + 1 : 0;
  const bool check = check_in_ == 1;
  check_in_ = std::max(check_in_ - 1, 0);
  const bool due = check || behind_ >= kBehindCycles || (behind_ > 0 && owed_ > most_usual_);
  if (!due || since_pause_ < kLeastBetween) {
    if (check) check_in_ = 1;
    return 0;
  }
  pausing_ = true;
  paused_ = came_ = 0;
  return 0;
}

void AnswerLedger::ask() noexcept {
  if (owed_ == kMostOwed) {  // the oldest one
    first_ = (first_ + 1) % kMostOwed;
    --owed_;
    overdue_ = std::min(overdue_ + 1, kMostOwed);
  }
  asked(owed_++) = cycle_;
}

void AnswerLedger::take_back() noexcept { owed_ = std::max(owed_ - 1, 0); }

AnswerLedger::Belongs AnswerLedger::hear() noexcept {
  ++heard_;
  if (owed_ == 0) return hear_late();
  age_ = static_cast<int>(cycle_ - asked(0));
  first_ = (first_ + 1) % kMostOwed;
  --owed_;
  return Belongs::kToARequest;
}

AnswerLedger::Belongs AnswerLedger::hear_part() noexcept { return owed_ > 0 ? Belongs::kToARequest : hear_late(); }

AnswerLedger::Belongs AnswerLedger::hear_late() noexcept {
  if (overdue_ == 0) return Belongs::kToNone;
  --overdue_;
  flowing_ = 0;
  check_in_ = kCheckCycles;
  return Belongs::kToOneGivenUp;
}

}  // namespace pmg::drives
