// A fit finds what a made-up joint was made of.
#include "calib/motor_fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "calib/fit_confidence.hpp"
#include "calib/fit_results.hpp"
#include "calib/synthetic_bench.hpp"

namespace pmg {
namespace {

using testing::HasSubstr;

calib::JointModel truth() {
  calib::JointModel model;
  model.actuator.drive.kp_scale = 0.8;
  model.actuator.drive.kd_scale = 1.4;
  model.actuator.transmission.armature_kg_m2 = 0.03;
  model.actuator.friction.coulomb_Nm = 0.35;
  model.actuator.friction.viscous_Nm_s_per_rad = 0.12;
  model.actuator.command.delay_s = 0.012;
  return model;
}

calib::FitProblem problem(const std::vector<std::string>& names, double noise_rad, int runs = 4) {
  const bench::Bench bench = test::pd_bench(true);
  calib::Unknowns parameters;
  for (const std::string& name : calib::basic_parameters(bench)) parameters.push_back(calib::unknown(name, bench));
  for (const std::string& name : names) parameters.push_back(calib::unknown(name, bench));
  return {parameters, {}, test::record(bench, truth(), runs, noise_rad)};
}

// 1 mrad of noise on 1200 samples moves these parameters by less than a percent.
TEST(MotorFit, FindsWhatTheJointIsMadeOf) {
  const calib::FitProblem joint =
      problem({"friction.coulomb_Nm", "friction.viscous_Nm_s_per_rad", "command.delay_s"}, 1e-3);
  const calib::Fit fit = calib::fit(joint, {.starts = 4, .threads = 2});
  for (const calib::Unknown& p : joint.parameters()) {
    const double expected = calib::value(truth(), p.name);
    EXPECT_NEAR(calib::value(fit.model, p.name), expected, 0.04 * expected) << p.name;
  }
  EXPECT_NEAR(std::sqrt(fit.loss_rad2), 1e-3, 1e-4) << "what is left is the noise";
}

// A foot on its ankle: of the rotor's inertia the load is a thirtieth, and all torques could be larger by one factor
// almost as well. 0.4 mrad of noise leave a few percent of that factor open.
TEST(MotorFit, FindsTheFactorOfAllTorquesUnderALightLoad) {
  const bench::Bench bench = test::pd_bench(true);
  const calib::FitProblem usual = problem({"friction.coulomb_Nm", "friction.viscous_Nm_s_per_rad"}, 0.0);
  calib::JointModel light = truth();
  light.actuator.command.delay_s = 0.0;
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 4e-4);
  std::vector<calib::SingleJoint> runs;
  for (const calib::SingleJoint& joint : usual.runs()) {
    bench::BenchRun run = joint.run();
    run.load = {0.001, 0.15, 0.0};
    run.recording.q_rad = calib::SingleJoint(bench, run, joint.step_s()).rollout(light);
    for (double& q_rad : run.recording.q_rad) q_rad += noise(random);
    runs.emplace_back(bench, run, joint.step_s());
  }
  const calib::Fit fit = calib::fit({usual.parameters(), {}, runs}, {.newton_steps = 30, .threads = 2});
  EXPECT_NEAR(fit.model.actuator.drive.kp_scale, 0.8, 0.2 * 0.8);
  EXPECT_NEAR(fit.model.actuator.drive.kp_scale / fit.model.actuator.transmission.armature_kg_m2, 0.8 / 0.03, 0.5);
}

TEST(MotorFit, IsTheSameOnAnyNumberOfThreads) {
  const calib::FitProblem joint = problem({}, 1e-3, 2);
  calib::FitOptions options{
      .starts = 3, .screened_per_dimension = 8, .evaluations_per_dimension = 15, .newton_steps = 5};
  const calib::Fit alone = calib::fit(joint, options);
  options.threads = 3;
  const calib::Fit together = calib::fit(joint, options);
  EXPECT_EQ(alone.point, together.point);
  EXPECT_EQ(alone.loss_rad2, together.loss_rad2);
}

class EveryMethod : public testing::TestWithParam<const char*> {};

// The paper's eta = (Kp, Kd, I), friction known.
TEST_P(EveryMethod, FindsTheDrivesGains) {
  calib::FitProblem with_friction = problem({}, 0.0, 2);
  calib::JointModel start = truth();
  start.actuator.drive.kp_scale = start.actuator.drive.kd_scale = 1.0;
  start.actuator.transmission.armature_kg_m2 = 0.01;
  const calib::FitProblem joint(with_friction.parameters(), start, with_friction.runs());
  const calib::Fit fit = calib::fit(joint, {.method = calib::method_of(GetParam()), .starts = 2, .threads = 2});
  EXPECT_NEAR(fit.model.actuator.drive.kp_scale, 0.8, 0.01);
  EXPECT_NEAR(fit.model.actuator.drive.kd_scale, 1.4, 0.03);
  EXPECT_NEAR(fit.model.actuator.transmission.armature_kg_m2, 0.03, 0.001);
}

INSTANTIATE_TEST_SUITE_P(Optimizers, EveryMethod, testing::Values("bobyqa", "sbplx", "crs2", "cmaes"),
                         [](const auto& instance) { return std::string(instance.param); });

// The search sees one run, whose joint is another one; on all runs the start is better than what it finds.
TEST(MotorFit, IsNeverWorseThanItsStart) {
  const calib::FitProblem usual = problem({}, 0.0, 6);
  const bench::Bench bench = test::pd_bench(true);
  calib::JointModel other = truth();
  other.actuator.drive.kp_scale = 0.4;
  other.actuator.drive.kd_scale = 0.5;
  const calib::FitProblem searched = usual.thinned(1);
  std::vector<calib::SingleJoint> runs;
  for (const calib::SingleJoint& joint : usual.runs()) {
    bench::BenchRun run = joint.run();
    const bool is_searched = run.recording.q_rad == searched.runs().front().run().recording.q_rad;
    run.recording.q_rad = joint.rollout(is_searched ? other : truth());
    runs.emplace_back(bench, std::move(run), joint.step_s());
  }
  const calib::FitProblem misleading(usual.parameters(), truth(), runs);
  const double at_start = misleading.loss(misleading.point_of(truth()));
  const calib::Fit fit = calib::fit(
      misleading, {.starts = 1, .runs_while_searching = 1, .evaluations_per_dimension = 1, .newton_steps = 0});
  EXPECT_GT(misleading.loss(fit.starts.front().point), at_start) << "the search was misled";
  EXPECT_LE(fit.loss_rad2, at_start);
  EXPECT_EQ(fit.loss_rad2, misleading.loss(fit.point));
}

// Two masses of which one is none: no stiffness of the shaft helps.
TEST(MotorFit, SaysWhyNoModelWithinTheRangesCanBeSimulated) {
  const calib::FitProblem usual = problem({}, 0.0, 2);
  calib::JointModel without_rotor = truth();
  without_rotor.actuator.transmission.armature_kg_m2 = 0.0;
  const bench::Bench bench = test::pd_bench(true);
  const calib::FitProblem shaft({calib::unknown("transmission.stiffness_Nm_per_rad", bench),
                                 calib::unknown("transmission.damping_Nm_s_per_rad", bench)},
                                without_rotor, usual.runs());
  try {
    calib::fit(shaft, {.starts = 1});
    ADD_FAILURE() << "fitted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("needs an armature"));
  }
}

TEST(MotorFit, KeepsTheBestWhenInterrupted) {
  const calib::FitProblem joint = problem({}, 0.0, 2);
  int calls = 0;
  const calib::Fit fit = calib::fit(joint, {.starts = 2}, {.interrupted = [&] { return ++calls >= 30; }});
  EXPECT_TRUE(fit.interrupted);
  EXPECT_EQ(fit.point.size(), joint.dimensions());
  EXPECT_LT(fit.loss_rad2, joint.loss(joint.point_of(joint.start())));
}

// Of 6 parameters with honest deviations, one in a thousand misses by more than 4.
TEST(Confidence, CoversTheTruth) {
  const calib::FitProblem joint =
      problem({"friction.coulomb_Nm", "friction.viscous_Nm_s_per_rad", "command.delay_s"}, 1e-3);
  const calib::Fit fit = calib::fit(joint, {.starts = 4, .threads = 2});
  const std::vector<calib::Confidence> confidence = calib::confidence(joint, fit.point, 2);
  for (std::size_t i = 0; i < confidence.size(); ++i) {
    const std::string& name = joint.parameters()[i].name;
    const double expected = calib::value(truth(), name);
    EXPECT_LT(std::abs(calib::value(fit.model, name) - expected), 4.0 * confidence[i].deviation) << name;
    EXPECT_LT(confidence[i].deviation, 0.03 * expected) << name << ": a deviation that says nothing covers everything";
    EXPECT_EQ(confidence[i].confounded_with, "") << name;
  }
}

// Only the last sample of each run is off: without it the residuals would be 0, and so would the deviations.
TEST(Confidence, CountsTheLastSampleOfEachRun) {
  const calib::FitProblem exact = problem({}, 0.0, 2);
  const bench::Bench bench = test::pd_bench(true);
  std::vector<calib::SingleJoint> runs;
  for (const calib::SingleJoint& joint : exact.runs()) {
    bench::BenchRun run = joint.run();
    run.recording.q_rad = joint.rollout(truth());
    run.recording.q_rad.back() += 0.01;
    runs.emplace_back(bench, std::move(run), joint.step_s());
  }
  calib::JointModel start = truth();
  const calib::FitProblem off(exact.parameters(), start, runs);
  for (const calib::Confidence& one : calib::confidence(off, off.point_of(start), 1)) {
    EXPECT_GT(one.deviation, 1e-9);  // rounding alone leaves 1e-14
  }
}

TEST(Confidence, SaysWhatTheRunsCantTell) {
  // Both runs have the same kd, and none a commanded speed.
  const calib::FitProblem joint =
      problem({"friction.viscous_Nm_s_per_rad", "drive.stall_torque_Nm", "drive.no_load_rad_s"}, 1e-3, 2);
  calib::JointModel model = truth();
  model.actuator.drive.stall_torque_Nm = 400.0;  // far from all that the joint does
  model.actuator.drive.no_load_rad_s = 60.0;
  const std::vector<calib::Confidence> confidence = calib::confidence(joint, joint.point_of(model), 1);
  ASSERT_EQ(joint.parameters()[1].name, "drive.kd_scale");
  EXPECT_EQ(confidence[1].confounded_with, "friction.viscous_Nm_s_per_rad");
  EXPECT_EQ(confidence[3].confounded_with, "drive.kd_scale");
  ASSERT_EQ(joint.parameters()[5].name, "drive.no_load_rad_s");
  EXPECT_TRUE(std::isinf(confidence[5].deviation));
}

/// A pendulum whose rotor has 0.020 kg m^2, and of whose loads bench.yaml knows neither inertia nor gravity torque: the
/// point masses that stand for them are too light by 13 and 8 %.
calib::FitProblem of_unknown_load(const std::vector<double>& masses_kg, bool gains_known, double noise_rad = 2e-4) {
  bench::Bench bench = test::pd_bench(true);
  for (const double mass_kg : masses_kg) {
    bench::BenchLoad& load = bench.loads.emplace_back();
    load.mass_kg = mass_kg;
    load.inertia_unknown = load.gravity_unknown = true;
  }
  calib::JointModel truth;
  truth.actuator.transmission.armature_kg_m2 = 0.020;
  truth.actuator.friction.coulomb_Nm = 0.1;
  truth.inertia_scale = 1.13;
  truth.gravity_scale = 1.08;
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, noise_rad);
  std::vector<calib::SingleJoint> runs;
  for (const calib::SingleJoint& joint : test::record(bench, truth, 4)) {
    bench::BenchRun run = joint.run();
    const double mass_kg = masses_kg[runs.size() % masses_kg.size()];
    run.load = {0.02 * mass_kg, 2.0 * mass_kg, 0.0};
    run.recording.q_rad = calib::SingleJoint(bench, run, joint.step_s()).rollout(truth);
    for (double& q_rad : run.recording.q_rad) q_rad += noise(random);
    runs.emplace_back(bench, run, joint.step_s());
  }
  std::vector<std::string> names = {"transmission.armature_kg_m2", "friction.coulomb_Nm"};
  if (!gains_known) names.insert(names.end(), {"drive.kp_scale", "drive.kd_scale"});
  for (const std::string& name : calib::unknown_loads(bench)) names.push_back(name);
  calib::Unknowns parameters;
  for (const std::string& name : names) parameters.push_back(calib::unknown(name, bench));
  return {parameters, {}, runs};
}

