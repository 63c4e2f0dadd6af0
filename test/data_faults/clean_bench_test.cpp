// Whatever a joint's physics do, sound data have no faults.
#include <gtest/gtest.h>

#include <ctime>
#include <filesystem>

#include "data_faults/benches.hpp"
#include "data_faults/examine.hpp"
#include "fitting/statistics.hpp"
#include "folders.hpp"

namespace pmg::data_faults {
namespace {

namespace fs = std::filesystem;

std::string text(const std::vector<DataFault>& faults) {
  std::string found;
  for (const DataFault& fault : faults)
    found += fault.where + ": " + fault.correction + "; " + fault.evidence.back() + '\n';
  return found;
}

struct Effect {
  const char* name;
  std::function<void(model::ActuatorParameters& p, double weight_Nm)> set;
  test::Kind kind = test::Kind::kPendulum;
};
std::ostream& operator<<(std::ostream& out, const Effect& effect) { return out << effect.name; }

class SoundData : public testing::TestWithParam<Effect> {};

TEST_P(SoundData, HaveNoFaultsHoweverStrongTheEffect) {
  constexpr unsigned kSeed = 21;
  const test::RandomBench made = test::random_bench(
      kSeed,
      [](test::RandomBench& bench, std::mt19937&) {
        auto& p = bench.truth.actuator;
        GetParam().set(p, p.transmission.armature_kg_m2 / 0.006);  // its armature is 0.2 to 1 % of its torque
      },
      GetParam().kind);
  EXPECT_EQ(text(find_data_faults(made.bench, made.runs, std::nullopt, {}, 1)), "");
}

const std::vector<Effect>& effects() {
  static const std::vector<Effect> kEffects = {
      {"Nothing", [](auto&, double) {}},
      {"NothingOfAServo", [](auto&, double) {}, test::Kind::kServo},
      {"Backlash",
       [](auto& p, double weight_Nm) {
         p.transmission.stiffness_Nm_per_rad = 200.0 * weight_Nm;
         p.transmission.damping_Nm_s_per_rad = 0.2 * weight_Nm;
         p.transmission.backlash_rad = 0.08;
       }},
      {"Stribeck", [](auto& p, double weight_Nm) { p.friction.stribeck_Nm = 0.4 * weight_Nm; }},
      {"Coulomb", [](auto& p, double weight_Nm) { p.friction.coulomb_Nm += 0.5 * weight_Nm; }},
      {"Delay", [](auto& p, double) { p.command.delay_s = 0.035; }},
      {"RateLimit", [](auto& p, double) { p.command.rate_limit_rad_s = 1.5; }},
      {"TorqueSpeed",
       [](auto& p, double weight_Nm) { p.drive.stall_torque_Nm = 1.9 * weight_Nm, p.drive.no_load_rad_s = 3.0; }},
      {"ThermalDrift", [](auto& p, double) { p.thermal.torque_per_K = -0.006, p.thermal.friction_per_K = -0.03; }},
      {"SupplySag", [](auto& p, double weight_Nm) { p.drive.supply_sag_per_Nm = 0.3 / weight_Nm; }, test::Kind::kServo},
      {"SensorLag", [](auto& p, double) { p.sensor.lag_s = 0.02; }},
      {"ZeroOffset", [](auto& p, double) { p.sensor.zero_offset_rad = 0.1; }},
      {"DeadBand", [](auto& p, double) { p.drive.dead_band_rad = 0.08; }},
      {"Gain", [](auto& p, double) { p.drive.kp_scale = 1.6; }},
  };
  return kEffects;
}

INSTANTIATE_TEST_SUITE_P(DataFaults, SoundData, testing::ValuesIn(effects()),
                         [](const auto& effect) { return std::string(effect.param.name); });

TEST(SoundData, HaveNoFaultsWithFeedForwardAndSpeeds) {
  const test::RandomBench made = test::cascade_bench(31);
  EXPECT_EQ(text(find_data_faults(made.bench, made.runs, std::nullopt, {}, 1)), "");
}

TEST(SoundData, HaveNoFaultsUnderTorqueCommandsAndWithRepeats) {
  const test::RandomBench told = test::torque_bench(32), repeated = test::repeated_bench(33);
  EXPECT_EQ(text(find_data_faults(told.bench, told.runs, std::nullopt, {}, 1)), "");
  EXPECT_EQ(text(find_data_faults(repeated.bench, repeated.runs, std::nullopt, {}, 1)), "");
}

TEST(SoundData, OfMeasuredJointsHaveNoFaults) {
  const fs::path data = fs::path(pmg::test::project_folder()) / "../shared/data/bench";
  if (!fs::exists(data)) GTEST_SKIP() << "no measured recordings in " << data;
  for (const auto& [folder, filter] :
       {std::pair{"emps", ""}, {"sts3215", "kp_firmware in 4,16 and repeat == 0"}, {"xl330", ""}}) {
    const Examination found = examine(bench::read_bench(data / folder), {filter}, std::nullopt, {}, 1);
    EXPECT_EQ(text(found.faults), "") << folder;
  }
}

}  // namespace
}  // namespace pmg::data_faults
