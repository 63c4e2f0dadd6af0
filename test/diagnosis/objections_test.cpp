// Rules by which an effect becomes a cause or doesn't: model-free checks, and the objections to a fit. Each test fails
// where its rule is disabled.
#include <gmock/gmock.h>

#include <algorithm>
#include <functional>

#include "calib/unknown.hpp"
#include "diagnosis/direct_evidence.hpp"
#include "diagnosis/effect_search.hpp"
#include "diagnosis/rules_fixture.hpp"

namespace pmg::diagnosis {
namespace {

TEST_F(Rules, ACheckThatIsBlindVetoesNothing) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  truth.actuator.friction.load_driving = truth.actuator.friction.load_backdriving = 0.3;
  const bench::Bench bench = written(test::record(bench_, truth, 8, 2e-4));
  DiagnoseOptions options = given_healthy();
  options.decide_by.signatures.friction_share = 10.0;  // no strength is large enough for a check of friction,
  options.decide_by.signatures.sure_deviations = 1e9;  // and none is sure: all disagree
  DiagnosedRuns runs;
  const Diagnosis found = diagnose(bench, options, &runs);
  const auto blind = std::find_if(runs.checks.begin(), runs.checks.end(),
                                  [](const evidence::Signature& check) { return check.effect == "load_friction"; });
  ASSERT_EQ(blind->agreement, evidence::Agreement::kDisagrees);
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_EQ(found.causes.front().effect, "load_friction");
}

TEST_F(Rules, WhatIsEvidentWithoutAModelIsFittedWhateverALinearLookSays) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  truth.actuator.friction.load_driving = truth.actuator.friction.load_backdriving = 0.3;
  const bench::Bench bench = written(test::record(bench_, truth, 8, 2e-4));
  DiagnoseOptions options = given_healthy();
  options.decide_by.fitted_effects = 0;  // a linear look lets nothing pass
  const Diagnosis found = diagnose(bench, options);
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_EQ(found.causes.front().effect, "load_friction");
}

TEST_F(Rules, AFitOfWhatIsEvidentBeginsWithTheMeasuredStrength) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  truth.actuator.friction.load_driving = truth.actuator.friction.load_backdriving = 0.2;
  const bench::Bench bench = written(test::record(bench_, truth, 8, 2e-4));
  DiagnoseOptions options = given_healthy();
  options.decide_by.fitted_effects = 0;
  options.decide_by.few_iterations = 0;
  options.decide_by.many_iterations = 0;
  const Diagnosis found = diagnose(bench, options);
  ASSERT_FALSE(found.causes.empty());
  ASSERT_EQ(found.causes.front().effect, "load_friction");
  // The catalogue's own starts have 0.1 or 0.3, or 0 on one side.
  for (const evidence::ParameterEstimate& p : found.causes.front().parameters) EXPECT_NEAR(p.estimate.value, 0.2, 0.06);
}

evidence::Signature check_of(const std::string& effect, evidence::Agreement agreement, double value = 0.0) {
  evidence::Signature check;
  check.effect = effect;
  check.check = "some check";
  check.agreement = agreement;
  check.value = {value, value, value};
  return check;
}

TEST(DirectEvidence, SortsWhatChecksSayByWhatMayBeConcludedFromIt) {
  using enum evidence::Agreement;
  const std::vector<evidence::Signature> checks = {
      check_of("backlash", kDisagrees),  // doubted
      check_of("delay", kDisagrees),
      check_of("delay", kAgrees),       // evident: one check shows it
      check_of("load", kDisagrees),     // a wrong mass changes inertia and weight alike
      check_of("coulomb", kDisagrees),  // in the base model
      check_of("thermal_drift", kAgrees, 0.01),
      check_of("quantisation", kAgrees, 0.02),
      check_of("cogging", kCannotTell)};
  model::ActuatorParameters base = healthy_actuator();
  const DirectEvidence found = direct_evidence(checks, base, 1e-3, 1.0, {});
  EXPECT_EQ(found.doubted, std::vector<std::string>{"backlash"});
  EXPECT_EQ(found.shown, std::vector<std::string>{"thermal_drift"});
  EXPECT_TRUE(found.evident.contains("delay") && found.evident.contains("thermal_drift"));
  EXPECT_EQ(found.evident.size(), 2U);
  ASSERT_EQ(found.measured.size(), 1U);
  EXPECT_EQ(found.measured.front().value.value, 0.02);
  EXPECT_TRUE(direct_evidence(checks, base, 1.0, 1.0, {}).measured.empty()) << "fine beside such noise";
  base.sensor.quantum_rad = 0.02;
  EXPECT_TRUE(direct_evidence(checks, base, 1e-3, 1.0, {}).measured.empty()) << "no coarser than what is known";
}

