// Rules by which effects are taken and left: each test fails where its rule is disabled.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "calib/unknown.hpp"
#include "diagnosis/effect_search.hpp"
#include "diagnosis/rules_fixture.hpp"
#include "effects/alike_numbers.hpp"
#include "effects/catalogue.hpp"
#include "effects/folds.hpp"

namespace pmg::diagnosis {
namespace {

/// Judges trials on runs of a healthy joint.
class Judged : public Rules {
 protected:
  EffectSearch search(JointDiagnosisOptions options = {}, double of_beginning = 0.0) const {
    BaseModel base;
    base.model = truth_;
    base.scale = effects::scale_of(bench_, fit_->runs(), truth_);
    const SearchLimits limits{
        .noise_squares = 4e-8, .healthy_squares = 0.0, .of_noise = 0.0, .of_beginning = of_beginning, .of_rest = 0.0};
    return {bench_, *fit_, base, limits, {}, options, {}};
  }
  /// An extension by one effect, fitted from this value of its first parameter.
  Extension extension(const EffectSearch& search, const std::string& effect, double value, int iterations = 10) const {
    Extension made{{effect}, {}, {}, {}, {}};
    calib::JointModel start = truth_;
    calib::Unknowns unknowns;
    for (const std::string& name : effects::effect(effect).forms.front().parameters)
      unknowns.push_back(effects::unknown(name, bench_, search.base_model().scale));
    calib::set(start, unknowns.front().name, value);
    made.fitted = fit_->fit(start, unknowns, iterations);
    fit_->linearise(made.fitted);
    made.held_out = fit_->held_out_squares(made.fitted, folds(*fit_));
    return made;
  }
  /// All folds are for it.
  static Trial convincing(const std::string& effect, Extension extension) {
    Trial trial{effect, {}, 1.0, std::move(extension)};
    trial.comparison.gain = trial.comparison.log_gain = trial.comparison.folds_won = 1.0;
    trial.comparison.deviations = 100.0;
    return trial;
  }

  const calib::JointModel truth_ = [] {
    calib::JointModel model;
    model.actuator = healthy_actuator();
    return model;
  }();
  /// Runs of a joint that a constant torque pushes: as much with every load, or with two loads another one.
  effects::NestedFit pushed(double torque_Nm, double with_second_load_Nm) const {
    std::vector<calib::SingleJoint> joints;
    for (int load = 0; load < 2; ++load) {
      calib::JointModel truth = truth_;
      truth.actuator.ripple.offset_Nm = load == 0 ? torque_Nm : with_second_load_Nm;
      for (const calib::SingleJoint& joint : test::record(bench_, truth, 4, 2e-4)) {
        bench::BenchRun run = joint.run();
        run.load = {0.03 + 0.01 * load, 1.0 + 0.5 * load, 0.0};
        run.recording.q_rad = calib::SingleJoint(bench_, run, joint.step_s()).rollout(truth);
        joints.emplace_back(bench_, run, joint.step_s());
      }
    }
    return {std::move(joints), 1};
  }

