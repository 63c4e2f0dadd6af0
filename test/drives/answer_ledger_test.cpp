#include "drives/answer_ledger.hpp"

#include <gtest/gtest.h>

#include <deque>

namespace pmg::drives {
namespace {

using Belongs = AnswerLedger::Belongs;

/// A drive whose answers come so many cycles after their requests; of some requests none.
class Drive {
 public:
  AnswerLedger ledger;
  int late = 0;
  bool loses = false;
  int pauses = 0;

  void cycle() {
    ledger.begin();
    ++now_;
    if (ledger.pauses()) {
      ++pauses;
    } else {
      ledger.ask();
      if (!loses) due_.push_back(now_ + late);
    }
    for (; !due_.empty() && due_.front() <= now_; due_.pop_front()) {
      EXPECT_EQ(ledger.hear(), Belongs::kToARequest);
      EXPECT_GE(ledger.age_cycles(), late);
    }
  }

 private:
  int now_ = 0;
  std::deque<int> due_;
};

TEST(AnswerLedger, ADriveThatAnswersIsNeverPaused) {
  Drive drive;
  for (int k = 0; k < 1000; ++k) drive.cycle();
  EXPECT_EQ(drive.pauses, 0);
  EXPECT_EQ(drive.ledger.owed(), 0);
}

TEST(AnswerLedger, LostRequestsAreGivenUpAfterOnePauseAndCheckedByAnother) {
  for (const int lost : {1, 2, 5, 400}) {
    Drive drive;
    for (int k = 0; k < 100; ++k) drive.cycle();
    drive.loses = true;
    for (int k = 0; k < lost; ++k) drive.cycle();
    drive.loses = false;
    for (int k = 0; k < 8; ++k) drive.cycle();
    EXPECT_EQ(drive.ledger.owed(), 0) << lost;
    EXPECT_EQ(drive.pauses, 1) << lost;
    for (int k = 0; k < 400; ++k) drive.cycle();
    EXPECT_EQ(drive.pauses, 2) << lost;
    EXPECT_EQ(drive.ledger.given_up(), lost);
    for (int k = 0; k < AnswerLedger::kForgetCycles; ++k) drive.cycle();
    EXPECT_EQ(drive.ledger.given_up(), 0) << lost;
  }
}

TEST(AnswerLedger, ADriveThatIsACycleLateAsARuleIsPausedOnce) {
  Drive drive;
  drive.late = 1;
  for (int k = 0; k < 1000; ++k) drive.cycle();
  EXPECT_EQ(drive.pauses, 2) << "one cycle in which the last answer comes, one without";
  EXPECT_EQ(drive.ledger.owed(), 1);
}

TEST(AnswerLedger, AnAgeIsNeverLessThanTheTruthAndPausesAreShort) {
  for (const int late : {2, 4, 7}) {
    Drive drive;
    drive.late = late;
    int paused = 0;
    for (int k = 0; k < 1000; ++k) {
      drive.cycle();
      paused = drive.ledger.pauses() ? paused + 1 : 0;
      ASSERT_LE(paused, AnswerLedger::kMostPaused) << late;
    }
    EXPECT_GT(drive.pauses, 0);
  }
}

TEST(AnswerLedger, MoreAnswersThanRequestsAreNobodys) {
  AnswerLedger ledger;
  ledger.begin();
  ledger.ask();
  EXPECT_EQ(ledger.hear(), Belongs::kToARequest);
  EXPECT_EQ(ledger.hear(), Belongs::kToNone);
  EXPECT_EQ(ledger.hear_part(), Belongs::kToNone);
  ledger.ask();
  ledger.take_back();
  EXPECT_EQ(ledger.hear(), Belongs::kToNone) << "it never left this computer";
}

TEST(AnswerLedger, AnAnswerToARequestThatWasGivenUpIsNobodysSecond) {
  Drive drive;
  for (int k = 0; k < 10; ++k) drive.cycle();
  drive.loses = true;
  for (int k = 0; k < 3; ++k) drive.cycle();
  drive.loses = false;
  for (int k = 0; k < 20 && drive.ledger.given_up() == 0; ++k) drive.cycle();
  ASSERT_EQ(drive.ledger.given_up(), 3);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(drive.ledger.hear(), Belongs::kToOneGivenUp) << k;
  EXPECT_EQ(drive.ledger.hear(), Belongs::kToNone);
}

}  // namespace
}  // namespace pmg::drives
