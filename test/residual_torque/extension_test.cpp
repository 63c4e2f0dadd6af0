// Joints with a torque that no effect has: unexplained, and simulated better with what was learnt of it.
#include "residual_torque/extension.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "calib/fit_problem.hpp"
#include "calib/synthetic_bench.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/diagnosis_json.hpp"
#include "diagnosis_page/diagnosis_page.hpp"
#include "effects/folds.hpp"
#include "sim/motor_file.hpp"

namespace pmg::residual_torque {
namespace {

namespace fs = std::filesystem;

constexpr double kNoise_rad = 2e-4;
constexpr int kConditions = 8;

calib::JointModel healthy() { return test::plain_joint(0.05); }

/// (q, dq) => torque on the joint that the healthy one hasn't [Nm].
using Hidden = std::function<double(double q_rad, double dq_rad_s)>;

/// A magnet at 0.4 rad (J.-P. Yonnet, IEEE Trans. Magn. 17:1169, 1981), of 1 Nm: (x/w) (1 + (x/w)^2)^(-5/2) / 0.286.
double latch_Nm(double q_rad, double) {
  const double x = (q_rad - 0.4) / 0.15, y = 1.0 + x * x;
  return -x / (y * y * std::sqrt(y)) / 0.286;
}

/// A cable that rubs beyond 0.2 rad, by 2 Nm per rad.
double rub_Nm(double q_rad, double dq_rad_s) { return -2.0 * std::max(0.0, q_rad - 0.2) * std::tanh(dq_rad_s / 0.02); }

/// The healthy joint with a hidden torque, by an integration of its own; implicit in the speed, for the cable is stiff.
std::vector<double> moved(const calib::SingleJoint& joint, const Hidden& hidden) {
  constexpr double kSmall_rad_s = 1e-4;
  const bench::BenchRun& run = joint.run();
  sim::ActuatorModel actuator(healthy().actuator, joint.step_s());
  double q_rad = 0.0, dq_rad_s = 0.0;
  const double inertia_kg_m2 = run.load.inertia_kg_m2 + actuator.joint_armature_kg_m2();
  std::vector<double> seen_rad;
  std::size_t sample = 0;
  for (std::size_t k = 0; k <= joint.steps(); ++k) {
    const double t_s = static_cast<double>(k) * joint.step_s();
    while (sample < run.recording.t_s.size() && run.recording.t_s[sample] <= t_s + 1e-9) {
      seen_rad.push_back(q_rad);
      ++sample;
    }
    if (k == joint.steps()) break;
    const sim::ActuatorTorque drive = actuator.step(joint.input(k), q_rad, dq_rad_s);
    const double hidden_Nm = hidden(q_rad, dq_rad_s);
    const double slope = drive.slope_Nm_s_per_rad + (hidden(q_rad, dq_rad_s + kSmall_rad_s) - hidden_Nm) / kSmall_rad_s;
    const double torque_Nm = drive.torque_Nm - run.load.gravity_Nm * std::sin(q_rad) + hidden_Nm;
    dq_rad_s += joint.step_s() * torque_Nm / (inertia_kg_m2 - joint.step_s() * slope);
    q_rad += joint.step_s() * dq_rad_s;
  }
  return seen_rad;
}

/// The slower four excitations with two gains each, recorded twice, at the step that fits use: nothing but the hidden
/// torque and noise is missing.
std::vector<calib::SingleJoint> runs(const Hidden& hidden, double noise_rad = kNoise_rad,
                                     const Hidden& hidden_at_high_gain = {}) {
  const bench::Bench bench = test::pd_bench(true);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, noise_rad);
  const std::vector<calib::SingleJoint> excitations = test::record(bench, healthy(), 4);
  std::vector<calib::SingleJoint> joints;
  for (int i = 0; i < 2 * kConditions; ++i) {
    const calib::SingleJoint& excitation = excitations[static_cast<std::size_t>(i % 4)];
    bench::BenchRun run = excitation.run();
    run.file = fmt::format("run{}.csv", i);
    run.repeat = i / kConditions;
    run.kp = i % kConditions < 4 ? 15.0 : 25.0;
    run.kd = i % kConditions < 4 ? 0.6 : 1.0;
    const bool other = run.kp > 20.0 && hidden_at_high_gain;
    run.recording.q_rad =
        moved(calib::SingleJoint(bench, run, excitation.step_s()), other ? hidden_at_high_gain : hidden);
    for (double& q_rad : run.recording.q_rad) q_rad += noise(random);
    joints.emplace_back(bench, run, excitation.step_s());
  }
  return joints;
}

/// What a diagnosis of these runs gives, the repeats being held out.
class ResidualTorque : public testing::Test {
 protected:
  diagnosis::Diagnosis diagnosed(const Hidden& hidden) { return diagnosed(runs(hidden), "repeat == 0", "repeat == 1"); }
  diagnosis::Diagnosis diagnosed(const std::vector<calib::SingleJoint>& joints, const std::string& fit,
                                 const std::string& score) {
    test::write_bench(folder_, joints);
    diagnosis::DiagnoseOptions options;
    options.model = healthy().actuator;
    options.fit = fit;
    options.score = score;
    return diagnosis::diagnose(bench::read_bench(folder_), options, &runs_);
  }
  /// Mean absolute error of the held-out runs with this actuator [rad].
  double held_out_rad(const calib::JointModel& model) const {
    return calib::total(calib::errors(model, runs_.scored, 1)).mean_absolute_rad();
  }
  void TearDown() override { fs::remove_all(folder_); }