  const effects::NestedFit healthy_{test::record(bench_, truth_, 4, 2e-4), 1},
      pushed_ = pushed(0.2, 0.2), moving_{test::always_moving(bench_, truth_, 4), 1};
  const effects::NestedFit* fit_ = &healthy_;
};

TEST_F(Judged, WhatIsWorseOnOneKindOfRunsLeftOutIsNotTaken) {
  fit_ = &pushed_;
  const EffectSearch at = search();
  Trial trial = convincing("offset", extension(at, "offset", 0.2));
  trial.comparison.of_kind = {{"gain", 9.0, 9.0}, {"load", 0.0, -0.5}};
  EXPECT_EQ(at.objection(trial), "") << "loads can't show it";
  trial.comparison.of_kind[1] = {"load", -3.0, 0.5};
  EXPECT_NE(at.objection(trial).find("runs of a load left out"), std::string::npos);
  trial.comparison.of_kind[1] = {"load", 0.5, -3.0};
  EXPECT_NE(at.objection(trial).find("runs of a load left out"), std::string::npos);
  JointDiagnosisOptions blind;
  blind.worse_deviations = 1e9;
  EXPECT_EQ(search(blind).objection(trial), "") << "the rule alone is against it";
}

TEST_F(Judged, AnEffectWhoseIntervalContainsNeutralIsNotTaken) {
  const EffectSearch at = search();
  EXPECT_NE(at.objection(convincing("offset", extension(at, "offset", 0.001))).find("may as well be 0"),
            std::string::npos);
}

TEST_F(Judged, TwoStrengthsThatDoTheSameAreSureTogetherOrNotAtAll) {
  const EffectSearch at = search();
  Extension alike = extension(at, "load_friction", 0.1, 0);
  alike.fitted = test::with_alike_numbers(alike.fitted, alike.fitted.blocks.size());
  alike.fitted.coordinates = Eigen::Vector2d(0.5, 0.5);
  EXPECT_EQ(at.unsure("load_friction", {}, alike.fitted), "") << "each alone may be none, their sum is not";
  alike.fitted.coordinates = Eigen::Vector2d(0.02, 0.02);
  EXPECT_NE(at.unsure("load_friction", {}, alike.fitted).find("may as well be 0"), std::string::npos);
}

TEST_F(Judged, AnEffectWhoseStrengthEndsAtTheEdgeOfItsRangeIsNotTaken) {
  const EffectSearch at = search();
  EXPECT_NE(at.objection(convincing("direction_friction", extension(at, "direction_friction", 0.95, 0))).find("edge"),
            std::string::npos);
}

TEST_F(Judged, AWaveOfNoMoreThanOnePeriodIsNoCogging) {
  const EffectSearch at = search();
  Extension wave{{"cogging"}, {}, {}, {}, {}};
  calib::JointModel start = truth_;
  start.actuator.ripple.amplitude_Nm = 0.1;
  calib::Unknowns unknowns;
  for (const std::string& name : effects::effect("cogging").forms.front().parameters)
    unknowns.push_back(effects::unknown(name, bench_, at.base_model().scale));
  const auto objection = [&](double order) {
    start.actuator.ripple.order = order;
    wave.fitted = fit_->fit(start, unknowns, 0);
    fit_->linearise(wave.fitted);
    return at.objection(convincing("cogging", wave));
  };
  const double lowest = effects::lowest_order(at.base_model().scale);
  EXPECT_NE(objection(lowest).find("ripple.order ends at the edge"), std::string::npos) << objection(lowest);
  EXPECT_EQ(objection(2.0 * lowest).find("ripple.order"), std::string::npos) << objection(2.0 * lowest);
}

TEST_F(Judged, WhatExplainsNearlyAllOfTheRestMayBeSmallBesideTheBeginning) {
  fit_ = &pushed_;
  const EffectSearch at = search({}, 1e9);
  Trial trial = convincing("offset", extension(at, "offset", 0.2));
  trial.comparison.log_gain = 0.5;
  trial.share_of_rest = 0.9;
  EXPECT_EQ(at.objection(trial), "");
  trial.missed_alone = false;
  EXPECT_NE(at.objection(trial), "") << "a verdict forgives what is left without it";
  trial.share_of_rest = 0.97;
  EXPECT_NE(at.objection(trial), "") << "other effects may mend as much";
  trial.clearly_best = true;
  EXPECT_EQ(at.objection(trial), "");
  trial.share_of_rest = 0.9;
  EXPECT_NE(at.objection(trial), "") << "what mends a form leaves a rest";
  trial.share_of_rest = 0.97;
  trial.comparison.deviations = 5.0;
  EXPECT_NE(at.objection(trial), "") << "not sure enough";
  trial.comparison.deviations = 100.0;
  trial.missed_alone = true;
  trial.share_of_rest = 0.5;
  EXPECT_NE(at.objection(trial), "");
}

TEST_F(Judged, WhatHalvesAResidualThatTheRepeatsExcuseIsNotSmall) {
  fit_ = &pushed_;
  const EffectSearch at = search({}, 1e9);
  const auto objection = [&](double log_gain, double share_of_rest, double deviations) {
    Trial trial = convincing("offset", extension(at, "offset", 0.2));
    trial.missed_alone = false;
    trial.comparison.log_gain = log_gain;
    trial.share_of_rest = share_of_rest;
    trial.comparison.deviations = deviations;
    return at.objection(trial);
  };
  EXPECT_EQ(objection(0.75, 0.9, 8.0), "");
  EXPECT_NE(objection(0.6, 0.9, 8.0), "") << "more than half is left";
  EXPECT_NE(objection(0.75, 0.6, 8.0), "") << "what mends a form leaves a rest";
  EXPECT_NE(objection(0.75, 0.9, 5.0), "") << "not sure enough";
}

/// A joint that swings by itself in a few blocks has a large mean at the beginning, beside which all else is small.
TEST_F(Judged, WhatUsualBlocksShowIsNotSmallBesideAFewLargeOnes) {
  fit_ = &pushed_;
  constexpr double kOfBeginning = 0.1;
  JointDiagnosisOptions options;
  const auto objection = [&](double times_enough, bool missed_alone = true) {
    const EffectSearch at = search(options, kOfBeginning);
    Trial trial = convincing("offset", extension(at, "offset", 0.2));
    trial.share_of_rest = 0.5;
    trial.missed_alone = missed_alone;
    trial.comparison.usual_gain = times_enough * kOfBeginning * kOfBeginning * at.usual_rest(at.base());
    trial.comparison.gain = 1e-12;
    return at.objection(trial);
  };
  options.mean_of_few_blocks = 1.1;  // its mean is 1.2 times its usual square
  EXPECT_EQ(objection(1.1), "");
  EXPECT_NE(objection(0.9).find("small against the initial residual"), std::string::npos);
  EXPECT_NE(objection(1.1, false).find("small against the initial residual"), std::string::npos);
  options.mean_of_few_blocks = 2.0;
  EXPECT_NE(objection(1.1).find("small against the initial residual"), std::string::npos);
}

/// Friction that differs a little by direction has the name of the friction, however sure the difference is.
TEST_F(Judged, AFormWithAFurtherNumberTakesNoNameForALittle) {
  constexpr double kSecondEffectsShare = 0.1;
  for (const double asymmetry : {0.1, 0.9}) {
    calib::JointModel truth = truth_;
    truth.actuator.friction.stribeck_Nm = 0.3, truth.actuator.friction.stribeck_rad_s = 0.3;
    truth.actuator.friction.stribeck_asymmetry = asymmetry;
    const effects::NestedFit runs(test::record(bench_, truth, 6, 2e-4), 1);
    fit_ = &runs;
    const EffectSearch at = search({}, kSecondEffectsShare);
    const Extension plain = extension(at, "stribeck", 0.3);
    Extension by_direction{{"direction_friction"}, {}, {}, {{"direction_friction", 2}}, {}};
    ASSERT_EQ(effects::form_of("direction_friction", by_direction.forms).name, "stribeck");
    calib::Unknowns unknowns;
    for (const std::string& name : effects::form_of("direction_friction", by_direction.forms).parameters)
      unknowns.push_back(effects::unknown(name, bench_, at.base_model().scale));
    by_direction.fitted = runs.fit(plain.fitted.model, unknowns, 10);
    runs.linearise(by_direction.fitted);
    by_direction.held_out = runs.held_out_squares(by_direction.fitted, folds(runs));
    EXPECT_GT(at.compared(plain, by_direction).deviations, 3.0) << "the difference is there";
    EXPECT_EQ(at.is_superfluous(convincing("direction_friction", by_direction), plain, "stribeck"), asymmetry < 0.5);
  }
}

TEST_F(Judged, TwoNamesOfOneTorqueAreNotBothTaken) {
  fit_ = &moving_;
  const EffectSearch at = search();
  Extension both{{"direction_friction", "offset"}, {}, {}, {}, {}};
  calib::JointModel start = truth_;
  start.actuator.friction.asymmetry = 0.4;
  start.actuator.ripple.offset_Nm = 0.02;
  both.fitted = fit_->fit(start,
                          {effects::unknown("friction.asymmetry", bench_, at.base_model().scale),
                           effects::unknown("ripple.offset_Nm", bench_, at.base_model().scale)},
                          0);
  fit_->linearise(both.fitted);
  Trial trial = convincing("offset", both);
  trial.share_of_rest = 0.7;
  EXPECT_NE(at.objection(trial).find("by another name"), std::string::npos);
  trial.share_of_rest = 0.9;
  EXPECT_EQ(at.objection(trial).find("by another name"), std::string::npos) << "friction alone leaves it";
  trial.missed_alone = false;
  EXPECT_NE(at.objection(trial).find("by another name"), std::string::npos) << "a verdict forgives what it leaves";
}

TEST_F(Judged, AStribeckTermOfTheOtherSignMustBeClearlyBetterThanAllOthers) {
  const EffectSearch at = search();
  const std::vector<Trial> round = {convincing("stribeck", extension(at, "stribeck", -0.02, 0)),
                                    convincing("cogging", extension(at, "offset", 0.0, 0))};
  EXPECT_NE(at.aliased(round[0], round).find("other sign"), std::string::npos);
  EXPECT_EQ(at.aliased(round[0], {round[0]}), "") << "nothing else explains it";
  const std::vector<Trial> physical = {convincing("stribeck", extension(at, "stribeck", 0.02, 0)), round[1]};
  EXPECT_EQ(at.aliased(physical[0], physical), "");
}

TEST_F(Judged, AChosenEffectThatDoesNotStandUpToALastLookLeaves) {
  EffectSearch at = search();
  const Settled settled = at.settled(extension(at, "offset", 0.001));
  EXPECT_TRUE(settled.chosen.effects.empty());
  EXPECT_TRUE(settled.with_priors.effects.empty());
  ASSERT_EQ(at.left_out().size(), 1U);
  EXPECT_EQ(at.left_out().front().first, "offset");
  EXPECT_FALSE(at.left_out().front().second.empty());
}

TEST_F(Judged, WhatIsSmallAgainstTheInitialResidualLeavesInTheLastLook) {
  fit_ = &pushed_;
  JointDiagnosisOptions options;
  options.all_of_rest_deviations = 1e9, options.nearly_all_of_rest = 2.0;  // nothing excuses it
  const auto left_out = [&](double of_beginning) {
    EffectSearch at = search(options, of_beginning);
    (void)at.settled(extension(at, "offset", 0.2));
    return at.left_out();
  };
  EXPECT_TRUE(left_out(0.0).empty());
  const auto left = left_out(1e9);
  ASSERT_EQ(left.size(), 1U);
  EXPECT_EQ(left.front(), (std::pair<std::string, std::string>{"offset", EffectSearch::kSmall}));
}

TEST_F(Judged, WhatTakesThePlaceOfAnEffectThatLeftIsFound) {
  fit_ = &pushed_;
  EffectSearch at = search();
  const Extension proxy = extension(at, "zero_offset", 0.05);
  const Extension after = at.leave_out(proxy, "zero_offset", "a proxy");
  EXPECT_EQ(after.effects, std::vector<std::string>{"offset"});
  const Extension without = at.leave_out(after, "offset", "for once");
  for (const char* left : {"offset", "zero_offset"})
    EXPECT_FALSE(effects::contains(without.effects, left)) << left << " was left out";
}

TEST_F(Judged, NothingTakesThePlaceOfAnEffectWithoutWhichLittleRemains) {
  fit_ = &pushed_;
  JointDiagnosisOptions forgiving;
  forgiving.remains_of_noise = 1e9;
  EffectSearch at = search(forgiving);
  EXPECT_TRUE(at.leave_out(extension(at, "zero_offset", 0.05), "zero_offset", "a proxy").effects.empty());
}

TEST_F(Judged, StribeckFrictionThatFadesAtSpeedsThatNobodyRecordedIsNotTaken) {
  const EffectSearch at = search();
  Extension slow = extension(at, "stribeck", 0.2, 0);
  EXPECT_EQ(at.unsure("stribeck", {}, slow.fitted).find("fades"), std::string::npos);
  slow.fitted.model.actuator.friction.stribeck_rad_s = 10.0 * at.base_model().scale.speed_rad_s;
  EXPECT_NE(at.unsure("stribeck", {}, slow.fitted).find("fades"), std::string::npos);
}

/// The rounds look only at viscous friction and a constant torque. Viscous friction is a proxy of the dry friction that
/// is there.
TEST_F(Judged, AtTheEndAProxyIsExchangedForWhatExplainsMore) {
  calib::JointModel dry = truth_;
  dry.actuator.friction.coulomb_Nm = 0.3;
  dry.actuator.ripple.offset_Nm = 0.2;
  const effects::NestedFit runs(test::record(bench_, dry, 4, 2e-4), 1);
  BaseModel base;
  base.model = truth_;
  base.scale = effects::scale_of(bench_, runs.runs(), truth_);
  DirectEvidence evidence;
  evidence.evident = {{"viscous", {0.3}}, {"offset", {0.2}}};
  const SearchLimits limits{
      .noise_squares = 4e-8, .healthy_squares = 0.0, .of_noise = 0.0, .of_beginning = 0.0, .of_rest = 0.0};
  JointDiagnosisOptions options;
  options.fitted_effects = options.fitted_pairs = 0.0;
  options.least_deviations = options.least_folds_won = 0.0;  // beside a wrong effect a right one gains little
  options.worse_deviations = 1e9;
  const auto chosen = [&] {
    EffectSearch at(bench_, runs, base, limits, evidence, options, {});
    const std::vector<std::string> effects = at.choose().effects;
    return std::set<std::string>(effects.begin(), effects.end());
  };
  EXPECT_EQ(chosen(), (std::set<std::string>{"coulomb", "offset"}));
  options.exchanged_effects = 0.0;
  EXPECT_EQ(chosen(), (std::set<std::string>{"offset", "viscous"}));
}

/// The acceleration limit of a profile smooths commands nearly as a delay does.
TEST_F(Judged, ADelayBesideARateLimitIsNoProfile) {
  calib::JointModel late = truth_;
  late.actuator.command.rate_limit_rad_s = 1.5;
  late.actuator.command.delay_s = 0.004;
  const effects::NestedFit runs(test::record(bench_, late, 6, 2e-4), 1);
  fit_ = &runs;
  JointDiagnosisOptions options;
  options.fitted_effects = 4.0, options.exchanged_effects = 2.0;
  EffectSearch at = search(options);
  const Extension found = at.choose();
  EXPECT_EQ(std::set<std::string>(found.effects.begin(), found.effects.end()),
            (std::set<std::string>{"delay", "rate_limit"}));
  EXPECT_EQ(effects::form_of("rate_limit", found.forms).name, "command");
}

/// A joint with dry friction and a constant torque. While the friction is missing, the torque does not explain nearly
/// all of the rest.
class OnTrial : public Judged {
 protected:
  OnTrial() {
    fit_ = &runs_;
    options_.fitted_effects = 3.0, options_.exchanged_effects = options_.fitted_pairs = 0.0;
    options_.remains_of_beginning = 1.0;  // a verdict forgives all
    options_.nearly_all_of_rest = 0.98, options_.all_of_rest = 2.0;
  }
  /// The chosen effects, after a search that has left these out.
  std::set<std::string> chosen(const std::vector<std::string>& left_out = {}) const {
    EffectSearch at = search(options_, 1e9);
    for (const std::string& name : left_out) at.leave_out(extension(at, name, 0.0, 0), name, "for once");
    const std::vector<std::string> effects = at.choose().effects;
    return {effects.begin(), effects.end()};
  }