struct FittedLoad {
  calib::FitProblem problem;
  calib::Fit fit = calib::fit(problem, {.starts = 4, .newton_steps = 30, .threads = 2});
  std::vector<calib::Confidence> confidence = calib::confidence(problem, fit.point, 2);
};

std::vector<std::string> not_told(const FittedLoad& fitted) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < fitted.confidence.size(); ++i) {
    if (!fitted.confidence[i].told_only_with.empty()) names.push_back(fitted.problem.parameters()[i].name);
  }
  return names;
}

TEST(UnknownLoad, OfTwoMassesIsFittedBesideTheRotor) {
  const FittedLoad fitted{of_unknown_load({0.5, 2.0}, true)};
  EXPECT_NEAR(fitted.fit.model.actuator.transmission.armature_kg_m2, 0.020, 0.02 * 0.020);
  EXPECT_NEAR(fitted.fit.model.inertia_scale, 1.13, 0.02 * 1.13);
  EXPECT_NEAR(fitted.fit.model.gravity_scale, 1.08, 0.02 * 1.08);
  EXPECT_THAT(not_told(fitted), testing::IsEmpty());
  for (const calib::Confidence& one : fitted.confidence) EXPECT_TRUE(std::isfinite(one.deviation));
  EXPECT_LT(std::abs(fitted.fit.model.actuator.transmission.armature_kg_m2 - 0.020),
            4.0 * fitted.confidence[0].deviation);
}

