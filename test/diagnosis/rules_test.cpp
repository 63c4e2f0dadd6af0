// Rules of the diagnosis that decide verdicts: each test fails where its rule is disabled.
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "diagnosis/base_model.hpp"
#include "diagnosis/diagnosis_json.hpp"
#include "diagnosis/effect_search.hpp"
#include "diagnosis/rules_fixture.hpp"
#include "effects/catalogue.hpp"
#include "evidence/thresholds.hpp"

namespace pmg::diagnosis {
namespace {

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

TEST_F(Rules, TheErrorOfAStepThatIsGivenCountsAsFarAsTheResidualMayBeMadeOfIt) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  const bench::Bench bench = written(test::record(bench_, truth, 4, 2e-5, 1, 1e-4));
  DiagnoseOptions options = given_healthy();
  options.step_s = 4e-3;
  const Diagnosis found = diagnose(bench, options);
  EXPECT_EQ(found.verdict, evidence::Verdict::kNone);
  EXPECT_EQ(found.step.limit, calib::StepLimit::kGiven);
  EXPECT_GT(found.noise_floor.rms_rad, 10.0 * 2e-5) << "more than the sensor's noise";
  // An effect beside it stays one: the floor does not grow by an error that is not in the residual.
  truth.actuator.ripple.offset_Nm = 0.2;
  const bench::Bench pushed = written(test::record(bench_, truth, 4, 2e-5, 1, 1e-4));
  const Diagnosis with_offset = diagnose(pushed, options);
  EXPECT_LE(with_offset.noise_floor.rms_rad, 1.2 * found.noise_floor.rms_rad);
  ASSERT_FALSE(with_offset.causes.empty());
  EXPECT_EQ(with_offset.causes.front().effect, "offset");
}

/// Steps of 4 ms are in place of 2 ms of the delay.
TEST_F(Rules, AnIntervalCountsTheErrorOfTheStep) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  truth.actuator.command.delay_s = 0.02;
  DiagnoseOptions options = given_healthy();
  options.step_s = 4e-3;
  const Diagnosis found = diagnose(written(test::record(bench_, truth, 4, 1e-4, 1, 1e-4)), options);
  const auto delay = std::find_if(found.causes.begin(), found.causes.end(),
                                  [](const Cause& cause) { return cause.effect == "delay"; });
  ASSERT_NE(delay, found.causes.end());
  const evidence::Interval interval = delay->parameters.front().estimate;
  EXPECT_GT(interval.value, 0.021) << "as it fits with such steps";
  EXPECT_LT(interval.low, 0.02);
}

/// A joint without any step, simulated with steps of 4 ms: these move as half a step of delay does.
class SimulatedCoarsely : public Rules {
 protected:
  /// Why the last look leaves the delay of the fit with one; "" if it stays.
  std::string why_no_delay(double delay_s, bool recordings_have_step) const {
    calib::JointModel truth;
    truth.actuator = healthy_actuator();
    truth.actuator.command.delay_s = delay_s;
    constexpr double kSensorNoise_rad = 2e-5, kForgiven_rad = 0.02;  // the search doesn't go on without the delay
    std::vector<calib::SingleJoint> runs;
    for (const calib::SingleJoint& joint : test::record(bench_, truth, 4, kSensorNoise_rad, 1, 1e-4))
      runs.emplace_back(bench_, joint.run(), 4e-3);
    const effects::NestedFit fit(runs, 1);
    const BaseModel base = base_model(bench_, given_healthy().model, fit, {}, kForgiven_rad * kForgiven_rad, 1);
    const SearchLimits limits{.noise_squares = kForgiven_rad * kForgiven_rad,
                              .healthy_squares = 0.0,
                              .of_noise = 0.0,
                              .of_beginning = 0.0,
                              .of_rest = 0.0,
                              .recordings_have_step = recordings_have_step};
    EffectSearch search(bench_, fit, base, limits, {}, {}, {});
    for (const Trial& trial : search.additions(search.base())) {
      if (trial.effect != "delay") continue;
      const bool stays = !search.settled(trial.extension).chosen.effects.empty();
      return stays || search.left_out().empty() ? "" : search.left_out().front().second;
    }
    return "it was not fitted";
  }
};

TEST_F(SimulatedCoarsely, AJointHasNoCauseThatMendsTheStep) {
  EXPECT_NE(why_no_delay(0.0, false).find("half the step"), std::string::npos);
  EXPECT_EQ(why_no_delay(0.0, true), "") << "the recordings have this step: the delay is theirs";
  EXPECT_EQ(why_no_delay(3e-3, false), "") << "half the step leaves most of its gain";
}

/// Four runs of the joint on a rig whose table shakes from this sample on.
std::vector<calib::SingleJoint> on_a_shaking_table(const bench::Bench& bench, const calib::JointModel& truth,
                                                   double by_rad = 0.05, std::size_t from = 0) {
  std::vector<calib::SingleJoint> joints;
  for (const calib::SingleJoint& joint : test::record(bench, truth, 4, 2e-4)) {
    bench::BenchRun run = joint.run();
    for (std::size_t k = from; k < run.recording.q_rad.size(); ++k)
      run.recording.q_rad[k] += by_rad * std::sin(19.0 * run.recording.t_s[k] + 2.0 * run.kp);
    joints.emplace_back(bench, run, joint.step_s());
  }
  return joints;
}

