#include "assembly/variation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "assembled_bench.hpp"
#include "fitting/f_distribution.hpp"

namespace pmg::assembly {
namespace {

std::string all(const AssemblyDifferences& found) {
  nlohmann::ordered_json json;
  add_to(json, found);
  return json.dump(1);
}

TEST(FDistribution, AgreesWithTables) {
  EXPECT_NEAR(fitting::f_tail(4.747, 1, 12), 0.05, 1e-4);  // table of R. A. Fisher, F. Yates 1963
  EXPECT_NEAR(fitting::f_tail(5.412, 3, 12), 0.0137, 1e-3);
  EXPECT_NEAR(fitting::f_tail(6.944, 2, 4), 0.05, 1e-4);
  EXPECT_NEAR(fitting::student95(1), 12.706, 1e-3);
  EXPECT_NEAR(fitting::student95(10), 2.228, 1e-3);
  EXPECT_EQ(fitting::f_tail(3.0, 2, 0), 1.0);
}

TEST(Variation, AZeroOffsetOfEachArmIsFoundByTheArm) {
  const std::vector<double> offsets_rad = {0.02, -0.015, 0.03, -0.03};
  const AssemblyDifferences found = arms("sensor.zero_offset_rad", offsets_rad, 4, 1).found();
  ASSERT_EQ(found.varies.size(), 1U) << all(found);
  const Variation& one = found.varies[0];
  EXPECT_EQ(one.parameter, "sensor.zero_offset_rad");
  EXPECT_EQ(one.columns, std::vector<std::string>{"arm"});
  ASSERT_EQ(one.levels.size(), 4U);
  for (std::size_t arm = 0; arm < 4; ++arm) {
    EXPECT_EQ(one.levels[arm].runs, 4U);
    EXPECT_NEAR(one.levels[arm].value.value, offsets_rad[arm], 2e-3);  // noise 1 mrad: four runs tell 0.5 mrad or so
    EXPECT_LT(one.levels[arm].value.low, offsets_rad[arm]);
    EXPECT_GT(one.levels[arm].value.high, offsets_rad[arm]);
  }
  EXPECT_NEAR(one.spread, 0.028, 0.02);  // of the four, with one mean taken off; four arms tell a spread to its half
  EXPECT_FALSE(one.has_mean) << "the mean of the four is near zero beside their spread";
  EXPECT_TRUE(one.or_instead.empty()) << all(found);
}

TEST(Variation, DryFrictionOfEachArmIsFoundBesideOneNumberForAll) {
  const std::vector<double> amounts_Nm = {0.15, -0.15, 0.05, -0.05};
  const AssemblyDifferences found = arms("friction.coulomb_Nm", amounts_Nm, 4, 2).found();
  ASSERT_EQ(found.varies.size(), 1U) << all(found);
  EXPECT_EQ(found.varies[0].parameter, "friction.coulomb_Nm");
  for (std::size_t arm = 0; arm < 4; ++arm)
    EXPECT_NEAR(found.varies[0].levels[arm].value.value, 0.3 + amounts_Nm[arm], 0.03);
  EXPECT_TRUE(found.varies[0].has_mean == false) << "0.3 Nm is what the joint had before";
}

TEST(Variation, TwoParametersMayVaryAtOnce) {
  AssembledBench made({"arm"}, 3);
  const double offsets_rad[] = {0.03, -0.03, 0.0, 0.02}, friction_Nm[] = {0.0, 0.15, -0.15, 0.1};
  for (int arm = 0; arm < 4; ++arm) {
    calib::JointModel truth = changed("sensor.zero_offset_rad", offsets_rad[arm]);
    truth.actuator.friction.coulomb_Nm += friction_Nm[arm];
    for (int i = 0; i < 5; ++i) made.add({truth, i, 1.0 + 0.5 * (i % 3), 1.0, {std::to_string(arm)}});
  }
  const AssemblyDifferences found = made.found();
  ASSERT_EQ(found.varies.size(), 2U) << all(found);
  EXPECT_NE(found.variation_of("sensor.zero_offset_rad"), nullptr);
  EXPECT_NE(found.variation_of("friction.coulomb_Nm"), nullptr);
}

TEST(Variation, ACleanJointHasNone) {
  int alarms = 0;
  for (unsigned seed = 1; seed <= 24; ++seed) {
    AssembledBench made({"arm", "day", "load_mass_kg"}, 100 + seed);
    for (int i = 0; i < 12; ++i) {
      const double gravity_Nm = 1.0 + 0.5 * (i % 3);
      made.add({healthy(),
                i / 2,
                gravity_Nm,
                1.0,
                {std::to_string((i + i / 3) % 3), std::to_string((i / 2 + i) % 2), fmt::format("{}", gravity_Nm)}});
    }
    alarms += made.found().varies.empty() ? 0 : 1;
  }
  EXPECT_EQ(alarms, 0) << "of 24; 0.24 are expected by chance";
}

TEST(Variation, RunsThatScatterAloneAreNoLevels) {
  // Every run has a friction of its own: levels differ as much as the runs of one level. Here only the test of chance
  // decides, and it must take runs as observations: the blocks of one run agree with each other.
  AssemblyOptions options;
  options.chance_without_a_run = 1e9;
  options.least_deviations = -1e9;
  options.least_folds_won = options.amplitude_of_noise = 0.0;
  int alarms = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> scatter(0.0, 0.05);
    AssembledBench made({"arm"}, 200 + seed);
    for (int i = 0; i < 12; ++i)
      made.add({changed("friction.coulomb_Nm", scatter(random)), i % 4, 1.5, 1.0, {std::to_string(i % 3)}});
    alarms += made.found(options).varies.empty() ? 0 : 1;
  }
  EXPECT_LE(alarms, 1) << "of 12; 0.12 are expected by chance";
}

TEST(Variation, OneRunAloneMakesNoLevel) {
  // Arm c moved well once, with much friction. Its other runs hardly move: they scatter little, whatever its friction.
  AssembledBench made({"arm"}, 4);
  for (int i = 0; i < 10; ++i) made.add({healthy(), i % 5, 1.5, 1.0, {i % 2 == 0 ? "a" : "b"}});
  made.add({changed("friction.coulomb_Nm", 0.3), 0, 1.5, 1.0, {"c"}});
  for (int i = 1; i < 4; ++i) made.add({healthy(), i, 1.5, 0.1, {"c"}});
  EXPECT_TRUE(made.found().varies.empty()) << all(made.found());
}

TEST(Variation, LevelsThatDoNotPredictRunsLeftOutAreNotClaimed) {
  // Without the test of chance: what is left is the rule about runs left out.
  AssemblyOptions options;
  options.chance = options.chance_without_a_run = 1e9;
  options.amplitude_of_noise = 0.0;
  AssemblyOptions no_rule = options;
  no_rule.least_deviations = -1e9;
  no_rule.least_folds_won = 0.0;
  int alarms = 0, without_rule = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const AssembledBench made = arms("friction.coulomb_Nm", {0.0, 0.0, 0.0}, 4, 300 + seed);
    alarms += made.found(options).varies.empty() ? 0 : 1;
    without_rule += made.found(no_rule).varies.empty() ? 0 : 1;
  }
  // Seven parameters at two deviations each: chance alone lets 16 % of clean benches through.
  EXPECT_LE(alarms, 4);
  EXPECT_GE(without_rule, 6) << "of 10: else the rule is not what stops them";
}

