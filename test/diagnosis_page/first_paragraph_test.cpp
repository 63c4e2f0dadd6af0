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
                                                 HasSubstr("these recordings don't tell which"),
                                                 HasSubstr("To settle it, make the 4 recordings")));
}

TEST(FirstParagraph, NamesWhatIsSureApartFromWhatIsOpen) {
  const std::string text = paragraph_of(
      diagnosis_of(Verdict::kAmbiguous, {cause("delay", {"sensor_lag"}), cause("coulomb"), cause("backlash")}));
  const std::size_t sure = text.find("Sure: this joint has dry friction; and play in the gear."),
                    open = text.find("Open: it has a delay between command and motion or a position reading");
  ASSERT_NE(sure, std::string::npos) << text;
  ASSERT_NE(open, std::string::npos) << text;
  EXPECT_LT(sure, open);
}

Cause cause_of(const std::string& effect, const std::string& parameter, evidence::Interval value) {
  Cause made = cause(effect);
  made.parameters = {{parameter, value, ""}};
  return made;
}

TEST(FirstParagraph, SaysHowMuchInUnitsOfAWorkshop) {
  Diagnosis joint = diagnosis_of(Verdict::kFound, {});
  joint.before.actuator.friction.coulomb_Nm = 0.5;
  joint.before.actuator.friction.viscous_Nm_s_per_rad = 0.2;
  const auto said = [&](const std::string& effect, const std::string& parameter, evidence::Interval value) {
    joint.causes = {cause_of(effect, parameter, value)};
    return paragraph_of(joint);
  };
  EXPECT_THAT(said("backlash", "transmission.backlash_rad", {0.0087, 0.007, 0.0105}),
              HasSubstr("play in the gear (0.5 degrees, between 0.4 and 0.6)"));
  EXPECT_THAT(said("coulomb", "friction.coulomb_Nm", {0.67, 0.6, 0.7}),
              HasSubstr("dry friction (0.67 Nm, between 0.6 and 0.7; the simulation has 0.5)"));
  EXPECT_THAT(said("viscous", "friction.viscous_Nm_s_per_rad", {0.3, 0.28, 0.32}),
              HasSubstr("friction that grows with speed (1.5 times what the simulation has)"));
  EXPECT_THAT(said("gain", "drive.torque_scale", {0.78, 0.7, 0.86}), HasSubstr("(-22 %, between -30 and -14)"));
  EXPECT_THAT(said("gain", "drive.torque_scale", {1.25, 1.25, 1.25}), HasSubstr("(+25 %)"));
  EXPECT_THAT(said("gain", "sensor.angle_scale", {1.09, 1.09, 1.09}), HasSubstr("(+9 % in its readings)"));
  EXPECT_THAT(said("rate_limit", "command.rate_limit_rad_s", {2.0, 2.0, 2.0}), HasSubstr("(at most 115 degrees/s)"));
  EXPECT_THAT(said("load_friction", "friction.load_driving", {0.13, 0.13, 0.13}),
              HasSubstr("(13 % of the torque that it carries)"));
  EXPECT_THAT(said("delay", "command.delay_s", {0.012, 0.01, 0.014}), HasSubstr("(12 ms, between 10 and 14)"));
  EXPECT_THAT(said("thermal_drift", "thermal.friction_per_K", {-0.01, -0.02, -0.005}),
              HasSubstr("its temperature. Its simulation"))
      << "no workshop has a unit for it";
  for (const auto& parameter : model::actuator_parameters())
    EXPECT_THAT(said("coulomb", std::string(parameter.name), {0.0, 0.0, 0.0}),
                testing::Not(testing::ContainsRegex("nan|inf")))
        << parameter.name;
}

TEST(FirstParagraph, OfANumberThatIsSureOnlyBesideOthersSaysHowMuchItIsAtMost) {
  Diagnosis joint = diagnosis_of(Verdict::kFound, {});
  joint.before.actuator.friction.coulomb_Nm = 0.5;
  const auto said = [&](const std::string& effect, const std::string& parameter, evidence::Interval value) {
    joint.causes = {cause_of(effect, parameter, value)};
    return paragraph_of(joint);
  };
  EXPECT_THAT(said("eccentricity", "sensor.eccentricity_rad", {0.0925, -0.068, 0.0995}),
              HasSubstr("(5.3 degrees, at most 5.7)"));
  EXPECT_THAT(said("gain", "drive.torque_scale", {0.78, 0.7, 1.06}), HasSubstr("(-22 %, at most -30)"));
  EXPECT_THAT(said("coulomb", "friction.coulomb_Nm", {0.67, 0.4, 0.7}),
              HasSubstr("(0.67 Nm, at most 0.7; the simulation has 0.5)"));
}

