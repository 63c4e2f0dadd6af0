// Rules of the diagnosis that decide verdicts: each test fails where its rule is disabled.
#include <gtest/gtest.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "calib/fit_problem.hpp"
#include "calib/synthetic_bench.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/diagnosis_json.hpp"
#include "diagnosis/effect_search.hpp"
#include "diagnosis/report.hpp"

namespace pmg::diagnosis {
namespace {

namespace fs = std::filesystem;

model::ActuatorParameters healthy_actuator() {
  model::ActuatorParameters joint;
  joint.transmission.armature_kg_m2 = 0.01;
  joint.friction.viscous_Nm_s_per_rad = 0.1;
  joint.friction.coulomb_Nm = 0.05;
  return joint;
}

class Rules : public testing::Test {
 protected:
  bench::Bench written(const std::vector<calib::SingleJoint>& joints) const {
    test::write_bench(folder_, joints);
    return bench::read_bench(folder_);
  }
  static DiagnoseOptions given_healthy() {
    DiagnoseOptions options;
    options.model = healthy_actuator();
    return options;
  }
  void TearDown() override { fs::remove_all(folder_); }

  const fs::path folder_ = fs::temp_directory_path() / ("pmg_rules_" + std::to_string(getpid()));
  const bench::Bench bench_ = test::pd_bench(true);
};

/// Three repeats of four conditions of a healthy joint; one run stalls after 0.5 s.
std::vector<calib::SingleJoint> repeats_with_one_stalled(const bench::Bench& bench) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  std::vector<calib::SingleJoint> joints;
  for (int repeat = 0; repeat < 3; ++repeat) {
    for (const calib::SingleJoint& joint : test::record(bench, truth, 4, 5e-4, 1 + static_cast<unsigned>(repeat))) {
      bench::BenchRun run = joint.run();
      run.repeat = repeat;
      run.file = fmt::format("r{}_{}", repeat, run.file);
      std::vector<double>& q_rad = run.recording.q_rad;
      if (run.file == "r1_run2.csv") std::fill(q_rad.begin() + 50, q_rad.end(), q_rad[49]);
      joints.emplace_back(bench, run, joint.step_s());
    }
  }
  return joints;
}

TEST_F(Rules, AStalledRunIsNamedFirstAndChangesNeitherVerdictNorFloor) {
  const bench::Bench bench = written(repeats_with_one_stalled(bench_));
  DiagnosedRuns runs;
  const Diagnosis found = diagnose(bench, given_healthy(), &runs);
  EXPECT_EQ(found.verdict, evidence::Verdict::kNone);
  EXPECT_TRUE(found.causes.empty());
  EXPECT_EQ(runs.fitted.size(), 11U) << "the stalled one is left out";
  EXPECT_NEAR(found.noise_floor.rms_rad, 5e-4, 0.1 * 5e-4);
  const nlohmann::ordered_json json = diagnosis_json(found);
  ASSERT_EQ(json.at("odd_runs").size(), 1U);
  const auto& odd = json.at("odd_runs").at(0);
  EXPECT_EQ(odd.at("run"), "r1_run2.csv");
  EXPECT_EQ(odd.at("left_out"), true);
  EXPECT_GT(odd.at("deviation"), 0.1);
  EXPECT_FALSE(odd.at("why").get<std::string>().empty());
  const std::string html = diagnosis_report(bench, found, runs, 1).html();
  EXPECT_LT(html.find("r1_run2.csv"), html.find("<h2")) << "before the first section";
}

TEST_F(Rules, AJointIsHealthyWhateverTheFirstStepOfItsSimulation) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  const bench::Bench bench = written(test::record(bench_, truth, 4, 2e-5, 1, 1e-4));  // a real joint has no step
  const Diagnosis found = diagnose(bench, given_healthy());
  EXPECT_EQ(found.verdict, evidence::Verdict::kNone);
  EXPECT_LT(found.step.error.step_s, found.step.first.step_s);
  EXPECT_LT(found.step.error.rms_rad, found.step.first.rms_rad);
  const nlohmann::ordered_json json = diagnosis_json(found);
  for (const char* key : {"step_s", "error", "error_after", "first_step_s", "first_error", "why", "error_of_runs"})
    EXPECT_TRUE(json.at("integration").contains(key)) << key;
}