TEST(UnknownLoad, OfOneMassIsNotToldFromTheRotorAndNoIntervalIsClaimed) {
  const FittedLoad fitted{of_unknown_load({1.0}, true)};
  EXPECT_THAT(not_told(fitted), testing::ElementsAre("transmission.armature_kg_m2", "load.inertia_scale"));
  EXPECT_THAT(fitted.confidence[0].told_only_with, testing::ElementsAre("load.inertia_scale"));
  EXPECT_TRUE(std::isinf(fitted.confidence[0].deviation));
  EXPECT_NEAR(fitted.fit.model.actuator.transmission.armature_kg_m2 + 0.02 * fitted.fit.model.inertia_scale,
              0.020 + 0.02 * 1.13, 0.02 * 0.0426)
      << "what they make together is told";
  EXPECT_NEAR(fitted.fit.model.gravity_scale, 1.08, 0.02 * 1.08) << "gravity is told by gains that are known";
}

TEST(UnknownLoad, BesideUnknownGainsLeavesTheFactorOfAllTorquesOpen) {
  const FittedLoad fitted{of_unknown_load({0.5, 2.0}, false)};
  EXPECT_THAT(not_told(fitted),
              testing::UnorderedElementsAre("transmission.armature_kg_m2", "friction.coulomb_Nm", "drive.kp_scale",
                                            "drive.kd_scale", "load.inertia_scale", "load.gravity_scale"));
  for (const calib::Confidence& one : fitted.confidence) EXPECT_TRUE(std::isinf(one.deviation));
}

