#include "effects/strengths.hpp"

#include <gtest/gtest.h>

#include "calib/step_choice.hpp"
#include "calib/synthetic_bench.hpp"
#include "calib/unknown.hpp"
#include "effects/integration_part.hpp"

namespace pmg::effects {
namespace {

calib::JointModel healthy() { return test::plain_joint(0.3); }

/// Likeness of two effects with these values on a bench of a joint that has them.
double likeness_of(const char* first, const char* second, const std::vector<std::pair<const char*, double>>& values) {
  const bench::Bench bench = test::pd_bench(true);
  calib::JointModel truth = healthy();
  for (const auto& [name, value] : values) calib::set(truth, name, value);
  const NestedFit fit(test::always_moving(bench, truth, 4), 1);
  const BenchScale scale = scale_of(bench, fit.runs(), truth);
  calib::Unknowns unknowns;
  for (const auto& [name, value] : values) unknowns.push_back(unknown(name, bench, scale));
  NestedModel fitted = fit.fit(truth, unknowns, 0);
  fit.linearise(fitted);
  return likeness(fitted, {}, healthy(), first, second);
}

TEST(Likeness, OneTorqueByTwoNamesIsOneAndItsOppositeCancels) {
  EXPECT_GT(likeness_of("direction_friction", "offset", {{"friction.asymmetry", -0.2}, {"ripple.offset_Nm", 0.06}}),
            0.9);
  EXPECT_LT(likeness_of("direction_friction", "offset", {{"friction.asymmetry", 0.2}, {"ripple.offset_Nm", 0.06}}),
            -0.9);
}

TEST(Likeness, EffectsWithTorquesOfTheirOwnAreNotAlike) {
  const double alike = likeness_of("delay", "offset", {{"command.delay_s", 0.01}, {"ripple.offset_Nm", 0.1}});
  EXPECT_LT(alike * alike, 0.5);
}

TEST(Strengths, AreWhatIsNeutralWithoutTheEffect) {
  EXPECT_EQ(strengths("stribeck", {}), std::vector<std::string>{"friction.stribeck_Nm"});
  EXPECT_EQ(strengths("backlash", {}), std::vector<std::string>{"transmission.backlash_rad"});
  EXPECT_EQ(strengths("compliance", {}), std::vector<std::string>{"transmission.stiffness_Nm_per_rad"});
  EXPECT_EQ(strengths("supply_sag", {{"supply_sag", 1}}), std::vector<std::string>{"drive.supply_sag_per_Nm"});
  EXPECT_EQ(strengths("self_heating", {{"self_heating", 3}}), std::vector<std::string>{"thermal.torque_fade_share"});
  EXPECT_EQ(strengths("direction_friction", {{"direction_friction", 2}}),
            (std::vector<std::string>{"friction.stribeck_asymmetry", "friction.stribeck_Nm"}));
  EXPECT_EQ(strengths("eccentricity", {{"eccentricity", 1}}),
            (std::vector<std::string>{"sensor.eccentricity_rad", "sensor.ellipticity_rad"}));
  for (const Effect& one : catalogue()) {
    for (std::size_t form = 0; form < one.forms.size(); ++form)
      EXPECT_FALSE(strengths(one.name, {{one.name, form}}).empty()) << one.name << ", " << one.forms[form].name;
  }
}

TEST(Strengths, AStribeckTermBelowZeroHasTheOtherSign) {
  calib::JointModel model = healthy();
  model.actuator.friction.stribeck_Nm = -0.1;
  EXPECT_TRUE(has_other_sign("stribeck", model));
  EXPECT_FALSE(has_other_sign("coulomb", model));
  model.actuator.friction.stribeck_Nm = 0.1;
  EXPECT_FALSE(has_other_sign("stribeck", model));
}

TEST(Strengths, StribeckFrictionThatFadesBeyondTheRecordedSpeedsIsNone) {
  calib::JointModel model = healthy();
  model.actuator.friction.stribeck_Nm = 0.1;
  const std::size_t of_stribeck = 2;
  for (const auto& [effect, forms] :
       {std::pair{"stribeck", Forms{}}, std::pair{"direction_friction", Forms{{"direction_friction", of_stribeck}}}}) {
    model.actuator.friction.stribeck_rad_s = 1.0;  // at 2 rad/s all but exp(-4) has faded
    EXPECT_FALSE(fades_unseen(effect, forms, model, 2.0)) << effect;
    model.actuator.friction.stribeck_rad_s = 6.0;  // at 2 rad/s a tenth has
    EXPECT_TRUE(fades_unseen(effect, forms, model, 2.0)) << effect;
  }
  EXPECT_FALSE(fades_unseen("direction_friction", {}, model, 2.0)) << "of dry friction";
  EXPECT_FALSE(fades_unseen("coulomb", {}, model, 2.0));
}

/// rms of the part of the residual that a step of 4 ms may have made.
double part_of_a_coarse_step(const calib::JointModel& truth) {
  const bench::Bench bench = test::pd_bench(true);
  const NestedFit fit(calib::with_step(bench, test::record(bench, truth, 4, 0.0, 1, 2.5e-4), 4e-3), 1);
  return integration_part_rms(bench, fit, healthy(), {});
}

TEST(IntegrationPart, IsAllOfTheResidualWhereTheStepMadeIt) {
  const bench::Bench bench = test::pd_bench(true);
  const NestedFit fit(calib::with_step(bench, test::record(bench, healthy(), 4, 0.0, 1, 2.5e-4), 4e-3), 1);
  const double rms_rad = std::sqrt(fitting::sum_of_squares(fit.residuals(healthy())) / fit.blocks().all_samples());
  // The step's error is of first order only for small steps.
  EXPECT_NEAR(part_of_a_coarse_step(healthy()) / rms_rad, 1.0, 0.3);
}

TEST(IntegrationPart, IsLittleOfAResidualThatAnotherEffectMade) {
  calib::JointModel truth = healthy();
  truth.actuator.ripple.offset_Nm = 0.5;
  EXPECT_LT(part_of_a_coarse_step(truth), 2.0 * part_of_a_coarse_step(healthy()));
}

TEST(Limit, OfAnEffectIsWhereItIsNoneOrAnother) {
  const bench::Bench bench = test::pd_bench(true);
  const auto at = [&](const char* name, double calib::Unknown::*edge, double times) {
    NestedModel model;
    model.unknowns = {calib::unknown(name, bench)};
    calib::set(model.model, name, times * model.unknowns.front().*edge);
    return at_its_limit(model);
  };
  EXPECT_TRUE(at("transmission.stiffness_Nm_per_rad", &calib::Unknown::upper, 1.0)) << "a rigid shaft";
  EXPECT_FALSE(at("transmission.stiffness_Nm_per_rad", &calib::Unknown::upper, 0.9));
  EXPECT_FALSE(at("transmission.stiffness_Nm_per_rad", &calib::Unknown::lower, 1.0));
  EXPECT_TRUE(at("thermal.torque_fade_s", &calib::Unknown::lower, 1.0)) << "a gain";
  EXPECT_FALSE(at("thermal.torque_fade_s", &calib::Unknown::lower, 1.2));
  EXPECT_FALSE(at("thermal.torque_fade_s", &calib::Unknown::upper, 1.0)) << "it fades evenly";
}

}  // namespace
}  // namespace pmg::effects
