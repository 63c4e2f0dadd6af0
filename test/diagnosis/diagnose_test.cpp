#include "diagnosis/diagnose.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>

#include "calib/synthetic_bench.hpp"
#include "data_faults/frozen.hpp"
#include "diagnosis/diagnosis_json.hpp"
#include "diagnosis_page/diagnosis_page.hpp"

namespace pmg::diagnosis {
namespace {

namespace fs = std::filesystem;

model::ActuatorParameters known() {
  model::ActuatorParameters known;
  known.transmission.armature_kg_m2 = 0.01;
  known.friction.viscous_Nm_s_per_rad = 0.1;
  known.friction.coulomb_Nm = 0.05;
  return known;
}

/// A bench in files, moved by what is known and what is hidden.
class Diagnose : public testing::Test {
 protected:
  Diagnosis diagnosed(const std::function<void(model::ActuatorParameters&)>& hide) {
    calib::JointModel truth;
    truth.actuator = known();
    hide(truth.actuator);
    test::write_bench(folder_, test::record(test::pd_bench(true), truth, 4, 2e-4));
    DiagnoseOptions options;
    options.model = known();
    return diagnose(bench::read_bench(folder_), options);
  }
  void TearDown() override { fs::remove_all(folder_); }
  const fs::path folder_ = fs::temp_directory_path() / ("pmg_diagnose_" + std::to_string(getpid()));
};

TEST_F(Diagnose, NamesADelayWithItsInterval) {
  const Diagnosis found = diagnosed([](model::ActuatorParameters& p) { p.command.delay_s = 0.015; });
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_EQ(found.causes.front().effect, "delay");
  const evidence::Interval delay_s = found.causes.front().parameters.front().estimate;
  EXPECT_LT(delay_s.low, 0.015);
  EXPECT_GT(delay_s.high, 0.015);
  EXPECT_EQ(found.verdict, evidence::Verdict::kFound);
  EXPECT_GT(found.share_of_way_to_floor, 0.9);
  EXPECT_NEAR(found.after.actuator.command.delay_s, 0.015, 0.001);
}

TEST_F(Diagnose, FindsNothingWhereNothingIsWrong) {
  const Diagnosis found = diagnosed([](model::ActuatorParameters&) {});
  EXPECT_EQ(found.verdict, evidence::Verdict::kNone);
  EXPECT_TRUE(found.causes.empty());
  EXPECT_FALSE(found.rejected.empty());
}

TEST_F(Diagnose, NamesAQuantumThatReadingsShow) {
  calib::JointModel truth;
  truth.actuator = known();
  truth.actuator.sensor.quantum_rad = 0.02;
  test::write_bench(folder_, test::record(test::pd_bench(true), truth, 4));
  DiagnoseOptions options;
  options.model = known();
  DiagnosedRuns runs;
  const Diagnosis found = diagnose(bench::read_bench(folder_), options, &runs);
  EXPECT_FALSE(runs.checks.empty()) << "a report shows those that the diagnosis weighed";
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_EQ(found.causes.front().effect, "quantisation");
  const evidence::Interval quantum_rad = found.causes.front().parameters.front().estimate;
  EXPECT_LE(quantum_rad.low, 0.02);
  EXPECT_GE(quantum_rad.high, 0.02);
  EXPECT_LT(quantum_rad.high - quantum_rad.low, 1e-4);  // files hold microradians
}

TEST_F(Diagnose, SaysInJsonWhatTheFormatAsksFor) {
  const nlohmann::ordered_json json =
      diagnosis_json(diagnosed([](model::ActuatorParameters& p) { p.friction.coulomb_Nm = 0.5; }));
  EXPECT_EQ(json.at("verdict"), "found");
  const auto& cause = json.at("causes").at(0);
  EXPECT_EQ(cause.at("effect"), "coulomb");
  const auto& parameter = cause.at("parameters").at("friction.coulomb_Nm");
  for (const char* key : {"value", "low", "high", "unit"}) EXPECT_TRUE(parameter.contains(key)) << key;
  EXPECT_LT(cause.at("held_out_error_after"), cause.at("held_out_error_before"));
  for (const char* key : {"rejected", "noise_floor", "held_out_error_before", "held_out_error_after", "unit",
                          "next_excitation", "options"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
}

TEST_F(Diagnose, GoesOnWithoutReadingsThatFroze) {
  calib::JointModel truth;
  truth.actuator = known();
  std::vector<calib::SingleJoint> joints;
  for (const calib::SingleJoint& joint : test::record(test::pd_bench(true), truth, 4, 2e-4)) {
    bench::BenchRun run = joint.run();
    test::freeze(run, 0.35, 0.2);
    joints.emplace_back(test::pd_bench(true), run, joint.step_s());
  }
  test::write_bench(folder_, joints);
  DiagnoseOptions options;
  options.model = known();
  for (const auto handling : {data_faults::Handling::kLeaveOut, data_faults::Handling::kCorrect}) {
    options.data.handling = handling;
    const Diagnosis found = diagnose(bench::read_bench(folder_), options);
    ASSERT_EQ(found.data.faults.size(), 1U);
    EXPECT_EQ(found.data.faults.front().kind, data_faults::Kind::kFrozenReadings);
    EXPECT_EQ(found.verdict, evidence::Verdict::kNone);
    EXPECT_TRUE(found.causes.empty());
  }
  options.data.handling = data_faults::Handling::kKeep;
  const Diagnosis kept = diagnose(bench::read_bench(folder_), options);
  EXPECT_EQ(kept.data.faults.size(), 1U);
  EXPECT_NE(kept.verdict, evidence::Verdict::kNone) << "what is left in the data shows";
}

TEST_F(Diagnose, DecidesByItsOptions) {
  calib::JointModel truth;
  truth.actuator = known();
  truth.actuator.command.delay_s = 0.015;
  test::write_bench(folder_, test::record(test::pd_bench(true), truth, 4, 2e-4));
  DiagnoseOptions options;
  options.model = known();
  options.decide_by.least_deviations = 1e9;
  const Diagnosis found = diagnose(bench::read_bench(folder_), options);
  EXPECT_TRUE(found.causes.empty()) << "no gain has so many deviations";
  EXPECT_EQ(found.options.least_deviations, 1e9);
}

/// Four loads by three gains, moved by what is known and hidden.
std::vector<calib::SingleJoint> of_four_loads(const calib::JointModel& truth) {
  constexpr double kLoads[] = {1.0, 1.25, 1.6, 2.0}, kGains[] = {20.0, 30.0, 45.0};
  constexpr int kRuns = 12;
  const bench::Bench bench = test::pd_bench(true);
  std::mt19937 random(1);
  std::normal_distribution<double> noise_rad(0.0, 2e-4);
  std::vector<calib::SingleJoint> joints;
  for (int i = 0; i < kRuns; ++i) {
    bench::BenchRun run;
    run.file = fmt::format("run{}.csv", i);
    run.trajectory = "excitation";
    run.recording = test::excitation(0);
    run.kp = kGains[i % 3], run.kd = 0.04 * run.kp;
    const double load = kLoads[i / 3];
    run.load = {0.03 * load, 1.5 * load};
    run.recording.q_rad = calib::SingleJoint(bench, run, calib::simulation_step_s(bench)).rollout(truth);
    for (double& q_rad : run.recording.q_rad) q_rad += noise_rad(random);
    joints.emplace_back(bench, run, calib::simulation_step_s(bench));
  }
  return joints;
}

TEST_F(Diagnose, LooksForWrongLoadsOnceMoreBesideWhatItFound) {
  calib::JointModel truth;
  truth.actuator = known();
  truth.actuator.command.rate_limit_rad_s = 1.5;
  std::vector<calib::SingleJoint> joints;
  std::vector<std::string> files;
  for (const calib::SingleJoint& joint : of_four_loads(truth)) {
    bench::BenchRun run = joint.run();
    if (run.load.gravity_Nm == 1.5 * 1.6) {
      run.load.inertia_kg_m2 *= 1.3, run.load.gravity_Nm *= 1.3;
      files.push_back(run.file);
    }
    joints.emplace_back(test::pd_bench(true), run, joint.step_s());
  }
  test::write_bench(folder_, joints);
  const bench::Bench bench = bench::read_bench(folder_);
  DiagnoseOptions options;
  options.model = known();
  EXPECT_TRUE(data_faults::examine(bench, {""}, options.model, {}, 1).faults.empty()) << "seen at once: no test";
  const Diagnosis found = diagnose(bench, options);
  ASSERT_EQ(found.data.faults.size(), 1U);
  EXPECT_EQ(found.data.faults.front().kind, data_faults::Kind::kMass);
  EXPECT_EQ(found.data.left_out, files);
  EXPECT_NEAR(found.data.faults.front().fixes.front().load_factor, 1.0 / 1.3, 0.04);
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_LT(found.after_over_noise, 1.5) << "the verdict is that of the sound runs";
}

/// The words that a diagnosis' JSON and page begin with; no line is green.
void expect_worth(const bench::Bench& bench, const Diagnosis& found, const DiagnosedRuns& runs, work::Grade grade) {
  EXPECT_EQ(worth_of(found).grade(), grade) << worth_of(found).sentence();
  EXPECT_EQ(diagnosis_json(found)["worth"], work::name(grade));
  const std::string html = diagnosis_page::page_of(bench, found, runs, 1).html();
  EXPECT_EQ(html.find("verdict good"), std::string::npos);
  const std::size_t first = html.find("<div class=\"verdict");
  const std::size_t text = html.find('>', first) + 1;
  EXPECT_EQ(html.substr(text, 12), worth_of(found).sentence().substr(0, 12)) << "the first line";
}

TEST_F(Diagnose, InterruptedItHasNoVerdictWhereverItWas) {
  calib::JointModel truth;
  truth.actuator = known();
  truth.actuator.command.delay_s = 0.015;
  test::write_bench(folder_, test::record(test::pd_bench(true), truth, 4, 2e-4));
  const bench::Bench bench = bench::read_bench(folder_);
  DiagnoseOptions options;
  options.model = known();
  for (const int most : {0, 5, 50}) {
    int questions = 0;
    DiagnosedRuns runs;
    const Diagnosis found =
        diagnose(bench, options, &runs, {.report = {}, .interrupted = [&] { return ++questions == most + 1; }});
    SCOPED_TRACE(most);
    EXPECT_EQ(found.verdict, evidence::Verdict::kInterrupted);
    expect_worth(bench, found, runs, work::Grade::kInterrupted);
  }
}

TEST_F(Diagnose, ReadingsInDegreesOrOfNoiseAreNoGreenPage) {
  using enum data_faults::Handling;
  calib::JointModel truth;
  truth.actuator = known();
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.3);
  struct Case {
    const char* what;
    data_faults::Handling handling;
    work::Grade grade;
  };
  for (const Case& one : {Case{"degrees", kKeep, work::Grade::kOffItsData},
                          {"degrees", kLeaveOut, work::Grade::kOpen},
                          {"noise", kLeaveOut, work::Grade::kOffItsData}}) {
    const bool degrees = std::string(one.what) == "degrees";
    std::vector<calib::SingleJoint> joints;
    for (const calib::SingleJoint& healthy : test::record(test::pd_bench(true), truth, 4, 2e-4)) {
      bench::BenchRun run = healthy.run();
      for (double& q_rad : run.recording.q_rad) q_rad = degrees ? q_rad * 57.29578 : noise(random);
      for (double& q_rad : run.recording.q_cmd_rad) q_rad *= degrees ? 57.29578 : 1.0;
      joints.emplace_back(test::pd_bench(true), run, healthy.step_s());
    }
    fs::remove_all(folder_);
    test::write_bench(folder_, joints);
    const bench::Bench bench = bench::read_bench(folder_);
    DiagnoseOptions options;
    options.model = known();
    options.data.handling = one.handling;
    DiagnosedRuns runs;
    const Diagnosis found = diagnose(bench, options, &runs);
    SCOPED_TRACE(one.what);
    expect_worth(bench, found, runs, one.grade);
    if (degrees && one.handling == kLeaveOut) {
      EXPECT_EQ(found.verdict, evidence::Verdict::kNone) << "with the fault corrected the joint is healthy";
      EXPECT_FALSE(found.data.faults.empty());
    }
  }
}

TEST_F(Diagnose, RefusesToScoreWhatItFits) {
  calib::JointModel truth;
  truth.actuator = known();
  test::write_bench(folder_, test::record(test::pd_bench(true), truth, 2));
  DiagnoseOptions options;
  options.score = "repeat == 0";
  EXPECT_THROW(diagnose(bench::read_bench(folder_), options), std::invalid_argument);
}

}  // namespace
}  // namespace pmg::diagnosis