  const effects::NestedFit runs_{[this] {
                                   calib::JointModel dry = truth_;
                                   dry.actuator.friction.coulomb_Nm = 0.12;
                                   dry.actuator.ripple.offset_Nm = 0.4;
                                   return test::record(bench_, dry, 4, 2e-4);
                                 }(),
                                 1};
  JointDiagnosisOptions options_;
};

TEST_F(OnTrial, AnEffectStaysWhereItConvincesInTheEnd) {
  options_.deviations_on_trial = 2.0;
  EXPECT_EQ(chosen(), (std::set<std::string>{"coulomb", "offset"}));
  options_.deviations_on_trial = 1e9;
  EXPECT_EQ(chosen(), (std::set<std::string>{}));
}

TEST_F(OnTrial, NothingIsTakenOnceThreeEffectsWereLeftOut) {
  options_.deviations_on_trial = 2.0;
  EXPECT_EQ(chosen({"zero_offset", "compliance"}), (std::set<std::string>{"coulomb", "offset"}));
  EXPECT_EQ(chosen({"zero_offset", "compliance", "hysteresis"}), (std::set<std::string>{}));
}

/// With most loads a constant torque makes up for another zero. With the heaviest ones, which hold most of the mean
/// square, it does not: there the zero alone is better, and worse in all other blocks.
TEST_F(Judged, WhatIsBetterInTheMeanAndWorseInUsualBlocksIsTakenOnTrial) {
  calib::JointModel truth = truth_;
  truth.actuator.sensor.zero_offset_rad = 0.1;
  truth.actuator.ripple.offset_Nm = -0.08;
  std::vector<calib::SingleJoint> joints;
  for (const calib::SingleJoint& joint : test::record(bench_, truth, 12, 2e-4)) {
    bench::BenchRun run = joint.run();
    const std::size_t number = joints.size();
    run.load = {0.03, number < 9 ? 1.0 : static_cast<double>(number - 5), 0.0};
    run.recording.q_rad = calib::SingleJoint(bench_, run, joint.step_s()).rollout(truth);
    joints.emplace_back(bench_, run, joint.step_s());
  }
  const effects::NestedFit runs(std::move(joints), 1);
  fit_ = &runs;
  JointDiagnosisOptions options;
  options.fitted_effects = 3.0, options.exchanged_effects = options.fitted_pairs = 0.0;
  EffectSearch at = search(options);
  const Trial zero = at.additions(at.base()).front();
  ASSERT_EQ(zero.effect, "zero_offset");
  ASSERT_LT(zero.comparison.deviations, 0.0) << "in usual blocks it is worse";
  const std::vector<std::string> chosen = at.choose().effects;
  EXPECT_EQ(std::set<std::string>(chosen.begin(), chosen.end()), (std::set<std::string>{"zero_offset", "offset"}));
}

TEST_F(Judged, OnTrialAGainNeedNotBeAsSureNorLargeBesideTheBeginningNorInMostFolds) {
  fit_ = &pushed_;
  const EffectSearch at = search({}, 1e9);
  Trial trial = convincing("offset", extension(at, "offset", 0.2));
  trial.share_of_rest = 0.5;
  trial.comparison.deviations = 2.5;
  trial.comparison.folds_won = 0.5;
  EXPECT_NE(at.objection(trial), "");
  trial.on_trial = true;
  EXPECT_EQ(at.objection(trial), "");
  trial.comparison.deviations = 1.5;
  EXPECT_NE(at.objection(trial), "") << "that is nothing";
}

TEST_F(Judged, WhatIsSurelyMissedInFewBlocksIsMissed) {
  std::vector<calib::SingleJoint> joints = test::record(bench_, truth_, 16, 2e-4);
  joints.push_back(pushed_.runs().front());
  const effects::NestedFit runs(std::move(joints), 1);
  fit_ = &runs;
  JointDiagnosisOptions options;
  options.fitted_effects = 1.0, options.all_of_rest_deviations = -100.0;
  EffectSearch at = search(options);
  ASSERT_LT(at.usual_rest(at.base()), 5.0 * 4e-8) << "usual blocks are in order";
  const std::vector<Trial> trials = at.additions(at.base());
  ASSERT_FALSE(trials.empty());
  EXPECT_TRUE(trials.front().missed_alone);
  options.all_of_rest_deviations = 1e9;
  EXPECT_FALSE(search(options).additions(at.base()).front().missed_alone) << "on average only what is sure counts";
}

/// A lag makes up for a hold of the readings, and the spring's numbers for what differs.
TEST_F(Judged, AHoldIsTriedInThePlaceOfALagBesideTheNumbersThatItHas) {
  calib::JointModel held = truth_;
  held.actuator.transmission.stiffness_Nm_per_rad = 40.0;
  held.actuator.transmission.damping_Nm_s_per_rad = 0.1;
  held.actuator.sensor.hold_s = 0.016;
  const effects::NestedFit runs(test::record(bench_, held, 4, 2e-4), 1);
  fit_ = &runs;
  JointDiagnosisOptions options;
  options.exchanged_effects = 0.0;
  EffectSearch at = search(options);
  Extension lags{{"compliance", "sensor_lag"}, {}, {}, {}, {}};
  calib::JointModel start = held;
  start.actuator.sensor.hold_s = 0.0;
  start.actuator.sensor.lag_s = 0.008;
  calib::Unknowns unknowns;
  for (const std::string& effect : lags.effects) {
    for (const std::string& name : effects::form_of(effect, {}).parameters)
      unknowns.push_back(effects::unknown(name, bench_, at.base_model().scale));
  }
  lags.fitted = runs.fit(start, unknowns, 10);
  runs.linearise(lags.fitted);
  lags.held_out = runs.held_out_squares(lags.fitted, folds(runs));
  const std::vector<Trial>& others = at.alternatives(lags, "sensor_lag");
  ASSERT_EQ(others.size(), 1U);
  EXPECT_EQ(others.back().effect, "hold");
  EXPECT_NEAR(others.back().extension.fitted.model.actuator.sensor.hold_s, 0.016, 5e-4);
  EXPECT_GT(at.compared(lags, others.back().extension).deviations, 3.0);
}

/// A shaft that bends behind the sensor stood for the play there, until play came with the sensor on the other side.
TEST_F(Judged, PlayTakesThePlaceOfTheSoftShaftThatStoodForIt) {
  calib::JointModel loose = truth_;
  loose.actuator.transmission.backlash_rad = 0.03;
  loose.actuator.transmission.stiffness_Nm_per_rad = 100.0;
  loose.actuator.transmission.damping_Nm_s_per_rad = 0.2;
  loose.actuator.sensor.on_motor = 1.0;
  const effects::NestedFit runs(test::record(bench_, loose, 4, 2e-4), 1);
  fit_ = &runs;
  const EffectSearch at = search();
  Extension both{{"compliance", "backlash"}, {}, {}, {{"compliance", 3}}, {}};
  ASSERT_EQ(effects::form_of("compliance", both.forms).name, "sensor_before");
  calib::Unknowns unknowns;
  for (const std::string& name : effects::form_of("backlash", {}).parameters)
    unknowns.push_back(effects::unknown(name, bench_, at.base_model().scale));
  both.fitted = runs.fit(loose, unknowns, 4);
  both.held_out = runs.held_out_squares(both.fitted, folds(runs));
  const Extension found = at.without_special_cases(both);
  EXPECT_EQ(found.effects, std::vector<std::string>{"backlash"});
  EXPECT_EQ(effects::form_of("backlash", found.forms).name, "sensor_before");
  EXPECT_NEAR(found.fitted.model.actuator.transmission.backlash_rad, 0.03, 0.002);
}

/// Fitted to both loads it helps. But each load left out tells another story.
TEST_F(Judged, AnEffectThatHelpsInTheSumAndHurtsLoadsLeftOutIsNotTaken) {
  const effects::NestedFit differing = pushed(0.3, 0.09);
  fit_ = &differing;
  JointDiagnosisOptions options;
  options.least_deviations = options.least_folds_won = 0.0;
  const EffectSearch at = search(options);
  Trial trial{"offset", {}, 1.0, extension(at, "offset", 0.2)};
  trial.comparison = at.compared(at.base(), trial.extension);
  EXPECT_GT(trial.comparison.gain, 0.0);
  EXPECT_GT(trial.comparison.log_gain, 0.0);
  EXPECT_NE(at.objection(trial).find("runs of a load left out"), std::string::npos) << at.objection(trial);
  options.worse_deviations = 1e9;
  trial.extension.fitted.blocks.clear();  // what two loads tell so differently is not sure either: no look at that
  EXPECT_EQ(search(options).objection(trial), "") << "the rule alone is against it";
}

TEST_F(Rules, TwoEffectsThatNoSingleOneBetraysAreFoundTogether) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  truth.actuator.sensor.lag_s = 0.02;  // no check looks for a lag
  truth.actuator.ripple.offset_Nm = 0.2;
  const bench::Bench bench = written(test::record(bench_, truth, 4, 2e-4));
  DiagnoseOptions options = given_healthy();
  options.decide_by.fitted_effects = 0.0;              // no effect is tried alone,
  options.decide_by.signatures.friction_share = 10.0;  // and none is evident
  options.decide_by.signatures.sure_deviations = 1e9;
  std::set<std::string> named;
  for (const Cause& cause : diagnose(bench, options).causes) named.insert(cause.effect);
  EXPECT_EQ(named, (std::set<std::string>{"offset", "sensor_lag"}));
  options.decide_by.fitted_pairs = 0.0;
  for (const Cause& cause : diagnose(bench, options).causes) EXPECT_NE(cause.effect, "offset");
}

/// Beside another effect that isn't there.
TEST_F(Rules, AnEffectThatOnlyAPairBetraysIsTakenAlone) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  truth.actuator.sensor.lag_s = 0.02;  // no check looks for a lag
  DiagnoseOptions options = given_healthy();
  options.decide_by.fitted_effects = 0.0;  // no effect is tried alone
  const Diagnosis found = diagnose(written(test::record(bench_, truth, 4, 2e-4)), options);
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_EQ(found.causes.front().effect, "sensor_lag");
}

