#include "prepared_plant.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "blind_plants/calibration.hpp"
#include "blind_plants/files.hpp"

namespace pmg::hidden {
namespace {

namespace fs = std::filesystem;

fs::path scratch(const char* name) {
  const fs::path folder = fs::path(testing::TempDir()) / "hidden_plants" / name;
  fs::remove_all(folder);
  return folder;
}

// The truth can be found: nothing but the planted numbers, put into the healthy joint's calibration, brings the
// project's simulation back to what it leaves of the healthy joint. Within half a noise floor: the two simulations
// differ by that.
TEST(PreparedPlant, PlantedNumbersAreAllThatTheModelLacks) {
  for (const std::uint64_t seed : {11ULL, 29ULL, 40ULL}) {  // Coulomb friction, delay, sensor hysteresis
    const PreparedPlant plant = prepare(seed, scratch("truth"));
    const PlantedTruth& truth = plant.truth;
    model::ActuatorParameters model = plant.base;
    ASSERT_EQ(truth.effects.size(), 1U);
    ASSERT_GE(truth.effects.front().moves_floors, 2.0) << truth.effects.front().name;
    for (const auto& [name, value] : truth.effects.front().parameters)
      model::actuator_parameter(name).in(model) = value;
    EXPECT_LT(rollout_error_rad(model, plant.bench, kScoreFilter), truth.healthy_error_rad + 0.5 * truth.floor_rad)
        << truth.effects.front().name;
  }
}

TEST(PreparedPlant, CleanPlantsAreWithinTheNoiseOfTheirCalibration) {
  const PlantedTruth truth = prepare(14, scratch("clean")).truth;
  EXPECT_EQ(truth.kind, PlantKind::kClean);
  EXPECT_LT(truth.error_rad, truth.floor_rad);
}

TEST(PreparedPlant, NothingInTheBenchTellsWhatIsHidden) {
  const PreparedPlant plant = prepare(29, scratch("blind"));
  const std::string effect = plant.truth.effects.front().name;
  for (const auto& entry : fs::recursive_directory_iterator(plant.bench)) {
    EXPECT_NE(entry.path().filename(), "truth.json");
    if (!entry.is_regular_file() || entry.path().parent_path().filename() == "runs") continue;
    std::ifstream stream(entry.path());
    const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    EXPECT_EQ(text.find(effect), std::string::npos) << entry.path();
  }
}

}  // namespace
}  // namespace pmg::hidden
