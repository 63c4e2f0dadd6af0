// A joint that sticks ideally, moved by an integrator of this test: what the model's bristle makes of it is no cause.
#include <cmath>
#include <set>

#include "diagnosis/base_model.hpp"
#include "diagnosis/effect_search.hpp"
#include "diagnosis/rules_fixture.hpp"
#include "effects/catalogue.hpp"

namespace pmg::diagnosis {
namespace {

constexpr double kCoulomb_Nm = 0.4, kViscous_Nm_s = 0.1, kInertiaOfRotor_kg_m2 = 0.01, kStickingNoise_rad = 2e-4;

/// Positions of a joint whose dry friction is Coulomb's: an impulse of at most coulomb h that stops and holds it. Each
/// step of 0.1 ms is exact where the joint rests.
std::vector<double> moved_rad(const bench::BenchRun& run) {
  constexpr double kStep_s = 1e-4;
  const bench::Recording& r = run.recording;
  const double inertia = run.load.inertia_kg_m2 + kInertiaOfRotor_kg_m2;
  std::vector<double> found_rad{0.0};
  double q_rad = 0.0, dq_rad_s = 0.0;
  for (std::size_t k = 0; k + 1 < r.t_s.size(); ++k) {
    const auto steps = std::lround((r.t_s[k + 1] - r.t_s[k]) / kStep_s);
    for (long step = 0; step < steps; ++step) {
      const double torque_Nm = run.kp * (r.q_cmd_rad[k] - q_rad) - (run.kd + kViscous_Nm_s) * dq_rad_s -
                               run.load.gravity_Nm * std::sin(q_rad);
      const double free_rad_s = dq_rad_s + kStep_s * torque_Nm / inertia, most_rad_s = kStep_s * kCoulomb_Nm / inertia;
      dq_rad_s = std::abs(free_rad_s) <= most_rad_s ? 0.0 : free_rad_s - std::copysign(most_rad_s, free_rad_s);
      q_rad += kStep_s * dq_rad_s;
    }
    found_rad.push_back(q_rad);
  }
  return found_rad;
}

class Sticks : public Rules {
 protected:
  std::vector<calib::SingleJoint> ideally(int count) const {
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0.0, kStickingNoise_rad);
    std::vector<calib::SingleJoint> joints;
    for (const calib::SingleJoint& joint : test::record(bench_, {}, count)) {
      bench::BenchRun run = joint.run();
      run.recording.q_rad = moved_rad(run);
      for (double& q_rad : run.recording.q_rad) q_rad += noise(random);
      joints.emplace_back(bench_, run, joint.step_s());
    }
    return joints;
  }
  std::vector<calib::SingleJoint> giving_way(double presliding_rad, int count) const {
    calib::JointModel truth;
    truth.actuator = *given(presliding_rad).model;
    return test::record(bench_, truth, count, kStickingNoise_rad);
  }
  BaseModel base(const std::vector<calib::SingleJoint>& runs, double presliding_rad) const {
    return base_model(bench_, given(presliding_rad).model, effects::NestedFit(runs, 1), {},
                      kStickingNoise_rad * kStickingNoise_rad, 1);
  }
  static DiagnoseOptions given(double presliding_rad) {
    DiagnoseOptions options;
    options.model = healthy_actuator();
    options.model->friction.coulomb_Nm = kCoulomb_Nm;
    options.model->friction.presliding_rad = presliding_rad;
    return options;
  }
};

constexpr double kUsual_rad = model::ActuatorParameters{}.friction.presliding_rad;

class TheBaseModel : public Sticks {};
class Diagnosed : public Sticks {};

/// It explains a third of what is left, as an effect may. So effects are looked for first.
TEST_F(TheBaseModel, HasAConstantFreeThatTheRunsAskForBesideTheEffects) {
  const effects::NestedFit fit(ideally(4), 1);
  const BaseModel usual = base(ideally(4), kUsual_rad);
  EXPECT_EQ(usual.model.actuator.friction.presliding_rad, kUsual_rad);
  constexpr double kNoise = kStickingNoise_rad * kStickingNoise_rad;
  EffectSearch search(bench_, fit, usual, search_limits({}, kNoise, false), {}, {}, {});
  const Settled settled = search.settled(search.base());
  EXPECT_LT(settled.chosen.fitted.model.actuator.friction.presliding_rad, 3e-4);
}

/// What a verdict forgives is still made up for by the numbers of effects.
TEST_F(TheBaseModel, HasAConstantFreeThatShowsHoweverLittleIsLeft) {
  const effects::NestedFit fit(ideally(4), 1);
  constexpr double kForgiven_rad = 1e-3;
  EffectSearch search(bench_, fit, base(ideally(4), kUsual_rad),
                      search_limits({}, kForgiven_rad * kForgiven_rad, false), {}, {}, {});
  ASSERT_LT(search.usual_rest(search.base()), 5.0 * kForgiven_rad * kForgiven_rad);
  EXPECT_LT(search.settled(search.base()).chosen.fitted.model.actuator.friction.presliding_rad, 3e-4);
}

TEST_F(TheBaseModel, GivesWayBeforeItSlidesWhereTheJointDoes) {
  const BaseModel found = base(giving_way(1.5e-3, 4), 1e-4);
  EXPECT_NEAR(found.model.actuator.friction.presliding_rad, 1.5e-3, 2e-4);
  EXPECT_TRUE(found.constants.empty()) << "it is free from then on";
}

TEST_F(TheBaseModel, KeepsAConstantThatTheRunsDoNotAskFor) {
  const BaseModel found = base(giving_way(kUsual_rad, 4), kUsual_rad);
  EXPECT_EQ(found.model.actuator.friction.presliding_rad, kUsual_rad);
  EXPECT_EQ(found.constants.size(), 1U) << "but it is tried in the place of an effect";
}

/// The effect that explains most of the runs, where the joint sticks ideally and the model gives way before it slides.
TEST_F(TheBaseModel, TakesThePlaceOfAnEffectThatAConstantExplains) {
  const effects::NestedFit fit(ideally(4), 1);
  const BaseModel usual = base(giving_way(kUsual_rad, 4), kUsual_rad);
  constexpr double kMissed_rad = 1e-3;  // that much is forgiven: the search doesn't go on
  const SearchLimits limits{.noise_squares = kMissed_rad * kMissed_rad,
                            .healthy_squares = 0.0,
                            .of_noise = 0.0,
                            .of_beginning = 0.0,
                            .of_rest = 0.0,
                            .recordings_have_step = true};  // the step is no reason to leave
  EffectSearch search(bench_, fit, usual, limits, {}, {}, {});
  const std::vector<Trial> trials = search.additions(search.base());
  ASSERT_FALSE(trials.empty());
  const Settled settled = search.settled(trials.front().extension);
  EXPECT_TRUE(settled.chosen.effects.empty()) << trials.front().effect;
  ASSERT_EQ(search.left_out().size(), 1U);
  EXPECT_NE(search.left_out().front().second.find("friction.presliding_rad"), std::string::npos)
      << search.left_out().front().second;
  EXPECT_LT(settled.chosen.fitted.model.actuator.friction.presliding_rad, 3e-4) << "it is free from then on";
}

/// A number of the model that is in no form of the catalogue: a base model fits it, a constant is tried, or the page on
/// the method says that nobody does.
TEST(EachNumberOfTheModel, IsInTheCatalogueOrListed) {
  std::set<std::string> found;
  for (const model::ActuatorParameter& parameter : model::actuator_parameters()) found.emplace(parameter.name);
  for (const effects::Effect& effect : effects::catalogue()) {
    for (const effects::Form& form : effect.forms) {
      for (const std::string& name : form.parameters) found.erase(name);
      for (const effects::FixedValue& fixed : form.fixed) found.erase(fixed.parameter);
    }
  }
  const std::set<std::string> fitted_with_the_base = {"drive.back_emf_s_per_rad", "drive.kd_scale",
                                                      "drive.torque_per_unit_Nm", "transmission.armature_kg_m2"};
  const std::set<std::string> constants = {"drive.brake_when_disabled", "drive.limit", "friction.presliding_rad",
                                           "sensor.velocity_lag_s"};
  std::set<std::string> listed = fitted_with_the_base;
  listed.insert(constants.begin(), constants.end());
  EXPECT_EQ(found, listed) << "a number by default that runs can see looks like an effect";
}

TEST_F(Diagnosed, AnIdealStickIsNoEffect) {
  const Diagnosis found = diagnose(written(ideally(6)), given(kUsual_rad));
  EXPECT_EQ(found.verdict, evidence::Verdict::kNone);
  EXPECT_TRUE(found.causes.empty()) << found.causes.front().effect;
}

TEST_F(Diagnosed, GivingWayBeforeSlidingIsNoEffect) {
  const Diagnosis found = diagnose(written(giving_way(1.5e-3, 6)), given(1e-4));
  EXPECT_EQ(found.verdict, evidence::Verdict::kNone);
  EXPECT_TRUE(found.causes.empty()) << found.causes.front().effect;
}

}  // namespace
}  // namespace pmg::diagnosis