TEST_F(Judged, APlayThatNobodySeesIsAShaftThatBends) {
  const auto named = [&](double play_rad) {
    calib::JointModel soft = truth_;
    soft.actuator.transmission.backlash_rad = play_rad;
    soft.actuator.transmission.stiffness_Nm_per_rad = 100.0;
    soft.actuator.transmission.damping_Nm_s_per_rad = 0.2;
    const effects::NestedFit runs(test::record(bench_, soft, 4, 2e-4), 1);
    fit_ = &runs;
    const EffectSearch at = search();
    Extension play{{"backlash"}, {}, {}, {{"backlash", 0}}, {}};
    calib::Unknowns unknowns;
    for (const std::string& name : effects::form_of("backlash", play.forms).parameters)
      unknowns.push_back(effects::unknown(name, bench_, at.base_model().scale));
    soft.actuator.transmission.backlash_rad += 2e-5;
    play.fitted = runs.fit(soft, unknowns, 4);
    runs.linearise(play.fitted);
    play.held_out = runs.held_out_squares(play.fitted, folds(runs));
    const Extension found = at.in_special_cases(play);
    fit_ = &healthy_;
    return found.effects;
  };
  EXPECT_EQ(named(0.0), std::vector<std::string>{"compliance"});
  EXPECT_EQ(named(0.03), std::vector<std::string>{"backlash"});
}

