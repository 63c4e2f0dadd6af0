// The first paragraph is for somebody with a screwdriver: what is wrong, how sure, how much better, what next.
#include "diagnosis_page/first_paragraph.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "effects/catalogue.hpp"

namespace pmg::diagnosis_page {
namespace {

using diagnosis::Cause;
using diagnosis::Diagnosis;
using evidence::Verdict;
using testing::HasSubstr;
using testing::Not;

Cause cause(const std::string& effect, std::vector<std::string> or_instead = {}) {
  Cause made;
  made.effect = effect;
  made.or_instead = std::move(or_instead);
  return made;
}

Diagnosis diagnosis_of(Verdict verdict, std::vector<Cause> causes) {
  Diagnosis made;
  made.verdict = verdict;
  made.causes = std::move(causes);
  made.held_out = true;
  made.held_out_before = {0.0349, 0.03, 0.04};  // 2 degrees
  made.held_out_after = {0.00349, 0.003, 0.004};
  made.noise_floor.mean_absolute_rad = 0.00175;
  return made;
}

std::string paragraph_of(const Diagnosis& diagnosis) { return first_paragraph(bench::Bench{}, diagnosis); }

TEST(FirstParagraph, OfACauseSaysWhatHowSureHowMuchBetterAndWhatToCheck) {
  const std::string text = paragraph_of(diagnosis_of(Verdict::kFound, {cause("backlash")}));
  for (const char* part : {"play in the gear", "fairly sure", "missed the measured position by 2 degrees, now by 0.2",
                           "noise alone makes 0.1 degrees", "Next: Hold the motor still"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
}

TEST(FirstParagraph, SaysWhatTheRobotSuffersFrom) {
  EXPECT_THAT(paragraph_of(diagnosis_of(Verdict::kFound, {cause("backlash"), cause("load_friction")})),
              testing::AllOf(HasSubstr("On the robot: The limb is loose"), HasSubstr("the more it carries")));
  EXPECT_THAT(paragraph_of(diagnosis_of(Verdict::kNone, {})), Not(HasSubstr("On the robot")));
}

TEST(FirstParagraph, OfAnInterruptedSearchSaysNeitherThatSomethingIsWrongNorThatNothingIs) {
  const std::string text = paragraph_of(diagnosis_of(Verdict::kInterrupted, {cause("backlash")}));
  EXPECT_THAT(text, testing::AllOf(HasSubstr("stopped before it was finished"), HasSubstr("start it again"),
                                   Not(HasSubstr("play in the gear")), Not(HasSubstr("sure"))));
}

TEST(FirstParagraph, OfASimulationThatExplainsNothingNamesNoCause) {
  Diagnosis other = diagnosis_of(Verdict::kFound, {cause("backlash")});
  other.standing_still = 0.005;  // 0.00349 with the causes
  EXPECT_THAT(paragraph_of(other), testing::AllOf(HasSubstr("not even roughly"), Not(HasSubstr("play in the gear"))));
}

TEST(FirstParagraph, OfTwoRivalsAsksForTheRecordingsThatTell) {
  Diagnosis both = diagnosis_of(Verdict::kAmbiguous, {cause("delay", {"sensor_lag"})});
  both.next_excitation.emplace();
  both.next_excitation->runs.resize(2);
  both.next_excitation->runs.front().times = 3;
  EXPECT_THAT(paragraph_of(both), testing::AllOf(HasSubstr("a delay between command and motion or a position reading"),
                                                 HasSubstr("not sure which"), HasSubstr("make the 4 recordings")));
}

TEST(FirstParagraph, OfNothingFoundClaimsNoMoreThanTheRecordingsShow) {
  EXPECT_THAT(paragraph_of(diagnosis_of(Verdict::kNone, {})),
              testing::AllOf(HasSubstr("found nothing"), HasSubstr("what these recordings can show"),
                             HasSubstr("misses the measured position by 0.2 degrees"), HasSubstr("nothing to do")));
}

TEST(FirstParagraph, OfTheUnexplainedSaysWhatItComesWithAndWhereToLook) {
  Diagnosis strange = diagnosis_of(Verdict::kUnexplained, {});
  strange.depends_on = {"velocity", "drive"};
  EXPECT_THAT(paragraph_of(strange),
              testing::AllOf(HasSubstr("no effect on our list explains it"),
                             HasSubstr("the speed, how hard the motor works"), HasSubstr("loose screws")));
}

TEST(FirstParagraph, SaysWhatOrMeansWhateverTheVerdict) {
  EXPECT_THAT(paragraph_of(diagnosis_of(Verdict::kUnexplained, {cause("delay", {"sensor_lag"})})),
              HasSubstr("don't tell which"));
  Cause two_names = cause("offset");
  two_names.same_here = {"direction_friction"};
  EXPECT_THAT(paragraph_of(diagnosis_of(Verdict::kFound, {two_names})), HasSubstr("mean the same"));
}

TEST(FirstParagraph, OfFaultyDataTrustsNothing) {
  Diagnosis faulty = diagnosis_of(Verdict::kFound, {cause("gain")});
  faulty.data.faults.push_back({.kind = data_faults::Kind::kUnit, .where = "column q_cmd_rad", .correction = ""});
  ASSERT_TRUE(faulty.data.uncorrected());
  EXPECT_THAT(paragraph_of(faulty), testing::AllOf(HasSubstr("don't trust it"), HasSubstr("repair the recordings"),
                                                   Not(HasSubstr("sure")), Not(HasSubstr("stronger or weaker"))));
}

TEST(FirstParagraph, PointsAtRunsThatContradictEachOther) {
  Diagnosis odd = diagnosis_of(Verdict::kUnexplained, {});
  odd.noise_floor.odd_runs = {{.run = "run3.csv", .why = "differs", .deviation_rad = 0.1, .left_out = true}};
  EXPECT_THAT(paragraph_of(odd), Not(HasSubstr("contradict"))) << "the one that was odd is left out";
  odd.noise_floor.odd_runs.push_back({.run = "run4.csv", .why = "differs", .deviation_rad = 0.1, .left_out = false});
  EXPECT_THAT(paragraph_of(odd), testing::AllOf(HasSubstr("contradict each other"), HasSubstr("record them again")));
}

TEST(FirstParagraph, SaysWhenTheSimulationGetsNoBetter) {
  Diagnosis worse = diagnosis_of(Verdict::kFound, {cause("gain")});
  std::swap(worse.held_out_before, worse.held_out_after);
  EXPECT_THAT(paragraph_of(worse), testing::AllOf(HasSubstr("gets no better"), HasSubstr("don't rely on it")));
}

TEST(FirstParagraph, HasNoTermOfTheFieldAndNoLongSentence) {
  for (const Verdict verdict : {Verdict::kFound, Verdict::kAmbiguous, Verdict::kUnexplained, Verdict::kNone}) {
    for (const effects::Effect& effect : effects::catalogue()) {
      const bool any = verdict != Verdict::kNone;
      const std::string text =
          paragraph_of(diagnosis_of(verdict, any ? std::vector{cause(effect.name)} : std::vector<Cause>{}));
      for (const char* term : {"residual", "rollout", "mrad", "fold", "interval", "linear", "excitation", "coulomb",
                               "stribeck", "backlash", "hysteresis", "parameter", "_"})
        EXPECT_THAT(text, Not(HasSubstr(term))) << effect.name;
    }
  }
}

TEST(Workshop, EveryEffectOfTheCatalogueHasACheck) {
  for (const effects::Effect& effect : effects::catalogue()) {
    const effects::WorkshopWords& words = effect.workshop;
    EXPECT_NE(words.what, effect.title) << effect.name;
    EXPECT_THAT(words.check, testing::ContainsRegex("[.?]$")) << effect.name;
    EXPECT_THAT(words.cost, testing::ContainsRegex("[.]$")) << effect.name;
  }
}

}  // namespace
}  // namespace pmg::diagnosis_page
