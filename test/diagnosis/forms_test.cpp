// Forms of effects: what the catalogue promises of each, and which of them a diagnosis names or leaves open.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "calib/synthetic_bench.hpp"
#include "calib/unknown.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/diagnosis_json.hpp"
#include "diagnosis_page/diagnosis_page.hpp"
#include "effects/extension.hpp"
#include "effects/folds.hpp"
#include "effects/form_choice.hpp"

namespace pmg::diagnosis {
namespace {

namespace fs = std::filesystem;
using effects::Effect;
using effects::Form;

calib::JointModel dry_joint() { return test::plain_joint(0.05); }

/// A pendulum that a position PD moves, or a voltage servo without a recorded bus; both with temperatures, and with a
/// speed in some commands.
struct Joint {
  explicit Joint(bench::DriveLaw law) : model(dry_joint()) {
    bench = test::pd_bench(true);
    bench.law = law;
    if (law == bench::DriveLaw::kServoVoltage) {
      bench.supply_V = 12.0;
      model.actuator.drive.limit = 1.0;
      model.actuator.drive.torque_per_unit_Nm = 0.25;
      model.actuator.drive.back_emf_s_per_rad = 2.0;
      model.actuator.friction.viscous_Nm_s_per_rad = 0.0;  // the back-EMF brakes as much
    }
    for (const calib::SingleJoint& joint : test::record(bench, model, 4)) {
      bench::BenchRun run = joint.run();
      if (law == bench::DriveLaw::kServoVoltage) run.kp = 8.0;
      run.recording.temp_C.assign(run.recording.t_s.size(), 40.0);
      runs.emplace_back(bench, run, joint.step_s());
    }
  }

  std::vector<std::vector<double>> rollouts(const calib::JointModel& at) const {
    std::vector<std::vector<double>> all;
    for (const calib::SingleJoint& run : runs) all.push_back(run.rollout(at));
    return all;
  }