/// Chance makes some of the residual look like the error: less than half of it.
TEST_F(Rules, TheStepsErrorDoesNotCountWhereTheResidualIsNotMadeOfIt) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  const Diagnosis found = diagnose(written(on_a_shaking_table(bench_, truth)), given_healthy());
  ASSERT_GT(found.step_error_after.rms_rad, 10.0 * 2e-4) << "far above the sensor's noise";
  EXPECT_LT(found.noise_floor.rms_rad, 0.5 * found.step_error_after.rms_rad);
}

TEST_F(Rules, WhatNoEffectExplainsIsUnexplained) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  const bench::Bench bench = written(on_a_shaking_table(bench_, truth));
  DiagnoseOptions options = given_healthy();
  options.decide_by.without_cause_of_floor = 1e12;
  EXPECT_EQ(diagnose(bench, options).verdict, evidence::Verdict::kUnexplained);
  options.decide_by.remains_of_noise = 1e12;
  EXPECT_NE(diagnose(bench, options).verdict, evidence::Verdict::kUnexplained);
  options.decide_by.remains_of_noise = given_healthy().decide_by.remains_of_noise;
  options.decide_by.remains_of_beginning = 1e12;
  EXPECT_NE(diagnose(bench, options).verdict, evidence::Verdict::kUnexplained);
}

TEST_F(Rules, WhatNoEffectExplainsInFewBlocksIsUnexplainedToo) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  const bench::Bench bench = written(on_a_shaking_table(bench_, truth, 0.01, 250));
  DiagnoseOptions options = given_healthy();
  const Diagnosis found = diagnose(bench, options);
  ASSERT_TRUE(found.causes.empty());
  EXPECT_EQ(found.verdict, evidence::Verdict::kUnexplained);
  EXPECT_LT(found.after_over_noise, std::sqrt(options.decide_by.remains_of_noise)) << "usual blocks are in order";
  options.decide_by.without_cause_of_floor = 1e9;
  EXPECT_EQ(diagnose(bench, options).verdict, evidence::Verdict::kNone);
}

TEST_F(Rules, AModelThatMovesWhereTheJudgedJointRestsExplainsNothing) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  for (const bool rests : {false, true}) {
    std::vector<calib::SingleJoint> joints;
    for (const calib::SingleJoint& joint : test::record(bench_, truth, 4, 2e-4)) {
      bench::BenchRun run = joint.run();
      run.repeat = joints.size() < 2 ? 0 : 1;
      for (std::size_t k = 0; rests && run.repeat == 1 && k < run.recording.q_rad.size(); ++k)
        run.recording.q_rad[k] = k % 2 == 0 ? 1e-4 : -1e-4;
      joints.emplace_back(bench_, run, joint.step_s());
    }
    DiagnoseOptions options = given_healthy();
    options.fit = "repeat == 0", options.score = "repeat == 1";
    options.data.handling = data_faults::Handling::kKeep;
    EXPECT_EQ(diagnose(written(joints), options).verdict,
              rests ? evidence::Verdict::kUnexplained : evidence::Verdict::kNone);
    fs::remove_all(folder_);
  }
}

TEST_F(Rules, WhatDoesNotHelpTheRecordingsHeldOutIsNoCause) {
  calib::JointModel truth, pushed;
  truth.actuator = pushed.actuator = healthy_actuator();
  pushed.actuator.ripple.offset_Nm = 0.2;
  for (const bool of_all : {false, true}) {
    std::vector<calib::SingleJoint> joints = test::record(bench_, pushed, 4, 2e-4);
    for (const calib::SingleJoint& joint : test::record(bench_, of_all ? pushed : truth, 6, 2e-4)) {
      bench::BenchRun run = joint.run();
      run.repeat = 1, run.trajectory += "_more", run.file = "more_" + run.file;
      joints.emplace_back(bench_, run, joint.step_s());
    }
    DiagnoseOptions options = given_healthy();
    options.fit = "repeat == 0", options.score = "repeat == 1";
    options.data.handling = data_faults::Handling::kKeep;
    const Diagnosis found = diagnose(written(joints), options);
    const bool has_offset =
        std::ranges::any_of(found.causes, [](const Cause& cause) { return cause.effect == "offset"; });
    EXPECT_EQ(has_offset, of_all);
    fs::remove_all(folder_);
  }
}

TEST_F(Rules, UnexplainedMayHaveCausesBeside) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  truth.actuator.command.delay_s = 0.05;
  DiagnoseOptions options = given_healthy();
  options.decide_by.apart_share = 1e12;  // the cause has rivals; what no effect explains goes before
  const Diagnosis found = diagnose(written(on_a_shaking_table(bench_, truth)), options);
  EXPECT_EQ(found.verdict, evidence::Verdict::kUnexplained);
  ASSERT_FALSE(found.causes.empty());
  EXPECT_FALSE(found.causes.front().or_instead.empty());
  const bool delay =
      std::any_of(found.causes.begin(), found.causes.end(), [](const Cause& cause) { return cause.effect == "delay"; });
  EXPECT_TRUE(delay);
}

