// What the page of a diagnosis promises to its readers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "diagnosis/random_bench.hpp"
#include "diagnosis_page/diagnosis_page.hpp"
#include "diagnosis_page/effect_tables.hpp"
#include "effects/catalogue.hpp"

namespace pmg::diagnosis_page {
namespace {

using diagnosis::Cause;
using diagnosis::DiagnosedRuns;
using diagnosis::Diagnosis;
using diagnosis::LookedAt;
using evidence::Agreement;
using evidence::Signature;
using testing::HasSubstr;
using testing::Not;

std::vector<calib::SingleJoint> joints(const test::RandomBench& made, std::size_t from, std::size_t to) {
  std::vector<calib::SingleJoint> found;
  for (std::size_t i = from; i < to; ++i) found.emplace_back(made.bench, made.runs[i], 0.001);
  return found;
}

/// A pendulum whose simulation had no Coulomb friction; eight runs fitted, four held out.
struct Made {
  test::RandomBench of = test::random_bench(1);
  Diagnosis diagnosis;
  DiagnosedRuns runs;

  Made() {
    runs.fitted = joints(of, 0, 8);
    runs.scored = joints(of, 8, 12);
    diagnosis.before = diagnosis.after = of.truth;
    diagnosis.before.actuator.friction.coulomb_Nm = 0.0;
    diagnosis.verdict = evidence::Verdict::kFound;
    diagnosis.held_out = true;
    diagnosis.noise_floor = {0.001, 0.0012, false, "from the sensor's own noise"};
    Cause cause;
    cause.effect = "coulomb";
    cause.parameters = {{"friction.coulomb_Nm", {0.2, 0.1, 0.3}, "Nm"}};
    cause.evidence = {"wins <all> folds"};
    diagnosis.causes = {cause};
  }
  std::string html() const { return page_of(of.bench, diagnosis, runs).html(); }
};

std::string without_scripts(std::string html) {
  for (std::size_t at = html.find("<script"); at != std::string::npos; at = html.find("<script"))
    html.erase(at, html.find("</script>", at) + 9 - at);
  return html;
}

/// From this heading to the next one; "" if there is none.
std::string section(const std::string& html, const std::string& heading) {
  const std::size_t at = html.find(">" + heading + "</h2>");
  return at == std::string::npos ? "" : html.substr(at, html.find("<h2", at) - at);
}

TEST(DiagnosisPage, ShowsCausesRivalsReasonsAndWhatToRecord) {
  Made made;
  made.diagnosis.verdict = evidence::Verdict::kAmbiguous;
  made.diagnosis.causes.front().or_instead = {"dead_band"};
  made.diagnosis.causes.push_back(made.diagnosis.causes.front());
  made.diagnosis.causes.back().effect = "delay";  // with the same rival
  made.diagnosis.rejected = {{"backlash", "gains nothing", LookedAt::kFit}};
  diagnosis::NextExcitation next;
  next.text = "record slow steps";
  diagnosis::NextRun& run = next.runs.emplace_back();
  run.shape = "slow steps";
  run.t_s = {0.0, 1.0, 2.0};
  run.q_cmd_rad = {0.0, 0.5, 0.0};
  made.diagnosis.next_excitation = next;
  made.runs.checks = evidence::signatures(made.of.bench, made.of.runs);
  const std::string html = made.html();
  for (const char* text : {"Coulomb friction or dead band", "record slow steps", "gains nothing", "friction.coulomb_Nm",
                           "wins &lt;all&gt; folds", "against velocity", "noise floor", "balance of torques"}) {
    EXPECT_THAT(html, HasSubstr(text));
  }
  EXPECT_THAT(html, Not(HasSubstr("nan")));
  const std::string checks = section(html, "What to check");
  EXPECT_NE(checks.find("<td>dead band"), std::string::npos);
  EXPECT_EQ(checks.find("<td>dead band"), checks.rfind("<td>dead band")) << "once";
}

// 1.6 mrad called small, above a noise floor of 0.3, says nothing without what it is small beside.
TEST(DiagnosisPage, AnIntegratorsErrorStandsBesideWhatItIsSmallBeside) {
  Made made;
  made.diagnosis.held_out_before = {0.00473, 0.004, 0.0055};
  made.diagnosis.step.error.rms_rad = 0.00163;
  EXPECT_THAT(made.html(), HasSubstr("With the model before, which misses the readings by 4.73 mrad on average, the "
                                     "integrator&#39;s error is 1.63 mrad rms; with the causes it was not measured."));
}

TEST(DiagnosisPage, CallsOnlyThoseCausesOpenThatHaveARival) {
  Made made;
  made.diagnosis.verdict = evidence::Verdict::kAmbiguous;
  made.diagnosis.causes.push_back(made.diagnosis.causes.front());
  made.diagnosis.causes.back().effect = "delay";
  made.diagnosis.causes.back().or_instead = {"hold"};
  made.diagnosis.causes.front().or_instead.clear();
  made.diagnosis.causes.front().held_out_error_before = 0.0074;
  made.diagnosis.causes.back().held_out_error_before = 0.0012;
  const std::string text = verdict_text(made.of.bench, made.diagnosis, made.runs);
  EXPECT_THAT(text, testing::StartsWith("Found: " + effects::title("coulomb") +
                                        " (7.4 mrad without it). Open, as these recordings don't tell which: " +
                                        effects::title("delay") + " or " + effects::title("hold") +
                                        " (1.2 mrad without it). Mean absolute error"));
}

TEST(DiagnosisPage, NoModelIsNearerToTheNoiseThanTheNoise) {
  Made made;
  made.diagnosis.verdict = evidence::Verdict::kFound;
  made.diagnosis.noise_floor.mean_absolute_rad = 0.001;
  for (const auto& [share, said] : {std::pair{2.88, ": 100 % of the way"}, {-0.27, ": 0 % of the way"}}) {
    made.diagnosis.share_of_way_to_floor = share;
    EXPECT_THAT(verdict_text(made.of.bench, made.diagnosis, made.runs), HasSubstr(said));
  }
}

TEST(DiagnosisPage, ShowsTheValueOfALevelOnce) {
  Made made;
  assembly::Variation& one = made.diagnosis.assemblies.varies.emplace_back();
  one.parameter = "friction.coulomb_Nm";
  one.unit = "Nm";
  one.columns = {"arm"};
  one.levels = {{.level = "red", .runs = 3, .value = {0.3217, 0.3, 0.34}}};
  const std::string html = made.html(), value = "0.322 (0.3 to 0.34) Nm";
  EXPECT_THAT(section(html, "What differs from assembly to assembly"), HasSubstr("<td>" + value));
  EXPECT_EQ(html.find(value), html.rfind(value));
  EXPECT_THAT(assembly::sentence(one), HasSubstr("(red) " + value)) << "where there is no table";
}

TEST(DiagnosisPage, MainPicturesAndTheirLegendsNeedNoScript) {
  const std::string html = without_scripts(Made().html());
  const std::string pictures = section(html, "Measured and simulated");
  EXPECT_THAT(pictures, HasSubstr("a usual run"));
  const std::string svg = pictures.substr(0, pictures.find("</svg>"));
  for (const char* name : {"command", "measured", "simulated before", "simulated after"})
    EXPECT_THAT(svg, HasSubstr(std::string(">") + name + "</text>"));
  EXPECT_THAT(svg, HasSubstr("class=\"line\" d=\"M"));
}

TEST(DiagnosisPage, ShadesWhereTheDriveIsOffAndSaysSo) {
  Made made;
  made.runs.fitted = joints(made.of, 3, 4);  // ends in a free swing
  made.runs.scored.clear();
  made.diagnosis.held_out = false;
  const std::string pictures = section(made.html(), "Measured and simulated");
  EXPECT_THAT(pictures, HasSubstr("class=\"band\""));
  EXPECT_THAT(pictures, HasSubstr(">drive off</text>"));
}

TEST(DiagnosisPage, ShowsTheRunThatTheFitMissesMost) {
  for (const std::size_t bad : {2U, 5U}) {
    Made made;
    for (double& q_rad : made.of.runs[bad].recording.q_rad) q_rad += 0.3;
    made.runs.fitted = joints(made.of, 0, 8);
    const std::string file = made.of.runs[bad].file;
    const std::string pictures = section(made.html(), "Measured and simulated");
    EXPECT_TRUE(std::regex_search(pictures, std::regex("worst-fitted run of the fit: position [^<]*" + file))) << file;
    EXPECT_LT(pictures.find("<td>" + file), pictures.find("<td>" + made.of.runs[0].file)) << "first of the list";
  }
}

TEST(DiagnosisPage, KeepsWhatWasRuledOutApartFromWhatWasNotLookedAt) {
  Made made;
  made.diagnosis.rejected = {{"backlash", "reason one", LookedAt::kFit},
                             {"quantisation", "reason two", LookedAt::kRecordings},
                             {"delay", "reason three", LookedAt::kLinearised},
                             {"cogging", "reason four", LookedAt::kNot}};
  const std::string html = made.html();
  const std::string ruled_out = section(html, "Ruled out"), open = section(html, "Not ruled out");
  EXPECT_THAT(ruled_out, testing::AllOf(HasSubstr("reason one"), HasSubstr("reason two"),
                                        Not(HasSubstr("reason three")), Not(HasSubstr("reason four"))));
  EXPECT_THAT(open, testing::AllOf(HasSubstr("reason three"), HasSubstr("reason four"), Not(HasSubstr("reason one"))));
  EXPECT_THAT(open, HasSubstr(effects::effect("cogging").needs));
}

TEST(DiagnosisPage, NamesOddRunsAndFaultsOfTheDataBeforeTheFirstSection) {
  Made made;
  made.diagnosis.noise_floor.odd_runs = {{.run = "stalled.csv", .why = "stands still", .left_out = true}};
  made.diagnosis.data.faults.push_back(
      {.kind = data_faults::Kind::kSign, .where = "column q_rad", .correction = "turn its sign"});
  const std::string html = made.html();
  const std::string first = html.substr(0, html.find("<h2"));
  EXPECT_THAT(first, testing::AllOf(HasSubstr("stalled.csv"), HasSubstr("turn its sign"), HasSubstr("verdict bad")));
}

Signature some_check(const std::string& effect, Agreement agreement) {
  Signature check;
  check.effect = effect;
  check.check = "some check";
  check.agreement = agreement;
  return check;
}

/// All that a check can say, all that the result can be, and all that the same check can say of the simulated joint.
TEST(DiagnosisPage, NothingIsShownAndNoCauseWithoutASentenceThatSaysWhy) {
  enum class Role { kCause, kRival, kSame, kFitted, kReadOff, kLinearised, kNot, kAbsent };
  for (const Role role : {Role::kCause, Role::kRival, Role::kSame, Role::kFitted, Role::kReadOff, Role::kLinearised,
                          Role::kNot, Role::kAbsent}) {
    for (const Agreement check : {Agreement::kAgrees, Agreement::kDisagrees}) {
      for (const Agreement simulated : {Agreement::kAgrees, Agreement::kDisagrees, Agreement::kCannotTell}) {
        Diagnosis diagnosis;
        const std::string effect = "backlash";
        if (role == Role::kCause || role == Role::kRival || role == Role::kSame) {
          Cause& cause = diagnosis.causes.emplace_back();
          cause.effect = role == Role::kCause ? effect : "delay";
          if (role == Role::kRival) cause.or_instead = {effect};
          if (role == Role::kSame) cause.same_here = {effect};
        } else if (role != Role::kAbsent) {
          diagnosis.rejected = {{effect, "its reason",
                                 role == Role::kFitted       ? LookedAt::kFit
                                 : role == Role::kReadOff    ? LookedAt::kRecordings
                                 : role == Role::kLinearised ? LookedAt::kLinearised
                                                             : LookedAt::kNot}};
        }
        DiagnosedRuns runs;
        runs.checks = {some_check(effect, check)};
        runs.expected = {some_check(effect, simulated)};
        const std::string said = beside_the_result(runs.checks.front(), diagnosis, runs);
        const bool named = role == Role::kCause || role == Role::kRival || role == Role::kSame;
        SCOPED_TRACE(said);
        EXPECT_THAT(said, testing::ContainsRegex(named                         ? check == Agreement::kAgrees
                                                                                     ? "named as a cause|instead of delay|the same as delay"
                                                                                     : ": (this check|another check|the fit)"
                                                 : check == Agreement::kAgrees ? "^no cause: |^not settled: "
                                                                               : "^no sign of it, as in the result$"));
        if (role == Role::kFitted && check == Agreement::kAgrees && simulated != Agreement::kAgrees) {
          EXPECT_THAT(said, HasSubstr("its reason"));
        }
        if (named) continue;
        Made made;  // and both tables have the sentence
        made.diagnosis.causes = diagnosis.causes;
        made.diagnosis.rejected = diagnosis.rejected;
        made.runs.checks = runs.checks;
        made.runs.expected = runs.expected;
        made.runs.fitted = joints(made.of, 0, 1);
        made.runs.scored.clear();
        const std::string html = made.html();
        if (role != Role::kAbsent) {
          EXPECT_THAT(section(html, "Ruled out") + section(html, "Not ruled out"), HasSubstr(said));
        }
        EXPECT_THAT(section(html, "Checks without a simulation"), HasSubstr(said));
      }
    }
  }
}

TEST(DiagnosisPage, WhatTheSimulationHasAlreadyIsNoContradiction) {
  Diagnosis diagnosis;
  diagnosis.before.actuator.friction.coulomb_Nm = 0.4;
  diagnosis.rejected = {{"coulomb", "its gain is small", LookedAt::kFit}};
  const Signature check = some_check("coulomb", Agreement::kAgrees);
  DiagnosedRuns runs;
  runs.checks = {check};
  EXPECT_THAT(beside_the_result(check, diagnosis, runs), HasSubstr("the simulation has this effect already"));
}

}  // namespace
}  // namespace pmg::diagnosis_page
