#include "evidence/power.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "calib/unknown.hpp"
#include "diagnosis/random_bench.hpp"
#include "effects/catalogue.hpp"
#include "effects/strengths.hpp"

namespace pmg::evidence {
namespace {

using test::random_bench;
using test::RandomBench;

std::vector<calib::SingleJoint> joints(const RandomBench& made) {
  std::vector<calib::SingleJoint> found;
  for (const bench::BenchRun& run : made.runs) found.emplace_back(made.bench, run, 0.001);
  return found;
}

const Signature& balance(const std::vector<Signature>& checks, const std::string& effect) {
  return *std::find_if(checks.begin(), checks.end(), [&](const Signature& check) {
    return check.effect == effect && check.check == "balance of torques";
  });
}

calib::JointModel with_load_friction(calib::JointModel model, double share) {
  model.actuator.friction.load_driving = model.actuator.friction.load_backdriving = share;
  return model;
}

constexpr unsigned kSeed = 10;  // its check of load-dependent friction is sure that there is none

/// A bench without load-dependent friction, whose check says so.
class Power : public testing::Test {
 protected:
  const RandomBench made_ = random_bench(kSeed);
  const std::vector<calib::SingleJoint> joints_ = joints(made_);
  SignatureOptions options_;
};

TEST_F(Power, ACheckRefutesAStrengthThatItWouldSee) {
  ASSERT_EQ(balance(signatures(made_.bench, made_.runs), "load_friction").agreement, Agreement::kDisagrees);
  CheckPower power(made_.bench, joints_, 0.0, options_);
  EXPECT_TRUE(power.refutes("load_friction", with_load_friction(made_.truth, 0.2), made_.truth));
}

TEST_F(Power, ACheckWithoutThePowerToSeeAStrengthRefutesNothing) {
  CheckPower power(made_.bench, joints_, 0.0, options_);
  EXPECT_FALSE(power.refutes("load_friction", with_load_friction(made_.truth, 1e-4), made_.truth));
}

TEST_F(Power, ACheckThatWouldDenyEvenThisStrengthRefutesNothing) {
  options_.friction_share = 10.0;
  options_.sure_deviations = 1e9;
  CheckPower power(made_.bench, joints_, 0.0, options_);
  EXPECT_FALSE(power.refutes("load_friction", with_load_friction(made_.truth, 0.2), made_.truth));
}

TEST_F(Power, AValueThatTheJointWithoutTheEffectWouldNotGiveRefutesNothing) {
  // The joint has the effect; a threshold that calls any strength too small makes the check disagree.
  const RandomBench has =
      random_bench(kSeed, [](RandomBench& b, std::mt19937&) { b.truth = with_load_friction(b.truth, 0.1); });
  SignatureOptions blind;
  blind.friction_share = 10.0;
  blind.sure_deviations = 1e9;
  ASSERT_EQ(balance(signatures(has.bench, has.runs, blind), "load_friction").agreement, Agreement::kDisagrees);
  const std::vector<calib::SingleJoint> runs = joints(has);
  CheckPower power(has.bench, runs, 0.0, blind);
  EXPECT_FALSE(power.refutes("load_friction", has.truth, with_load_friction(has.truth, 0.0)));
}

TEST_F(Power, TheLikelihoodsRatioDecides) {
  options_.power.refuting_log_ratio = 1e12;
  CheckPower power(made_.bench, joints_, 0.0, options_);
  EXPECT_FALSE(power.refutes("load_friction", with_load_friction(made_.truth, 0.2), made_.truth));
}

TEST_F(Power, ASureValueIsNeverADisagreementHoweverSmallItsShare) {
  const RandomBench has =
      random_bench(kSeed, [](RandomBench& b, std::mt19937&) { b.truth = with_load_friction(b.truth, 0.1); });
  SignatureOptions large_only;
  large_only.friction_share = 10.0;  // nothing is large enough to agree
  const std::vector<Signature> checks = signatures(has.bench, has.runs, large_only);
  const Signature& check = balance(checks, "load_friction");
  EXPECT_GT(std::abs(check.value.value), large_only.sure_deviations * deviation(check));
  EXPECT_EQ(check.agreement, Agreement::kCannotTell) << check.sentence;
}

TEST(SizeConflict, IsSaidWhereCheckAndFitDifferByMoreThanBothMayStray) {
  const auto check = [](double value, double deviation) {
    return Signature{"zero_offset",
                     "balance of torques",
                     Agreement::kAgrees,
                     {value, value - 1.96 * deviation, value + 1.96 * deviation},
                     "rad",
                     ""};
  };
  const PowerOptions options;
  EXPECT_TRUE(size_conflict(check(-0.88, 0.05), {check(0.14, 0.02)}, options));
  EXPECT_FALSE(size_conflict(check(0.15, 0.05), {check(0.14, 0.02)}, options)) << "the same size";
  EXPECT_FALSE(size_conflict(check(-0.88, 0.5), {check(0.14, 0.02)}, options)) << "two of its deviations";
  EXPECT_FALSE(size_conflict(check(0.18, 0.005), {check(0.14, 0.005)}, options)) << "a quarter more is the same size";
  EXPECT_FALSE(size_conflict(check(-0.88, 0.05), {}, options)) << "nothing to compare with";
}

/// Effects whose check measures their parameter, with a strength of each.
TEST(MeasuredStrength, IsTheParameterThatWasPlanted) {
  struct Case {
    const char* effect;
    double value;
    double tolerance;  ///< share of the value
  };
  for (const Case& c : {Case{"load_friction", 0.2, 0.4}, Case{"offset", 0.3, 0.4}, Case{"zero_offset", 0.08, 0.4},
                        Case{"direction_friction", 0.5, 0.5}, Case{"delay", 0.024, 0.15}, Case{"gain", 0.8, 0.2},
                        Case{"rate_limit", 2.0, 0.15}}) {
    const effects::Form& effect = effects::effect(c.effect).forms.front();
    const RandomBench made = random_bench(3, [&](RandomBench& b, std::mt19937&) {
      for (const std::string& parameter : effect.parameters) calib::set(b.truth, parameter, c.value);
    });
    model::ActuatorParameters base = made.truth.actuator;
    for (const Signature& check : signatures(made.bench, made.runs)) {
      if (check.effect != c.effect || check.check != "balance of torques") continue;
      const std::vector<double> found = effects::measured_strength(check, base, 1.0, {});
      ASSERT_EQ(found.size(), effect.parameters.size()) << c.effect;
      for (const double value : found) EXPECT_NEAR(value, c.value, c.tolerance * c.value) << c.effect;
    }
  }
}

}  // namespace
}  // namespace pmg::evidence