TEST_F(Rules, TheErrorOfAStepThatIsGivenCountsAsNoise) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  const bench::Bench bench = written(test::record(bench_, truth, 4, 2e-5, 1, 1e-4));
  DiagnoseOptions options = given_healthy();
  options.step_s = 4e-3;
  const Diagnosis found = diagnose(bench, options);
  EXPECT_EQ(found.verdict, evidence::Verdict::kNone);
  EXPECT_EQ(found.step.limit, calib::StepLimit::kGiven);
  EXPECT_GE(found.noise_floor.rms_rad, found.step.error.rms_rad);
}

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
  options.decide_by.fitted_effects = 0.0;  // a linear look lets nothing pass
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
  options.decide_by.fitted_effects = options.decide_by.few_iterations = options.decide_by.many_iterations = 0.0;
  const Diagnosis found = diagnose(bench, options);
  ASSERT_FALSE(found.causes.empty());
  ASSERT_EQ(found.causes.front().effect, "load_friction");
  // The catalogue's own starts have 0.1 or 0.3, or 0 on one side.
  for (const evidence::ParameterEstimate& p : found.causes.front().parameters) EXPECT_NEAR(p.estimate.value, 0.2, 0.06);
}

TEST_F(Rules, WhatNoEffectExplainsIsUnexplained) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  std::vector<calib::SingleJoint> joints;
  for (const calib::SingleJoint& joint : test::record(bench_, truth, 4, 2e-4)) {
    bench::BenchRun run = joint.run();  // the table under the rig shakes
    for (std::size_t k = 0; k < run.recording.q_rad.size(); ++k)
      run.recording.q_rad[k] += 0.05 * std::sin(19.0 * run.recording.t_s[k] + 2.0 * run.kp);
    joints.emplace_back(bench_, run, joint.step_s());
  }
  const bench::Bench bench = written(joints);
  DiagnoseOptions options = given_healthy();
  EXPECT_EQ(diagnose(bench, options).verdict, evidence::Verdict::kUnexplained);
  options.decide_by.remains_of_noise = 1e12;
  EXPECT_NE(diagnose(bench, options).verdict, evidence::Verdict::kUnexplained);
}

TEST_F(Rules, EffectsThatTheRunsDoNotTellApartAreAmbiguous) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  truth.actuator.command.delay_s = 0.015;
  const bench::Bench bench = written(test::record(bench_, truth, 4, 2e-4));
  DiagnoseOptions options = given_healthy();
  EXPECT_EQ(diagnose(bench, options).verdict, evidence::Verdict::kFound);
  options.decide_by.apart_share = 1e12;  // no rival is so much worse
  const Diagnosis found = diagnose(bench, options);
  EXPECT_EQ(found.verdict, evidence::Verdict::kAmbiguous);
  EXPECT_FALSE(found.causes.at(0).or_instead.empty());
  EXPECT_TRUE(found.next_excitation);
}

/// A trial of load-dependent friction whose folds are all for it, on runs of a joint without it.
class Veto : public Rules {
 protected:
  std::string objection(const std::vector<std::string>& doubted) const {
    calib::JointModel truth;
    truth.actuator = healthy_actuator();
    const effects::NestedFit fit(test::record(bench_, truth, 8, 2e-4), 1);
    BaseModel base;
    base.model = truth;
    base.scale = effects::scale_of(bench_, fit.runs(), truth);
    DirectEvidence evidence;
    evidence.doubted = doubted;
    const SearchLimits limits{
        .noise_squares = 4e-8, .healthy_squares = 0.0, .of_noise = 0.0, .of_beginning = 0.0, .of_rest = 0.0};
    JointDiagnosisOptions options;
    options.signatures.disagrees_share = 2.0;  // these few runs are enough to disagree
    const EffectSearch search(bench_, fit, base, limits, evidence, options, {});
    Trial trial{"load_friction", {}, 1.0, search.base()};
    trial.comparison.gain = trial.comparison.log_gain = trial.comparison.folds_won = 1.0;
    trial.comparison.deviations = 100.0;
    trial.extension.effects = {"load_friction"};
    for (const char* name : {"friction.load_driving", "friction.load_backdriving"})
      calib::set(trial.extension.fitted.model, name, 0.3);
    return search.objection(trial);
  }
};

TEST_F(Veto, OfACheckThatWouldSeeTheStrengthStands) {
  EXPECT_EQ(objection({}), "") << "no check is in doubt";
  EXPECT_NE(objection({"load_friction"}).find("would show it without a model"), std::string::npos);
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