TEST(Variation, EveryColumnThatWasTriedCounts) {
  const auto found = [](bool with_day, double chance) {
    AssembledBench made(with_day ? std::vector<std::string>{"arm", "day"} : std::vector<std::string>{"arm"}, 12);
    for (int i = 0; i < 16; ++i) {
      const int arm = i / 4;
      std::vector<std::string> cells = {std::to_string(arm)};
      if (with_day) cells.push_back((i + arm) % 2 == 0 ? "Monday" : "Friday");
      made.add({changed("friction.coulomb_Nm", arm % 2 == 0 ? 0.1 : -0.1), i % 4, 1.5, 1.0, cells});
    }
    AssemblyOptions options;
    options.chance = chance;
    return made.found(options).varies;
  };
  const std::vector<Variation> alone = found(false, 0.01);
  ASSERT_EQ(alone.size(), 1U);
  EXPECT_EQ(found(false, 1.5 * alone[0].chance).size(), 1U);
  EXPECT_TRUE(found(true, 1.5 * alone[0].chance).empty()) << "twice as many tests were made";
}

TEST(Variation, WhatIsSmallBesideTheNoiseIsNotClaimed) {
  AssembledBench made({"arm"}, 11, 0.02);  // noise of 20 mrad
  for (int arm = 0; arm < 4; ++arm) {
    const double amount_Nm = arm % 2 == 0 ? 0.05 : -0.05;
    for (int i = 0; i < 10; ++i)
      made.add({changed("friction.coulomb_Nm", amount_Nm), i % 5, 1.5, 1.0, {std::to_string(arm)}});
  }
  EXPECT_TRUE(made.found().varies.empty()) << all(made.found());
  AssemblyOptions all_sizes;
  all_sizes.amplitude_of_noise = 0.0;
  EXPECT_FALSE(made.found(all_sizes).varies.empty());
}