TEST(UnknownLoad, IsThatOfBenchYamlAndOfAllLoadsOrNone) {
  bench::Bench bench = test::pd_bench(true);
  bench.loads.resize(2);
  EXPECT_THAT(calib::unknown_loads(bench), testing::IsEmpty());
  bench.loads[0].inertia_unknown = true;
  EXPECT_THROW(calib::unknown_loads(bench), std::invalid_argument);
  bench.loads[1].inertia_unknown = true;
  EXPECT_THAT(calib::unknown_loads(bench), testing::ElementsAre("load.inertia_scale"));
}

// A search that stopped far from its optimum: the residual's slope says how far.
TEST(Confidence, OfAnUnfinishedFitReachesToWhereTheFitWouldEnd) {
  const calib::FitProblem joint =
      problem({"friction.coulomb_Nm", "friction.viscous_Nm_s_per_rad", "command.delay_s"}, 1e-4);
  calib::JointModel near = truth();
  near.actuator.transmission.armature_kg_m2 *= 1.05;
  near.actuator.friction.coulomb_Nm *= 0.97;
  const std::vector<calib::Confidence> confidence = calib::confidence(joint, joint.point_of(near), 1);
  for (std::size_t i = 0; i < confidence.size(); ++i) {
    const std::string& name = joint.parameters()[i].name;
    EXPECT_LT(std::abs(calib::value(near, name) - calib::value(truth(), name)), 1.2 * confidence[i].deviation) << name;
  }
}

/// What the program makes of a fit, of which it may ask for interruptions so often.
calib::FitResults results_of(const calib::FitProblem& problem, const bench::Bench& bench, int most_questions) {
  calib::FitResults results;
  int questions = 0;
  results.fit = calib::fit(problem, {.starts = 2, .evaluations_per_dimension = 20},
                           {.interrupted = [&] { return ++questions > most_questions; }});
  results.confidence = calib::confidence(problem, results.fit.point, 1);
  results.bench = &bench;
  results.problem = &problem;
  results.fitted = calib::assess("", problem.runs(), problem.start(), results.fit.model, 1);
  return results;
}