TEST(FirstParagraph, OfANumberThatMayBeNextToNothingSaysHowMuchItIsAtMost) {
  const auto said = [](double low) {
    return paragraph_of(
        diagnosis_of(Verdict::kFound, {cause_of("load_friction", "friction.load_driving", {0.24, low, 0.48})}));
  };
  EXPECT_THAT(said(0.0), HasSubstr("(24 % of the torque that it carries, at most 48)"));
  EXPECT_THAT(said(0.005), HasSubstr("(24 % of the torque that it carries, at most 48)"));
  EXPECT_THAT(said(0.05), HasSubstr("(24 % of the torque that it carries, between 5 and 48)"));
}

TEST(FirstParagraph, NamesTheFormWhereTheRecordingsTellIt) {
  Cause gain = cause("gain");
  gain.form = "saturation";
  EXPECT_THAT(
      paragraph_of(diagnosis_of(Verdict::kFound, {gain})),
      testing::AllOf(HasSubstr("a motor whose torque grows less and less with its current"),
                     HasSubstr("Hold one weight after another"), HasSubstr("Where the robot needs most torque")));
  gain.form_or_instead = {"torque"};
  EXPECT_THAT(paragraph_of(diagnosis_of(Verdict::kFound, {gain})),
              HasSubstr("a drive that is stronger or weaker than its number says"));
}

TEST(FirstParagraph, SaysMillimetresAndNewtonsOfALinearAxis) {
  bench::Bench axis;
  axis.rig = bench::Rig::kLinear;
  const auto said = [&](const std::string& parameter, double value) {
    return first_paragraph(axis,
                           diagnosis_of(Verdict::kFound, {cause_of("backlash", parameter, {value, value, value})}));
  };
  EXPECT_THAT(said("transmission.backlash_rad", 0.0002), HasSubstr("(0.2 mm)"));
  EXPECT_THAT(said("ripple.offset_Nm", 3.2), HasSubstr("(3.2 N)"));
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
  faulty.data.handling = data_faults::Handling::kKeep;
  ASSERT_TRUE(faulty.data.uncorrected());
  EXPECT_THAT(paragraph_of(faulty), testing::AllOf(HasSubstr("don't trust it"), HasSubstr("repair the recordings"),
                                                   Not(HasSubstr("sure")), Not(HasSubstr("stronger or weaker"))));
}

TEST(FirstParagraph, SaysThatTheRecordingsWereCorrected) {
  Diagnosis corrected = diagnosis_of(Verdict::kFound, {cause("gain")});
  corrected.data.faults.push_back({.kind = data_faults::Kind::kUnit, .where = "column q_cmd_rad", .correction = ""});
  corrected.data.corrected = {0};
  EXPECT_THAT(paragraph_of(corrected),
              testing::AllOf(HasSubstr("mend them"), HasSubstr("was computed from corrected recordings"),
                             HasSubstr("stronger or weaker")));
}

TEST(FirstParagraph, OfReadingsThatStoodStillSaysWhatToCheck) {
  Diagnosis joint = diagnosis_of(Verdict::kNone, {});
  joint.data.faults.push_back(
      {.kind = data_faults::Kind::kFrozenReadings, .where = "column q_rad of all runs", .correction = ""});
  joint.data.readings_left_out = {0};
  EXPECT_THAT(paragraph_of(joint),
              testing::AllOf(HasSubstr("check what else is on its bus"), HasSubstr("These readings were left out"),
                             HasSubstr("nothing else to do")));
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
      for (const effects::Form& form : effect.forms) {
        Cause of_form = cause(effect.name);
        of_form.form = form.name;
        const bool any = verdict != Verdict::kNone;
        const std::string text = paragraph_of(diagnosis_of(verdict, any ? std::vector{of_form} : std::vector<Cause>{}));
        for (const char* term : {"residual", "rollout", "mrad", "fold", "interval", "linear", "excitation", "coulomb",
                                 "stribeck", "backlash", "hysteresis", "parameter", "_"})
          EXPECT_THAT(text, Not(HasSubstr(term))) << effect.name << ' ' << form.name;
      }
    }
  }
}

TEST(Workshop, EveryFormOfTheCatalogueHasACheck) {
  for (const effects::Effect& effect : effects::catalogue()) {
    for (const effects::Form& form : effect.forms) {
      const effects::WorkshopWords words = effects::workshop_words(effect.name, form.name);
      EXPECT_NE(words.what, effect.title) << effect.name << ' ' << form.name;
      EXPECT_THAT(words.check, testing::ContainsRegex("[.?]$")) << effect.name << ' ' << form.name;
      EXPECT_THAT(words.cost, testing::ContainsRegex("[.]$")) << effect.name << ' ' << form.name;
    }
  }
}

}  // namespace
}  // namespace pmg::diagnosis_page