TEST(Variation, ALevelWithFewRunsIsPulledToTheMean) {
  // Six arms with ten runs each tell the spread; the seventh has two runs, and the noise is large.
  constexpr double kNoise_rad = 0.02;
  AssembledBench made({"arm"}, 5, kNoise_rad);
  const double amounts_Nm[] = {0.025, -0.025, 0.02, -0.02, 0.03, -0.03, 0.04};
  for (int arm = 0; arm < 7; ++arm) {
    for (int i = 0; i < (arm < 6 ? 10 : 2); ++i)
      made.add({changed("friction.coulomb_Nm", amounts_Nm[arm]), i % 5, 1.5, 1.0, {std::to_string(arm)}});
  }
  AssemblyOptions options;
  options.amplitude_of_noise = 0.0;  // the noise is large here for the sake of the test
  const AssemblyDifferences found = made.found(options);
  ASSERT_EQ(found.varies.size(), 1U) << all(found);
  const Variation& one = found.varies[0];
  ASSERT_EQ(one.levels.size(), 7U);
  const auto alone = [&](std::size_t first, std::size_t count) {  // the level's own fit, without the others
    const auto begin = made.runs().begin() + static_cast<std::ptrdiff_t>(first);
    const effects::NestedFit fit({begin, begin + static_cast<std::ptrdiff_t>(count)}, 1);
    const effects::BenchScale scale = effects::scale_of(made.bench(), made.runs(), found.fitted.model);
    const auto unknown = effects::unknown("friction.coulomb_Nm", made.bench(), scale);
    return fit.fit(found.fitted.model, {unknown}, 15).model.actuator.friction.coulomb_Nm - one.mean.value;
  };
  const double few = (one.levels[6].value.value - one.mean.value) / alone(60, 2);
  double pulled_Nm = 0.0, alone_Nm = 0.0;
  for (std::size_t arm = 0; arm < 6; ++arm) {
    pulled_Nm += std::abs(one.levels[arm].value.value - one.mean.value);
    alone_Nm += std::abs(alone(10 * arm, 10));
  }
  EXPECT_LT(few, 0.95) << all(found);
  EXPECT_GT(few, 0.0);
  EXPECT_GT(pulled_Nm / alone_Nm, few + 0.02) << "ten runs are believed more than two";
  const auto wide = [&](std::size_t arm) { return one.levels[arm].value.high - one.levels[arm].value.low; };
  EXPECT_GT(wide(6), 1.3 * wide(0)) << "two runs tell less than ten";
}