/// The words that a fit's files and page begin with.
void expect_everywhere(const calib::FitResults& results, const std::string& word, work::Grade grade) {
  EXPECT_EQ(worth_of(results).grade(), grade) << worth_of(results).sentence();
  EXPECT_THAT(calib::motor_remarks(results).front(), testing::StartsWith(word)) << "motor.yaml";
  EXPECT_EQ(calib::fit_json(results)["worth"], work::name(grade));
  const std::string html = calib::fit_report(results).html();
  EXPECT_THAT(html, testing::Not(HasSubstr("class=\"verdict good\"")));
  EXPECT_LT(html.find(word), html.find("Mean absolute error"));
}

constexpr int kWithoutEnd = 1 << 30;

TEST(FitWorth, GreenOnlyWhereTheFitEndedAndExplainsTheMotion) {
  const bench::Bench bench = test::pd_bench(true);
  const calib::FitProblem joint =
      problem({"friction.coulomb_Nm", "friction.viscous_Nm_s_per_rad", "command.delay_s"}, 1e-3);
  const calib::FitResults whole = results_of(joint, bench, kWithoutEnd);
  EXPECT_EQ(worth_of(whole).sentence(), "");
  EXPECT_THAT(calib::fit_report(whole).html(), HasSubstr("class=\"verdict good\""));
  for (const int questions : {0, 10, 40})
    expect_everywhere(results_of(joint, bench, questions), "INTERRUPTED: ", work::Grade::kInterrupted);
}

TEST(FitWorth, ReadingsOfNoiseAreNothingThatAModelExplains) {
  const bench::Bench bench = test::pd_bench(true);
  const calib::FitProblem joint = problem({"friction.coulomb_Nm", "friction.viscous_Nm_s_per_rad"}, 1e-3);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.3);
  std::vector<calib::SingleJoint> runs;
  for (const calib::SingleJoint& one : joint.runs()) {
    bench::BenchRun run = one.run();
    for (double& q_rad : run.recording.q_rad) q_rad = noise(random);
    runs.emplace_back(bench, run, one.step_s());
  }
  const calib::FitProblem wrong(joint.parameters(), {}, runs);
  expect_everywhere(results_of(wrong, bench, kWithoutEnd), "OFF ITS DATA: ", work::Grade::kOffItsData);
}

TEST(FitWorth, OfFaultyDataAndOfAFitThatGetsNoBetter) {
  const bench::Bench bench = test::pd_bench(true);
  const calib::FitProblem joint =
      problem({"friction.coulomb_Nm", "friction.viscous_Nm_s_per_rad", "command.delay_s"}, 1e-3);
  calib::FitResults results = results_of(joint, bench, kWithoutEnd);
  results.fitted.before = results.fitted.after;
  expect_everywhere(results, "NO BETTER: ", work::Grade::kNoBetter);
  results.data = {work::Grade::kOffItsData, "a fault of the data"};
  expect_everywhere(results, "OFF ITS DATA: a fault of the data", work::Grade::kOffItsData);
}

TEST(FitProblem, PointsAreWhatModelsAre) {
  const calib::FitProblem joint =
      problem({"friction.coulomb_Nm", "sensor.zero_offset_rad", "command.rate_limit_rad_s"}, 0.0, 1);
  calib::JointModel model = truth();
  model.actuator.sensor.zero_offset_rad = -0.02;
  model.actuator.command.rate_limit_rad_s = 5.0;
  const calib::JointModel back = joint.model_at(joint.point_of(model));
  for (const calib::Unknown& p : joint.parameters()) {
    EXPECT_NEAR(calib::value(back, p.name), calib::value(model, p.name), 1e-12) << p.name;
  }
}

TEST(FitResults, UnitsAreThoseOfTheRig) {
  bench::Bench bench;
  for (const auto& [turning, linear] : {std::pair{"Nm", "N"},
                                        {"kg m^2", "kg"},
                                        {"rad/s^2", "m/s^2"},
                                        {"Nm s^2/rad^2", "N s^2/m^2"},
                                        {"1/(Nm^2 s)", "1/(N^2 s)"},
                                        {"s", "s"}}) {
    bench.rig = bench::Rig::kPendulum;
    EXPECT_EQ(calib::unit_on_rig(turning, bench), turning);
    bench.rig = bench::Rig::kLinear;
    EXPECT_EQ(calib::unit_on_rig(turning, bench), linear);
  }
}

}  // namespace
}  // namespace pmg
