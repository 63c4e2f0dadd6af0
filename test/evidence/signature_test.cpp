#include "evidence/signature.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>

#include "diagnosis/random_bench.hpp"

namespace pmg::evidence {
namespace {

using test::Kind;
using test::random_bench;
using test::RandomBench;
using Change = std::function<void(RandomBench&, std::mt19937&)>;

double between(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// Of so many random benches, how many answers each effect's checks gave: agrees, disagrees, can't tell.
using Answers = std::map<std::string, std::map<Agreement, int>>;

Answers ask(int benches, const Change& change, Kind kind = Kind::kPendulum) {
  Answers answers;
  for (int seed = 1; seed <= benches; ++seed) {
    const RandomBench made = random_bench(static_cast<unsigned>(seed), change, kind);
    for (const Signature& check : signatures(made.bench, made.runs)) {
      ++answers[check.effect + ", " + check.check][check.agreement];
    }
  }
  return answers;
}

int agreeing(const Answers& answers, const std::string& effect, const std::string& check = "balance of torques") {
  const auto found = answers.find(effect + ", " + check);
  if (found == answers.end()) return 0;
  const auto agrees = found->second.find(Agreement::kAgrees);
  return agrees == found->second.end() ? 0 : agrees->second;
}

/// With a true rate of 2 %, 12 benches show 2 or more in 2 of 100 cases. More by PMG_SIGNATURE_BENCHES;
/// docs/reference/effects.md has what 150 of each kind gave.
int clean_benches() {
  const char* more = std::getenv("PMG_SIGNATURE_BENCHES");
  return more == nullptr ? 12 : std::max(12, std::atoi(more));
}

int most_false(int benches) { return std::max(1, benches / 50); }

void expect_no_effect_beside(const std::vector<std::string>& real, const Change& change, Kind kind) {
  const int benches = clean_benches();
  const Answers answers = ask(benches, change, kind);
  ASSERT_GE(answers.size(), 15U);
  for (const auto& [check, counts] : answers) {
    if (std::any_of(real.begin(), real.end(), [&](const std::string& one) { return check.starts_with(one); })) continue;
    const auto agrees = counts.find(Agreement::kAgrees);
    EXPECT_LE(agrees == counts.end() ? 0 : agrees->second, most_false(benches)) << check;
  }
}

class CleanBench : public testing::TestWithParam<Kind> {};

TEST_P(CleanBench, ShowsNoEffectButItsFriction) { expect_no_effect_beside({"coulomb", "viscous"}, {}, GetParam()); }

TEST_P(CleanBench, WithoutFrictionShowsNoneAtAll) {
  const Change frictionless = [](RandomBench& made, std::mt19937&) { made.truth.actuator.friction = {}; };
  expect_no_effect_beside({}, frictionless, GetParam());
}

INSTANTIATE_TEST_SUITE_P(AllRigs, CleanBench, testing::Values(Kind::kPendulum, Kind::kHorizontal, Kind::kServo));

struct Planted {
  const char* effect;
  const char* check;
  Change change;
  int fewest;  ///< of 5 benches that show it; weak ones don't
};

std::vector<Planted> planted() {
  constexpr const char* kBalance = "balance of torques";
  return {
      {"delay", kBalance,
       [](RandomBench& b, std::mt19937& r) { b.truth.actuator.command.delay_s = between(r, 0.01, 0.04); }, 4},
      {"delay", "step onset",
       [](RandomBench& b, std::mt19937& r) { b.truth.actuator.command.delay_s = between(r, 0.01, 0.04); }, 3},
      {"rate_limit", kBalance,
       [](RandomBench& b, std::mt19937& r) { b.truth.actuator.command.rate_limit_rad_s = between(r, 1.0, 3.0); }, 4},
      {"load_friction", kBalance,
       [](RandomBench& b, std::mt19937& r) {
         b.truth.actuator.friction.load_driving = b.truth.actuator.friction.load_backdriving = between(r, 0.1, 0.3);
       },
       4},
      {"direction_friction", kBalance,
       [](RandomBench& b, std::mt19937& r) { b.truth.actuator.friction.asymmetry = between(r, 0.3, 0.6); }, 3},
      {"offset", kBalance,
       [](RandomBench& b, std::mt19937& r) {
         b.truth.actuator.ripple.offset_Nm = between(r, 0.5, 2.0) * b.truth.actuator.friction.coulomb_Nm;
       },
       4},
      {"zero_offset", kBalance,
       [](RandomBench& b, std::mt19937& r) { b.truth.actuator.sensor.zero_offset_rad = between(r, 0.04, 0.1); }, 4},
      {"gain", kBalance,
       [](RandomBench& b, std::mt19937& r) { b.truth.actuator.drive.kp_scale = between(r, 0.7, 0.85); }, 3},
      {"load", kBalance, [](RandomBench& b, std::mt19937& r) { b.truth.inertia_scale = between(r, 1.2, 1.5); }, 4},
      {"cogging", kBalance,
       [](RandomBench& b, std::mt19937& r) {
         b.truth.actuator.ripple.amplitude_Nm = between(r, 0.8, 2.0) * b.truth.actuator.friction.coulomb_Nm;
         b.truth.actuator.ripple.order = std::floor(between(r, 4.0, 24.0));
       },
       4},
      {"dead_band", kBalance,
       [](RandomBench& b, std::mt19937& r) { b.truth.actuator.drive.dead_band_rad = between(r, 0.01, 0.04); }, 3},
      {"quantisation", "multiples of one number",
       [](RandomBench& b, std::mt19937& r) { b.truth.actuator.sensor.quantum_rad = between(r, 0.001, 0.005); }, 4},
  };
}

TEST(Signatures, ShowWhatIsPlanted) {
  for (const Planted& plant : planted()) {
    EXPECT_GE(agreeing(ask(5, plant.change), plant.effect, plant.check), plant.fewest)
        << plant.effect << ", " << plant.check;
  }
}

TEST(Signatures, MeasureADelayAndARate) {
  const RandomBench late =
      random_bench(5, [](RandomBench& b, std::mt19937&) { b.truth.actuator.command.delay_s = 0.024; });
  const RandomBench slow =
      random_bench(3, [](RandomBench& b, std::mt19937&) { b.truth.actuator.command.rate_limit_rad_s = 2.0; });
  for (const Signature& check : signatures(late.bench, late.runs)) {
    // A fifth of a sample at 100 Hz; the onset is the foot of a line through the root of a way that isn't quite even.
    if (check.effect == "delay") {
      EXPECT_NEAR(check.value.value, 0.024, check.check == "step onset" ? 5e-3 : 2e-3);
    }
  }
  for (const Signature& check : signatures(slow.bench, slow.runs)) {
    if (check.effect == "rate_limit") {
      EXPECT_NEAR(check.value.value, 2.0, 0.13 * 2.0);  // the grid's step is 12 %
    }
  }
}

TEST(Signatures, SayWhatIsMissing) {
  RandomBench made = random_bench(1);
  made.runs.resize(1);
  bench::Recording& r = made.runs[0].recording;
  for (std::size_t k = 0; k < r.q_rad.size(); ++k) r.q_rad[k] = r.q_cmd_rad[k] = k < 100 ? 0.0 : 1e-4;
  for (const Signature& check : signatures(made.bench, made.runs)) {
    EXPECT_NE(check.agreement, Agreement::kAgrees) << check.effect;
    EXPECT_FALSE(check.sentence.empty()) << check.effect;
  }
  EXPECT_TRUE(signatures(made.bench, {}).empty());
}

TEST(Signatures, TemperaturesOfRowsCountAsThoseOfColumns) {
  RandomBench made = random_bench(
      1, [](RandomBench&, std::mt19937&) {}, Kind::kPendulum);
  const auto told = [&] {
    const std::vector<Signature> checks = signatures(made.bench, made.runs);
    return std::any_of(checks.begin(), checks.end(), [](const Signature& check) {
      return check.effect == "thermal_drift" && check.sentence != "no temperature was recorded";
    });
  };
  for (bench::BenchRun& run : made.runs) run.recording.temp_C.clear(), run.temp_C.reset();
  EXPECT_FALSE(told());
  double temp_C = 20.0;
  for (bench::BenchRun& run : made.runs) run.temp_C = temp_C += 3.0;
  EXPECT_TRUE(told());
}

}  // namespace
}  // namespace pmg::evidence
