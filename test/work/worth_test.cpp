// What a result is worth decides words, files and exit codes alike.
#include "work/worth.hpp"

#include <gtest/gtest.h>

namespace pmg::work {
namespace {

TEST(Worth, WithoutAReservationItHoldsAndSaysNothing) {
  const Worth worth;
  EXPECT_EQ(worth.grade(), Grade::kHolds);
  EXPECT_TRUE(worth.usable());
  EXPECT_EQ(worth.sentence(), "");
  EXPECT_EQ(worth.exit_code(), 0);
}

TEST(Worth, TheWorstReservationIsTheGradeAndStandsFirst) {
  Worth worth(Grade::kOpen, "one");
  worth.add(Grade::kOffItsData, "two");
  worth.add(Grade::kMissed, "three");
  worth.add(Grade::kOffItsData, "four");
  worth.add(Grade::kHolds, "none");
  EXPECT_EQ(worth.grade(), Grade::kOffItsData);
  EXPECT_EQ(worth.sentence(), "OFF ITS DATA: two; OFF ITS DATA: four; MISSED: three; OPEN: one");
}

TEST(Worth, OnlyWhatHoldsOrNamesWhatIsOpenEndsAProgramWith0) {
  for (const Grade grade : {Grade::kPartial, Grade::kMissed, Grade::kNoBetter, Grade::kOffItsData}) {
    EXPECT_EQ(Worth(grade, "why").exit_code(), 1) << name(grade);
    EXPECT_FALSE(Worth(grade, "why").usable());
  }
  EXPECT_EQ(Worth(Grade::kOpen, "why").exit_code(), 0);
  Worth both(Grade::kOffItsData, "why");
  both.add(Grade::kInterrupted, "why");
  EXPECT_EQ(both.exit_code(), 130);
}

}  // namespace
}  // namespace pmg::work