TEST_F(Rules, CausesThatLeaveMoreThanAQuarterExplainNothing) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  truth.actuator.command.delay_s = 0.02;
  const bench::Bench bench = written(on_a_shaking_table(bench_, truth));
  const auto verdict = [&](const std::string& rule) {
    DiagnoseOptions options = given_healthy();
    options.decide_by.remains_of_noise = 1e12;
    options.decide_by.fitted_effects = options.decide_by.exchanged_effects = 2.0;
    options.decide_by.fitted_pairs = 0.0;
    if (!rule.empty()) evidence::set(evidence::rows(options.decide_by), rule);
    const Diagnosis found = diagnose(bench, options);
    EXPECT_FALSE(found.causes.empty()) << rule;
    return found.verdict;
  };
  EXPECT_EQ(verdict(""), evidence::Verdict::kUnexplained);
  EXPECT_NE(verdict("causes_leave_of_noise=1e12"), evidence::Verdict::kUnexplained);
  EXPECT_NE(verdict("causes_leave_of_beginning=1e12"), evidence::Verdict::kUnexplained);
}

TEST_F(Rules, UnexplainedSaysWhatTheRestDependsOn) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  std::vector<calib::SingleJoint> joints;
  for (const calib::SingleJoint& joint : test::record(bench_, truth, 4, 2e-4)) {
    bench::BenchRun run = joint.run();
    for (double& q_rad : run.recording.q_rad)
      q_rad += q_rad > 0.2 && q_rad < 0.5 ? 0.1 : 0.0;  // a scratch on the encoder
    joints.emplace_back(bench_, run, joint.step_s());
  }
  const Diagnosis found = diagnose(written(joints), given_healthy());
  EXPECT_EQ(found.verdict, evidence::Verdict::kUnexplained);
  EXPECT_TRUE(effects::contains(found.depends_on, "position"));
}

TEST_F(Rules, EffectsThatTheRunsDoNotTellApartAreAmbiguous) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  truth.actuator.command.delay_s = 0.015;
  const bench::Bench bench = written(test::record(bench_, truth, 4, 2e-4));
  DiagnoseOptions options = given_healthy();
  EXPECT_EQ(diagnose(bench, options).verdict, evidence::Verdict::kFound);
  for (const std::string rule : {"apart_share=1e12",                   // no rival is so much worse
                                 "apart_deviations=1e12",              // nor so surely,
                                 "fewest_apart_blocks=1000000000"}) {  // nor so often
    options = given_healthy();
    evidence::set(evidence::rows(options.decide_by), rule);
    const Diagnosis found = diagnose(bench, options);
    EXPECT_EQ(found.verdict, evidence::Verdict::kAmbiguous);
    EXPECT_FALSE(found.causes.at(0).or_instead.empty());
    if (!rule.starts_with("apart_deviations")) {  // no recording parts two effects by so much
      EXPECT_TRUE(found.next_excitation);
    }
  }
}

TEST_F(Rules, EveryEffectThatIsNoCauseHasAReasonAndSaysHowItWasLookedAt) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  truth.actuator.command.delay_s = 0.015;
  const bench::Bench bench = written(test::record(bench_, truth, 4, 2e-4));
  DiagnoseOptions options = given_healthy();
  options.decide_by.fitted_effects = 2;  // the others are not fitted, unless a check shows them
  const Diagnosis found = diagnose(bench, options);
  std::map<LookedAt, int> count;
  for (const Rejected& one : found.rejected) {
    EXPECT_FALSE(one.why.empty()) << one.effect;
    EXPECT_EQ(one.looked_at == LookedAt::kLinearised, one.why.find("a quick look") != std::string::npos) << one.effect;
    ++count[one.looked_at];
  }
  EXPECT_GE(count[LookedAt::kFit], 2);
  EXPECT_GE(count[LookedAt::kLinearised], 10);
  EXPECT_EQ(count[LookedAt::kRecordings], 1) << "quantisation, which the readings themselves tell";
  EXPECT_EQ(count[LookedAt::kNot], 0);
  EXPECT_EQ(diagnosis_json(found).at("rejected").at(0).at("looked_at"), name(found.rejected.front().looked_at));
}

TEST_F(Rules, AnInterruptedDiagnosisRulesNothingOutThatItDidNotLookAt) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  const bench::Bench bench = written(test::record(bench_, truth, 4, 2e-4));
  work::Progress progress;
  bool at_the_search = false;
  progress.report = [&](double, std::string_view doing) { at_the_search |= doing.starts_with("looking at "); };
  progress.interrupted = [&] { return at_the_search; };
  for (const Rejected& one : diagnose(bench, given_healthy(), nullptr, progress).rejected) {
    EXPECT_EQ(one.looked_at, one.effect == "quantisation" ? LookedAt::kRecordings : LookedAt::kNot) << one.effect;
  }
}

}  // namespace
}  // namespace pmg::diagnosis