  const fs::path folder_ = fs::temp_directory_path() / ("pmg_residual_torque_" + std::to_string(getpid()));
  diagnosis::DiagnosedRuns runs_;
};

TEST_F(ResidualTorque, OfALatchIsLearntAndTheVerdictStaysUnexplained) {
  const diagnosis::Diagnosis found = diagnosed(latch_Nm);
  EXPECT_EQ(found.verdict, evidence::Verdict::kUnexplained);
  ASSERT_TRUE(found.residual_extension);
  const Extension& extension = *found.residual_extension;
  EXPECT_TRUE(extension.kept) << extension.why_not;
  EXPECT_EQ(text(extension.term), "torque over position_rad");
  EXPECT_LT(extension.held_out_after.value, 0.5 * extension.held_out_before.value);
  EXPECT_EQ(extension.held_out_after.value, found.held_out_after.value) << "the result is the model with it";
  EXPECT_GT(extension.term.at(0.3, 0.0).value_Nm, 0.2) << "it pulls towards 0.4 rad from below";
  EXPECT_LT(extension.term.at(0.5, 0.0).value_Nm, -0.2) << "and from above";
}

TEST_F(ResidualTorque, GoesThroughMotorYamlIntoASimulationThatIsBetter) {
  const diagnosis::Diagnosis found = diagnosed(latch_Nm);
  fs::create_directories(folder_);
  std::ofstream(folder_ / "motor.yaml") << sim::motor_yaml({{"joint", found.after.actuator}});
  calib::JointModel read = found.after, without = found.after;
  read.actuator = sim::read_motor_file(folder_ / "motor.yaml").at("joint");
  EXPECT_EQ(read.actuator, found.after.actuator) << "every number";
  without.actuator.residual_torque = {};
  const double nothing_done_rad = held_out_rad(healthy());
  EXPECT_LT(held_out_rad(read), 0.5 * nothing_done_rad);
  EXPECT_LT(held_out_rad(read), 0.5 * held_out_rad(found.before)) << "the base model, refitted";
  EXPECT_LT(held_out_rad(read), 0.5 * held_out_rad(without));
}

TEST_F(ResidualTorque, OfARubbingCableIsFriction) {
  const diagnosis::Diagnosis found = diagnosed(rub_Nm);
  EXPECT_EQ(found.verdict, evidence::Verdict::kUnexplained);
  ASSERT_TRUE(found.residual_extension);
  EXPECT_TRUE(found.residual_extension->kept);
  EXPECT_EQ(found.residual_extension->term.acts_as, model::ResidualActs::kFriction);
  EXPECT_LT(found.residual_extension->held_out_after.value, 0.5 * found.residual_extension->held_out_before.value);
}

TEST_F(ResidualTorque, IsSaidOnPageAndInJson) {
  const diagnosis::Diagnosis found = diagnosed(latch_Nm);
  const nlohmann::ordered_json json = diagnosis::diagnosis_json(found).at("residual_extension");
  EXPECT_EQ(json.at("kept"), true);
  EXPECT_EQ(json.at("quantities"), nlohmann::json::array({"position_rad"}));
  EXPECT_LT(json.at("held_out_error_after"), json.at("held_out_error_before"));
  EXPECT_EQ(json.at("values_Nm").size(), found.residual_extension->term.count());
  const std::string html = diagnosis_page::page_of(bench::read_bench(folder_), found, runs_, 1).html();
  EXPECT_NE(html.find("residual torque over position_rad [Nm]"), std::string::npos);
}

TEST_F(ResidualTorque, IsNotLookedForWhereNothingIsUnexplained) {
  EXPECT_FALSE(diagnosed([](double, double) { return 0.0; }).residual_extension);
}

TEST_F(ResidualTorque, ThatTheRecordingsHeldOutAreNoBetterForIsNotKept) {
  const std::vector<calib::SingleJoint> joints = runs(latch_Nm, kNoise_rad, [](double, double) { return 0.0; });
  const diagnosis::Diagnosis found = diagnosed(joints, "kp_Nm_per_rad == 15", "kp_Nm_per_rad == 25");
  ASSERT_TRUE(found.residual_extension);
  const Extension& extension = *found.residual_extension;
  EXPECT_FALSE(extension.kept);
  EXPECT_EQ(extension.why_not, "the recordings held out are simulated no better with it");
  EXPECT_GT(extension.gain.deviations, 2.0) << "the fitted recordings want it";
  EXPECT_EQ(extension.held_out_after.value, extension.held_out_before.value);
  EXPECT_EQ(found.after.actuator.residual_torque.count, 0);
}

/// An extension of a joint in memory, whose model is the healthy one.
Extension extended(const std::vector<calib::SingleJoint>& joints, const Options& options) {
  const bench::Bench bench = test::pd_bench(true);
  const effects::NestedFit fit(joints, 1);
  const effects::BenchScale scale = effects::scale_of(bench, fit.runs(), healthy());
  const calib::Unknowns unknowns = {effects::unknown("friction.coulomb_Nm", bench, scale)};
  effects::NestedModel model = fit.fit(healthy(), unknowns, 5);
  fit.linearise(model);
  const fitting::HeldOut held_out = fit.held_out_squares(model, effects::folds(fit));
  return extend({bench, fit, fit, model, held_out, scale}, options);
}

TEST(ResidualExtension, OfNoiseIsNotKept) {
  const std::vector<calib::SingleJoint> joints = runs([](double, double) { return 0.0; }, 5e-3);
  Options eager;
  eager.least_deviations = -1e9;  // whatever its deviations: left-out recordings decide
  const Extension extension = extended(joints, eager);
  EXPECT_FALSE(extension.kept);
  EXPECT_FALSE(extension.why_not.empty());
  EXPECT_EQ(extension.model.actuator.residual_torque, model::ResidualTorque{});
}

TEST(ResidualExtension, IsNoLargerThanItsBound) {
  const std::vector<calib::SingleJoint> joints = runs(latch_Nm);
  Options options;
  options.bound_of_peak = 0.01;
  const effects::BenchScale scale = effects::scale_of(test::pd_bench(true), joints, healthy());
  const Extension extension = extended(joints, options);
  for (const double value_Nm : extension.term.values_Nm) EXPECT_LE(std::abs(value_Nm), 0.01 * scale.torque_peak_Nm);
}

TEST(RolloutFit, OfAStartThatThrowsTheJointOffItsRecordingIsAsGoodAsOfARightOne) {
  const std::vector<calib::SingleJoint> joints = runs(latch_Nm);
  const bench::Bench bench = test::pd_bench(true);
  const effects::NestedFit fit(joints, 1);
  const effects::BenchScale scale = effects::scale_of(bench, fit.runs(), healthy());
  const effects::NestedModel model = fit.fit(healthy(), {effects::unknown("friction.coulomb_Nm", bench, scale)}, 5);
  const MissingTorque missing = missing_torque(bench, fit, model.model, scale);
  TorqueFit start = torque_fits(missing, effects::folds(fit), scale.torque_Nm, {}).front();
  ASSERT_EQ(text(start.candidate.term), "torque over position_rad");
  const auto squares = [&] { return rollout_fit(fit, model, start, 0.5 * scale.torque_peak_Nm, 8).value().squares; };
  const double right = squares();
  EXPECT_LT(right, 0.05 * model.squares) << "without it";
  start.amplitudes *= -6.0;
  EXPECT_LT(squares(), 2.0 * right);
}

/// The healthy joint whose friction grows by 2 Nm while it rests for half a second, under slow strokes from rest.
std::vector<calib::SingleJoint> sticking_harder() {
  calib::JointModel truth = healthy();
  model::ResidualTorque& rest = truth.actuator.residual_torque;
  rest.count = 1;
  rest.terms[0].acts_as = model::ResidualActs::kFriction;
  rest.terms[0].axes[0] = {model::ResidualQuantity::kRest, 0.0, 2.0, 9, false};
  for (std::size_t k = 1; k < 9; ++k) rest.terms[0].values_Nm[k] = k == 1 ? 1.2 : 2.0;
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0.0, kNoise_rad);
  std::vector<calib::SingleJoint> joints;
  for (const calib::SingleJoint& joint : test::record(test::pd_bench(true), truth, 4)) {
    bench::BenchRun run = joint.run();
    const double hold_s = 0.35 + 0.15 * static_cast<double>(joints.size()), stroke_s = 0.4;
    for (std::size_t k = 0; k < run.recording.t_s.size(); ++k) {
      const double strokes = run.recording.t_s[k] / (hold_s + stroke_s);
      const double into_s = (strokes - std::floor(strokes)) * (hold_s + stroke_s), way = std::max(0.0, into_s - hold_s);
      run.recording.q_cmd_rad[k] = std::fmod(strokes, 2.0) >= 1.0 ? stroke_s - way : way;
    }
    run.recording.q_rad = calib::SingleJoint(test::pd_bench(true), run, joint.step_s()).rollout(truth);
    for (double& q_rad : run.recording.q_rad) q_rad += noise(random);
    joints.emplace_back(test::pd_bench(true), run, joint.step_s());
  }
  return joints;
}

TEST(ResidualExtension, OfAJointThatSticksHarderTheLongerItRestsIsFrictionOverItsRest) {
  const std::vector<calib::SingleJoint> joints = sticking_harder();
  const Extension extension = extended(joints, {});
  ASSERT_TRUE(extension.kept) << extension.why_not;
  EXPECT_EQ(text(extension.term), "friction over rest_s");
  // Found: 1.2 Nm. Rollouts jump where the joint breaks away, so the fit does not come to its end.
  EXPECT_GT(extension.term.at(0.5, 0.0).value_Nm - extension.term.at(0.0, 0.0).value_Nm, 0.7);
  for (int k = 1; k < extension.term.axes[0].knots; ++k)
    EXPECT_GE(extension.term.values_Nm[static_cast<std::size_t>(k)],
              extension.term.values_Nm[static_cast<std::size_t>(k - 1)]);
  const auto squares = [&](const calib::JointModel& model) {
    return fitting::sum_of_squares(calib::residuals(model, joints, 1));
  };
  EXPECT_LT(squares(extension.model), 0.6 * squares(healthy())) << "found: 0.41";
}

}  // namespace
}  // namespace pmg::residual_torque