TEST_F(Judged, WhatContainsNoOtherEffectHasNoSpecialCase) {
  const EffectSearch at = search();
  EXPECT_FALSE(at.as_special_case(extension(at, "offset", 0.0), "offset"));
}

/// Two names of one torque where friction varies neither with speed nor with load: no recording parts them.
TEST_F(Rules, NamesThatNoRecordingPartsBecomeOneCause) {
  calib::JointModel truth;
  truth.actuator = healthy_actuator();
  truth.actuator.ripple.offset_Nm = 0.02;
  DiagnoseOptions options = given_healthy();
  options.decide_by.apart_share = 1e12;  // every effect that could take the cause's place is a rival
  const Diagnosis found = diagnose(written(test::always_moving(bench_, truth, 4)), options);
  ASSERT_FALSE(found.causes.empty());
  const Cause& cause = found.causes.front();
  std::set<std::string> names = {cause.effect};
  names.insert(cause.same_here.begin(), cause.same_here.end());
  EXPECT_EQ(names, (std::set<std::string>{"direction_friction", "offset"}));
  for (const std::string& other : cause.or_instead) EXPECT_FALSE(names.contains(other)) << other;
  for (const std::string& sentence : cause.evidence)
    EXPECT_EQ(sentence.find("is -"), std::string::npos) << "less than nothing worse is better: " << sentence;
}

TEST(DirectEvidence, FrictionThatLevelsOffIsNoEvidentStribeckFriction) {
  evidence::Signature check;
  check.effect = "stribeck";
  check.agreement = evidence::Agreement::kAgrees;
  check.value = {0.2, 0.15, 0.25};
  EXPECT_TRUE(direct_evidence({check}, {}, 1e-4, 3.0, {}).evident.contains("stribeck"));
  check.value = {-0.2, -0.25, -0.15};
  EXPECT_FALSE(direct_evidence({check}, {}, 1e-4, 3.0, {}).evident.contains("stribeck"));
}

}  // namespace
}  // namespace pmg::diagnosis