/// A trial of load-dependent friction whose folds are all for it, on runs of a joint without it.
class Veto : public Rules {
 protected:
  std::string objection(const std::vector<std::string>& doubted, const std::function<void(Trial&)>& change = {},
                        const std::function<void(SearchLimits&)>& limit = {},
                        const std::vector<std::string>& shown = {}) const {
    calib::JointModel truth;
    truth.actuator = healthy_actuator();
    const effects::NestedFit fit(test::record(bench_, truth, 8, 2e-4), 1);
    BaseModel base;
    base.model = truth;
    base.scale = effects::scale_of(bench_, fit.runs(), truth);
    DirectEvidence evidence;
    evidence.doubted = doubted;
    evidence.shown = shown;
    SearchLimits limits{
        .noise_squares = 4e-8, .healthy_squares = 0.0, .of_noise = 0.0, .of_beginning = 0.0, .of_rest = 0.0};
    if (limit) limit(limits);
    JointDiagnosisOptions options;
    options.signatures.disagrees_share = 2.0;  // these few runs are enough to disagree
    const EffectSearch search(bench_, fit, base, limits, evidence, options, {});
    Trial trial{"load_friction", {}, 1.0, search.base()};
    trial.comparison.gain = trial.comparison.log_gain = trial.comparison.folds_won = 1.0;
    trial.comparison.deviations = 100.0;
    trial.extension.effects = {"load_friction"};
    for (const char* name : {"friction.load_driving", "friction.load_backdriving"})
      calib::set(trial.extension.fitted.model, name, 0.3);
    if (change) change(trial);
    return search.objection(trial);
  }
};

TEST_F(Veto, OfACheckThatWouldSeeTheStrengthStands) {
  EXPECT_EQ(objection({}), "") << "no check is in doubt";
  EXPECT_NE(objection({"load_friction"}).find("ruled out"), std::string::npos);
}

TEST_F(Veto, OfEachRuleStandsAlone) {
  using testing::HasSubstr;
  EXPECT_THAT(objection({}, [](Trial& t) { t.comparison.gain = 0.0; }), HasSubstr("no better"));
  EXPECT_THAT(objection({}, [](Trial& t) { t.share_of_rest = 0.0; }), HasSubstr("in order leave"));
  EXPECT_THAT(objection({}, [](Trial& t) { t.comparison.deviations = 1.0; }), HasSubstr("of its deviations"));
  EXPECT_THAT(objection({}, [](Trial& t) { t.comparison.folds_won = 0.3; }), HasSubstr("of the folds"));
  const auto small = [](Trial& t) { t.comparison.gain = 1e-9, t.share_of_rest = 0.5; };
  EXPECT_EQ(objection({}, small), "");
  EXPECT_THAT(objection({}, small, [](SearchLimits& l) { l.of_noise = 0.5; }), HasSubstr("beside the noise"));
  EXPECT_THAT(objection({}, small,
                        [](SearchLimits& l) {
                          l.noise_squares = 0.0;  // what was wrong at the beginning is the noise
                          l.of_beginning = 0.5;
                        }),
              HasSubstr("against the initial residual"));
  EXPECT_THAT(objection(
                  {}, [](Trial& t) { t.share_of_rest = 0.1; }, [](SearchLimits& l) { l.of_rest = 0.2; }),
              HasSubstr("10 % of what is left"));
}

// Half-second blocks hardly detect it, so a gain in ln error will do; the folds still decide.
TEST_F(Veto, OfAnEffectThatACheckShowsNeedsFoldsThatAreWorseWithIt) {
  using testing::HasSubstr;
  const auto of_shown = [&](const std::function<void(Trial&)>& change) {
    return objection({}, change, {}, {"load_friction"});
  };
  EXPECT_EQ(of_shown([](Trial& t) { t.comparison.deviations = 0.0; }), "") << "what a check shows needs no deviations";
  EXPECT_THAT(of_shown([](Trial& t) { t.comparison.log_gain = -0.1; }), HasSubstr("no better"));
  EXPECT_THAT(of_shown([](Trial& t) { t.comparison.folds_won = 0.3; }), HasSubstr("no better"));
}

TEST_F(Rules, ACheckThatSeesAnotherSizeDoesNotAgree) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  truth.actuator.sensor.zero_offset_rad = 0.1;
  const bench::Bench bench = written(test::record(bench_, truth, 8, 2e-4));
  DiagnoseOptions options = given_healthy();
  const auto evidence_of_zero_offset = [&] {
    std::string all;
    for (const Cause& cause : diagnose(bench, options).causes) {
      if (cause.effect != "zero_offset") continue;
      for (const std::string& line : cause.evidence) all += line + "\n";
    }
    return all;
  };
  EXPECT_NE(evidence_of_zero_offset().find("balance of torques agrees"), std::string::npos);
  options.decide_by.signatures.power.size_deviations = -1.0;  // the slightest difference is one in size
  options.decide_by.signatures.power.size_share = -1.0;
  EXPECT_NE(evidence_of_zero_offset().find("disagrees in size"), std::string::npos);
}

}  // namespace
}  // namespace pmg::diagnosis