  bench::Bench bench;
  calib::JointModel model;
  std::vector<calib::SingleJoint> runs;
};

TEST(Forms, EveryStartOfEveryFormCanBeSimulatedAndShows) {
  std::set<std::string> possible;
  for (const bench::DriveLaw law : {bench::DriveLaw::kPositionPd, bench::DriveLaw::kServoVoltage}) {
    const Joint joint(law);
    const auto without = joint.rollouts(joint.model);
    effects::BenchScale scale = effects::scale_of(joint.bench, joint.runs, joint.model);
    scale.quantum_rad = 0.01, scale.switches_off = true;
    for (const Effect& effect : effects::catalogue()) {
      for (const Form& form : effect.forms) {
        bool shows = false;
        for (const std::vector<double>& values : form.starts_at(joint.model, scale)) {
          ASSERT_EQ(values.size(), form.parameters.size()) << effect.name << " " << form.name;
          calib::JointModel with = joint.model;
          for (const effects::FixedValue& fixed : form.fixed) calib::set(with, fixed.parameter, fixed.value);
          for (std::size_t p = 0; p < values.size(); ++p) calib::set(with, form.parameters[p], values[p]);
          std::vector<std::vector<double>> rollouts;
          ASSERT_NO_THROW(rollouts = joint.rollouts(with)) << effect.name << " " << form.name;
          for (const std::vector<double>& q_rad : rollouts)
            ASSERT_TRUE(std::isfinite(q_rad.back())) << effect.name << " " << form.name;
          shows = shows || rollouts != without;
        }
        if (shows) possible.insert(effect.name + "." + form.name);
      }
    }
  }
  for (const Effect& effect : effects::catalogue()) {
    for (const Form& form : effect.forms) EXPECT_TRUE(possible.contains(effect.name + "." + form.name)) << form.name;
  }
}

TEST(Forms, FixedValuesAloneChangeNothing) {
  const Joint joint(bench::DriveLaw::kPositionPd);
  const auto without = joint.rollouts(joint.model);
  for (const Effect& effect : effects::catalogue()) {
    for (const Form& form : effect.forms) {
      calib::JointModel with = joint.model;
      for (const effects::FixedValue& fixed : form.fixed) calib::set(with, fixed.parameter, fixed.value);
      EXPECT_EQ(joint.rollouts(with), without) << effect.name << " " << form.name;
    }
  }
}

/// The form's parameters at their first start, and its fixed values.
calib::JointModel in_form(const Joint& joint, calib::JointModel model, const Form& form) {
  const effects::BenchScale scale = effects::scale_of(joint.bench, joint.runs, joint.model);
  for (const effects::FixedValue& fixed : form.fixed) calib::set(model, fixed.parameter, fixed.value);
  const auto values = form.starts_at(joint.model, scale);
  for (std::size_t p = 0; !values.empty() && p < form.parameters.size(); ++p)
    calib::set(model, form.parameters[p], values.front()[p]);
  return model;
}

/// Fits to the runs of a joint; no fit is made.
struct Fits {
  explicit Fits(const Joint& joint)
      : fit(joint.runs, 1),
        base{joint.model, {}, effects::scale_of(joint.bench, joint.runs, joint.model)},
        compare(fit.blocks(), folds(fit), 1e-8),
        fits(joint.bench, fit, base, compare) {}
  effects::NestedFit fit;
  effects::BaseModel base;
  fitting::BlockComparison compare;
  effects::ExtensionFits fits;
};

TEST(Forms, AnEffectLeavesTheModelInWhateverFormItWas) {
  const Joint joint(bench::DriveLaw::kPositionPd);
  const Fits of(joint);
  for (const Effect& effect : effects::catalogue()) {
    for (const Form& form : effect.forms) {
      const calib::JointModel with = in_form(joint, joint.model, form);
      const calib::JointModel without = of.fits.without(with, effect.name, {}, {});
      EXPECT_EQ(without.actuator, joint.model.actuator) << effect.name << " " << form.name;
      EXPECT_EQ(without.gravity_scale, 1.0);
    }
  }
}

TEST(Forms, WhatAKeptEffectsFormNeedsStays) {
  const Joint joint(bench::DriveLaw::kPositionPd);
  const Fits of(joint);
  const Effect& compliance = effects::effect("compliance");
  ASSERT_EQ(compliance.forms[1].name, "spring_before");
  const calib::JointModel with = in_form(joint, joint.model, compliance.forms[1]);
  const calib::JointModel kept = of.fits.without(with, "backlash", {"compliance"}, {{"compliance", 1}});
  EXPECT_EQ(kept.actuator, with.actuator);
  EXPECT_EQ(of.fits.without(with, "backlash", {"compliance"}, {}).actuator.transmission.friction_on_joint, 0.0)
      << "the first form of compliance doesn't need it";
}

TEST(Forms, ParametersThatAFormFixesAreNotFitted) {
  const Joint joint(bench::DriveLaw::kPositionPd);
  const Fits of(joint);
  std::vector<std::string> names;
  for (const calib::Unknown& u : of.fits.unknowns({"stribeck"}, {{"stribeck", 1}})) names.push_back(u.name);
  EXPECT_EQ(names, (std::vector<std::string>{"friction.stribeck_Nm", "friction.stribeck_rad_s"}));
}

const effects::FormLimits kLimits{
    .apart = {}, .better_deviations = 1.0, .hopeless_deviations = 4.0, .first_iterations = 4, .most_iterations = 10};

/// A fit that ended at a wrong period for lack of another effect doesn't stay there.
TEST(Forms, AHoldIsLookedForAgainBesideAnEffectThatCameLater) {
  Joint joint(bench::DriveLaw::kPositionPd);
  calib::JointModel truth = joint.model;
  truth.actuator.command.update_s = 0.046;
  truth.actuator.ripple.offset_Nm = 0.3;
  joint.runs = test::record(joint.bench, truth, 6, 1e-4);
  const Fits of(joint);
  const effects::Forms forms = {{"hold", 1}};
  calib::JointModel start = joint.model;
  start.actuator.command.update_s = 0.09;
  const effects::Extension ended = of.fits.fitted({"hold", "offset"}, forms, start, 10);
  ASSERT_GT(std::abs(ended.fitted.model.actuator.command.update_s - 0.046), 0.005);
  const effects::StartScreen without(of.fit, of.fits.fitted({"offset"}, {}, joint.model, 10).fitted);
  const effects::Extension found = effects::in_best_form(of.fits, ended, without, "hold", kLimits);
  EXPECT_EQ(effects::form_of("hold", found.forms).name, "commands");
  EXPECT_NEAR(found.fitted.model.actuator.command.update_s, 0.046, 0.046 * 0.046 / 12.0);
}

/// Rollouts jump with both of its numbers: from another size no slope leads there.
TEST(Forms, AFormOfTwoThresholdsIsLookedForInOtherSizes) {
  Joint joint(bench::DriveLaw::kPositionPd);
  calib::JointModel truth = joint.model;
  truth.actuator.drive.dead_band_rad = 0.046;
  truth.actuator.drive.dead_band_wake_rad = 0.046;
  joint.runs = test::record(joint.bench, truth, 6, 1e-4);
  const Fits of(joint);
  calib::JointModel start = joint.model;
  start.actuator.drive.dead_band_rad = 0.07;
  const effects::Extension jumps = of.fits.fitted({"dead_band"}, {}, start, 10);
  const effects::StartScreen without(of.fit, of.fits.fitted({}, {}, joint.model, 10).fitted);
  const effects::Extension found = effects::in_best_form(of.fits, jumps, without, "dead_band", kLimits);
  EXPECT_EQ(effects::form_of("dead_band", found.forms).name, "wakes_later");
  EXPECT_NEAR(found.fitted.model.actuator.drive.dead_band_rad, 0.046, 0.005);
  EXPECT_NEAR(found.fitted.model.actuator.drive.dead_band_wake_rad, 0.046, 0.005);
}

/// A joint whose hidden change is diagnosed from files.
class FormsOfABench : public testing::Test {
 protected:
  Diagnosis diagnosed(const std::function<void(model::ActuatorParameters&)>& hide, double noise_rad = 2e-4,
                      const JointDiagnosisOptions& decide_by = {}) {
    calib::JointModel truth = dry_joint();
    hide(truth.actuator);
    return diagnosed_from(test::record(test::pd_bench(true), truth, 6, noise_rad), decide_by);
  }
  Diagnosis diagnosed_from(const std::vector<calib::SingleJoint>& runs, const JointDiagnosisOptions& decide_by = {}) {
    test::write_bench(folder_, runs);
    DiagnoseOptions options;
    options.model = dry_joint().actuator;
    options.decide_by = decide_by;
    return diagnose(bench_ = bench::read_bench(folder_), options, &runs_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  const fs::path folder_ = fs::temp_directory_path() / ("pmg_forms_" + std::to_string(getpid()));
  bench::Bench bench_;
  DiagnosedRuns runs_;
};

void plant_quadratic(model::ActuatorParameters& p) { p.friction.viscous_quadratic_Nm_s2_per_rad2 = 0.06; }

TEST_F(FormsOfABench, FrictionByTheSquareOfSpeedIsViscousFrictionInThatForm) {
  const Diagnosis found = diagnosed(plant_quadratic);
  ASSERT_EQ(found.causes.size(), 1U);
  const Cause& cause = found.causes.front();
  EXPECT_EQ(cause.effect, "viscous");
  EXPECT_EQ(cause.form, "quadratic");
  EXPECT_TRUE(cause.form_or_instead.empty());
  ASSERT_EQ(cause.parameters.size(), 1U);
  EXPECT_LT(cause.parameters.front().estimate.low, 0.06);
  EXPECT_GT(cause.parameters.front().estimate.high, 0.06);
  EXPECT_EQ(diagnosis_json(found).at("causes").at(0).at("form"), "quadratic");
  EXPECT_NE(
      diagnosis_page::verdict_text(bench_, found, runs_).find("viscous friction, growing with the square of speed"),
      std::string::npos);
}

/// Where the weight is known, these three and a wrong load are four things: gain, torque and readings by one factor.
TEST_F(FormsOfABench, WeightTellsTheScalesOfGainTorqueAndReadingsFromEachOtherAndFromTheLoad) {
  const auto expect = [&](const std::string& form, const std::string& parameter, double planted) {
    SCOPED_TRACE(form);
    const Diagnosis found =
        diagnosed([&](model::ActuatorParameters& p) { model::actuator_parameter(parameter).in(p) = planted; });
    EXPECT_EQ(found.verdict, evidence::Verdict::kFound);
    ASSERT_EQ(found.causes.size(), 1U);
    const Cause& cause = found.causes.front();
    EXPECT_EQ(cause.effect, "gain");
    EXPECT_EQ(cause.form, form);
    EXPECT_TRUE(cause.form_or_instead.empty());
    ASSERT_EQ(cause.parameters.size(), 1U);
    EXPECT_LT(cause.parameters.front().estimate.low, planted);
    EXPECT_GT(cause.parameters.front().estimate.high, planted);
  };
  expect("position", "drive.kp_scale", 0.78);
  expect("torque", "drive.torque_scale", 0.78);
  expect("reading", "sensor.angle_scale", 1.1);
}

TEST_F(FormsOfABench, ACurrentLimitBelowTheKnownOneIsALimitOfTorqueAtAnySpeed) {
  const Diagnosis found = diagnosed([](model::ActuatorParameters& p) { p.drive.stall_torque_Nm = 8.0; });
  ASSERT_EQ(found.causes.size(), 1U);
  const Cause& cause = found.causes.front();
  EXPECT_EQ(cause.effect, "torque_speed");
  const std::vector<std::string>& open = cause.form_or_instead;
  EXPECT_TRUE(cause.form == "torque" || std::ranges::find(open, "torque") != open.end())
      << cause.form << ": a line whose speed without load is far beyond the recorded ones is the same";
  EXPECT_NEAR(cause.parameters.front().estimate.value, 8.0, 0.4);
}

void expect_only_cause(const Diagnosis& found, const std::string& effect, const std::string& form) {
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_EQ(found.causes.front().effect, effect);
  EXPECT_EQ(found.causes.front().form, form);
}

void expect_in_its_interval(const Cause& cause, const std::string& parameter, double planted) {
  for (const evidence::ParameterEstimate& one : cause.parameters) {
    if (one.name != parameter) continue;
    EXPECT_LT(one.estimate.low, planted) << parameter;
    EXPECT_GT(one.estimate.high, planted) << parameter;
    return;
  }
  ADD_FAILURE() << "no " << parameter;
}

TEST_F(FormsOfABench, ABeltIsAComplianceThatGivesWayOtherwiseOnTheWayBack) {
  const Diagnosis found = diagnosed([](model::ActuatorParameters& p) {
    p.transmission.stiffness_Nm_per_rad = 150.0;
    p.transmission.damping_Nm_s_per_rad = 1.5;
    p.transmission.hysteretic_share = 0.6;
    p.transmission.hysteresis_rad = 0.015;
  });
  ASSERT_NO_FATAL_FAILURE(expect_only_cause(found, "compliance", "belt"));
  const Cause& cause = found.causes.front();
  expect_in_its_interval(cause, "transmission.stiffness_Nm_per_rad", 150.0);
  expect_in_its_interval(cause, "transmission.hysteretic_share", 0.6);
  expect_in_its_interval(cause, "transmission.hysteresis_rad", 0.015);
}

/// An arm or a pulley adds the same to every load; a scale adds more to a larger one.
TEST_F(FormsOfABench, WhatTurnsWithEveryLoadIsTheLoadInThatForm) {
  calib::JointModel truth = dry_joint();
  truth.more_inertia_kg_m2 = 0.03;
  truth.more_gravity_Nm = 0.8;
  const Diagnosis found = diagnosed_from(test::record(test::pd_bench(true), truth, 6, 2e-4));
  ASSERT_NO_FATAL_FAILURE(expect_only_cause(found, "load", "adds"));
  const Cause& cause = found.causes.front();
  expect_in_its_interval(cause, calib::kMoreInertia, truth.more_inertia_kg_m2);
  expect_in_its_interval(cause, calib::kMoreGravity, truth.more_gravity_Nm);
}

TEST_F(FormsOfABench, AZeroThatSlippedIsNamedWithTheRecordingsBetweenWhichItDid) {
  calib::JointModel truth = dry_joint();
  truth.zero_slip_rad = -0.04;
  truth.zero_slip_at = 0.5;
  std::vector<calib::SingleJoint> runs;
  for (const calib::SingleJoint& joint : test::record(test::pd_bench(true), truth, 6, 2e-4)) {
    bench::BenchRun run = joint.run();
    run.trajectory = "any";  // not one for each: then before and after the slip are two motions
    runs.emplace_back(test::pd_bench(true), run, joint.step_s());
  }
  const Diagnosis found = diagnosed_from(runs);
  EXPECT_EQ(found.verdict, evidence::Verdict::kFound);
  ASSERT_NO_FATAL_FAILURE(expect_only_cause(found, "zero_offset", "slips"));
  const Cause& cause = found.causes.front();
  expect_in_its_interval(cause, calib::kZeroSlip, truth.zero_slip_rad);
  expect_in_its_interval(cause, calib::kZeroSlipAt, truth.zero_slip_at);
  EXPECT_TRUE(std::ranges::any_of(cause.evidence, [](const std::string& sentence) {
    return sentence.find("after run2.csv and before run3.csv") != std::string::npos;
  }));
}

/// A drive that pushes to one side lets go where it is switched off; a spring doesn't.
TEST_F(FormsOfABench, ATorqueThatEndsWithTheDriveIsTheDrives) {
  for (const bool of_drive : {true, false}) {
    calib::JointModel truth = dry_joint();
    (of_drive ? truth.actuator.drive.offset_Nm : truth.actuator.ripple.offset_Nm) = 0.4;
    const bench::Bench bench = test::pd_bench(true);
    std::vector<calib::SingleJoint> joints;
    for (const calib::SingleJoint& joint : test::record(bench, truth, 6, 2e-4)) {
      bench::BenchRun run = joint.run();
      const std::size_t samples = run.recording.t_s.size();
      for (std::size_t k = 0; k < samples; ++k) run.recording.enabled.push_back(3 * k < 2 * samples);
      run.recording.q_rad = calib::SingleJoint(bench, run, joint.step_s()).rollout(truth);
      joints.emplace_back(bench, run, joint.step_s());
    }
    fs::remove_all(folder_);
    const Diagnosis found = diagnosed_from(joints);
    ASSERT_NO_FATAL_FAILURE(expect_only_cause(found, "offset", of_drive ? "drive" : "constant"));
    EXPECT_TRUE(found.causes.front().form_or_instead.empty());
    expect_in_its_interval(found.causes.front(), of_drive ? "drive.offset_Nm" : "ripple.offset_Nm", 0.4);
  }
}

TEST_F(FormsOfABench, TheSimplestFormStandsWhereItIsTheTruth) {
  const Diagnosis found = diagnosed([](model::ActuatorParameters& p) { p.friction.viscous_Nm_s_per_rad += 0.2; });
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_EQ(found.causes.front().effect, "viscous");
  EXPECT_EQ(found.causes.front().form, "linear");
  EXPECT_TRUE(found.causes.front().form_or_instead.empty());
}

TEST_F(FormsOfABench, TheSimplestFormWinsATie) {
  JointDiagnosisOptions options;
  options.better_form_deviations = options.hopeless_form_deviations = 1e12;  // whatever the folds say is a tie
  options.most_effects = 1.0;  // no other effect mends what the form leaves
  const Diagnosis found = diagnosed(plant_quadratic, 2e-4, options);
  ASSERT_FALSE(found.causes.empty());
  EXPECT_EQ(found.causes.front().effect, "viscous");
  EXPECT_EQ(found.causes.front().form, "linear");
}

TEST_F(FormsOfABench, AFormThatTheNoiseHidesIsLeftOpen) {
  const Diagnosis found = diagnosed(
      [](model::ActuatorParameters& p) {
        p.friction.stribeck_Nm = 0.4;
        p.friction.stribeck_rad_s = 0.5;
        p.friction.stribeck_exponent = 1.0;
      },
      3e-3);  // the whole effect moves the joint by 4 mrad
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_EQ(found.verdict, evidence::Verdict::kFound) << "the cause is known";
  EXPECT_EQ(found.causes.front().effect, "stribeck");
  EXPECT_FALSE(found.causes.front().form_or_instead.empty());
  for (const evidence::ParameterEstimate& p : found.causes.front().parameters) {
    const double truth = p.name == "friction.stribeck_Nm" ? 0.4 : 0.5;
    EXPECT_LT(p.estimate.low, truth) << p.name << ": any open form's value may be right";
    EXPECT_GT(p.estimate.high, truth) << p.name;
  }
}

TEST_F(FormsOfABench, WhatIsLeftOpenIsSaidInPlainWords) {
  JointDiagnosisOptions options;
  options.apart_share = 1e12;  // no form is so much worse
  options.hopeless_form_deviations = 1e12;
  const Diagnosis found = diagnosed(plant_quadratic, 2e-4, options);
  ASSERT_EQ(found.causes.size(), 1U);
  const Cause& cause = found.causes.front();
  EXPECT_EQ(cause.effect, "viscous");
  ASSERT_EQ(cause.form_or_instead, std::vector<std::string>{"linear"});
  EXPECT_EQ(diagnosis_json(found).at("causes").at(0).at("form_or_instead").at(0), "linear");
  EXPECT_NE(diagnosis_page::verdict_text(bench_, found, runs_).find("not told from: growing in proportion to speed"),
            std::string::npos);
}

TEST_F(FormsOfABench, AValueThatAFormFixesIsInTheModel) {
  const Diagnosis found = diagnosed([](model::ActuatorParameters& p) {
    p.friction.stribeck_Nm = 0.4;
    p.friction.stribeck_rad_s = 1.5;
    p.friction.stribeck_exponent = 1.0;
  });
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_EQ(found.causes.front().effect, "stribeck");
  EXPECT_EQ(found.causes.front().form, "exponent_1");
  EXPECT_TRUE(found.causes.front().form_or_instead.empty());
  EXPECT_EQ(found.after.actuator.friction.stribeck_exponent, 1.0);
  EXPECT_EQ(found.before.actuator.friction.stribeck_exponent, 2.0);
}

}  // namespace
}  // namespace pmg::diagnosis