TEST(Variation, ColumnsThatChangeTogetherAreNamedTogether) {
  AssembledBench made({"arm", "servo"}, 6);
  for (int i = 0; i < 16; ++i) {
    const int arm = i / 4;
    const double offsets_rad[] = {0.02, -0.02, 0.03, -0.03};
    made.add({changed("sensor.zero_offset_rad", offsets_rad[arm]),
              i % 4,
              1.5,
              1.0,
              {std::to_string(arm), "s" + std::to_string(arm)}});
  }
  const AssemblyDifferences found = made.found();
  ASSERT_EQ(found.varies.size(), 1U) << all(found);
  EXPECT_EQ(found.varies[0].columns, (std::vector<std::string>{"arm", "servo"}));
  EXPECT_NE(sentence(found.varies[0]).find("arm or servo, which change together"), std::string::npos);
}

/// Loads of 1 to 1 + 0.7 n Nm, each with five runs of a joint made by the function.
template <typename MadeOf>
AssembledBench loads(int count, unsigned seed, MadeOf&& made_of) {
  AssembledBench made({"load_mass_kg"}, seed);
  for (int i = 0; i < 5 * count; ++i) {
    const int load = i % count;
    const double gravity_Nm = 1.0 + 0.7 * load;
    made.add({made_of(load, gravity_Nm), i / count, gravity_Nm, 1.0, {std::to_string(load)}});
  }
  return made;
}

TEST(Variation, FrictionThatDependsOnTheLoadStaysPhysics) {
  for (const int count : {3, 5}) {
    const AssembledBench made = loads(count, 7, [](int, double) {
      calib::JointModel truth = healthy();
      truth.actuator.friction.load_driving = truth.actuator.friction.load_backdriving = 0.15;
      return truth;
    });
    const AssemblyDifferences found = made.found();
    EXPECT_TRUE(found.varies.empty()) << all(found);
    if (count < 5) continue;  // three loads hardly tell a friction of each from scatter
    EXPECT_FALSE(found.not_claimed.empty()) << "without the rule the friction would differ from load to load";
  }
}

TEST(Variation, AFrictionPerLoadThatNoPhysicsExplainsIsFound) {
  const double amounts_Nm[] = {0.15, -0.15, 0.12, -0.1, 0.15};
  const AssembledBench made =
      loads(5, 8, [&](int load, double) { return changed("friction.coulomb_Nm", amounts_Nm[load]); });
  const AssemblyDifferences found = made.found();
  ASSERT_EQ(found.varies.size(), 1U) << all(found);
  EXPECT_EQ(found.varies[0].parameter, "friction.coulomb_Nm");
  EXPECT_EQ(found.varies[0].columns, std::vector<std::string>{"load_mass_kg"});
}

TEST(Variation, TwoLoadsDoNotTellAssembliesFromPhysics) {
  const AssembledBench made =
      loads(2, 9, [](int load, double) { return changed("friction.coulomb_Nm", load == 0 ? -0.15 : 0.15); });
  const AssemblyDifferences found = made.found();
  EXPECT_TRUE(found.varies.empty()) << all(found);
  ASSERT_EQ(found.unused.size(), 1U);
  EXPECT_NE(found.unused[0].why.find("two values"), std::string::npos);
}

TEST(Variation, DifferencesGoToTheRunsOfTheirLevel) {
  const AssembledBench made = arms("sensor.zero_offset_rad", {0.02, -0.02, 0.03, -0.03}, 4, 9);
  const AssemblyDifferences found = made.found();
  ASSERT_EQ(found.varies.size(), 1U);
  std::vector<calib::SingleJoint> runs = made.runs();
  const double before = fitting::sum_of_squares(calib::residuals(found.fitted.model, runs, 1));
  set_differences(runs, made.bench(), found);
  const double after = fitting::sum_of_squares(calib::residuals(found.fitted.model, runs, 1));
  const double noise = 16.0 * 300.0 * 1e-6;  // 16 runs of 300 samples with 1 mrad
  EXPECT_GT(before, 2.0 * noise);
  EXPECT_LT(after, 1.05 * noise);
  const double offset_rad = runs[0].of_run(found.fitted.model).actuator.sensor.zero_offset_rad;
  EXPECT_NEAR(offset_rad, 0.02, 2e-3);
}

}  // namespace
}  // namespace pmg::assembly
