#include "evaluation/gait.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace pmg::evaluation {
namespace {

using generator::kHip;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Gait, AContactIsAFootThatComesDownAfterASwing) {
  std::vector<bool> loaded(100, true);
  const auto lift = [&](std::size_t from, std::size_t to) {
    std::fill(loaded.begin() + static_cast<std::ptrdiff_t>(from), loaded.begin() + static_cast<std::ptrdiff_t>(to),
              false);
  };
  lift(20, 40);
  lift(45, 48);  // a bounce
  lift(70, 80);
  EXPECT_THAT(initial_contacts(loaded, 0.01), ElementsAre(40U, 80U));
}

TEST(Gait, CyclesOfDifferentLengthAreStretchedOntoEachOther) {
  std::vector<double> values;
  std::vector<std::size_t> contacts = {0};
  for (const int ticks : {90, 110, 100}) {
    for (int k = 0; k < ticks; ++k) values.push_back(std::sin(2.0 * std::numbers::pi * k / ticks));
    contacts.push_back(values.size());
  }
  values.push_back(0.0);
  const std::vector<double> mean = mean_cycle(values, contacts);
  ASSERT_EQ(mean.size(), kCyclePoints);
  for (std::size_t k = 0; k < kCyclePoints; ++k) {
    // Linear interpolation between ticks is off by at most (2 pi / 90)^2 / 8 = 6e-4.
    EXPECT_NEAR(mean[k], std::sin(2.0 * std::numbers::pi * static_cast<double>(k) / kCyclePoints), 7e-4);
  }
}

TEST(Gait, CyclesSinceAPlannedContactAreNegativeBeforeIt) {
  EXPECT_NEAR(cycles_since_contact(0.02, 0.31, 0.62), 0.02, 1e-12);
  EXPECT_NEAR(cycles_since_contact(0.98, 0.31, 0.62), -0.02, 1e-12);
  EXPECT_NEAR(cycles_since_contact(0.47, 0.81, 0.62), -0.03, 1e-12);
  EXPECT_NEAR(cycles_since_contact(0.03, 0.81, 0.60), -0.48, 1e-12);
}

TEST(Gait, WhenFeetLandIsTheMeanAtTheirContacts) {
  EXPECT_NEAR(mean_at({0.4, -0.06, -0.05, 0.0, -0.02}, {1, 4}), -0.04, 1e-12);
}

/// A test whose both feet move as the norms say, with so much added to each joint.
GaitTest walk_of(std::array<double, kGaitJoints> offset_deg) {
  GaitTest test;
  test.robot = "z1";
  test.norms = generator::built_in_norms();
  test.trial.complete = true;
  for (FootGait& gait : test.feet) {
    gait.cycles = 10;
    gait.period_s = 1.0;
    gait.duty_factor = kPublishedDutyFactor;
    for (std::size_t joint = 0; joint < kGaitJoints; ++joint) {
      std::vector<double> curve = test.norms.deg[joint];
      for (double& value : curve) value += offset_deg[joint];
      gait.measured_deg[joint] = gait.reference_deg[joint] = curve;
      gait.measured[joint] = gait.reference[joint] = generator::agreement(curve, test.norms.deg[joint]);
    }
  }
  return test;
}

TEST(GaitWorth, ACrouchThatHasTheShapesOfAWalkIsMissedByItsAngles) {
  const GaitTest walk = walk_of({0.0, 0.0, 0.0}), crouch = walk_of({25.0, 40.0, 15.0});
  EXPECT_EQ(worth_of(walk).sentence(), "");
  EXPECT_THAT(page_of(walk).html(), HasSubstr("class=\"verdict good\""));
  EXPECT_EQ(worth_of(crouch).grade(), work::Grade::kMissed);
  EXPECT_THAT(worth_of(crouch).sentence(),
              testing::AllOf(HasSubstr("hip flexion is 25 deg RMS"), HasSubstr("knee flexion is 40 deg RMS"),
                             HasSubstr("ankle dorsiflexion is 15 deg RMS"), testing::Not(HasSubstr("shape"))));
  EXPECT_THAT(page_of(crouch).html(), testing::Not(HasSubstr("class=\"verdict good\"")));
  EXPECT_FALSE(to_json(crouch)["limits"]["reached"]);
  EXPECT_EQ(worth_of(walk_of({12.0, 10.0, 7.0})).sentence(), "") << "as far as persons are apart";
}

TEST(GaitWorth, InterruptedFallenOrOfAnotherStrideItIsNotGreen) {
  GaitTest test = walk_of({0.0, 0.0, 0.0});
  test.trial.complete = false;
  EXPECT_EQ(worth_of(test).grade(), work::Grade::kInterrupted);
  EXPECT_THAT(page_of(test).html(), testing::Not(HasSubstr("class=\"verdict good\"")));
  test = walk_of({0.0, 0.0, 0.0});
  test.trial.fell = true;
  EXPECT_EQ(worth_of(test).grade(), work::Grade::kMissed);
  test = walk_of({0.0, 0.0, 0.0});
  test.feet[kRight].duty_factor = 0.8;
  EXPECT_EQ(worth_of(test).grade(), work::Grade::kMissed);
  test = walk_of({0.0, 0.0, 0.0});
  test.feet[kLeft].measured[kHip].correlation = std::nan("");  // a leg that doesn't move
  EXPECT_EQ(worth_of(test).grade(), work::Grade::kMissed);
}

}  // namespace
}  // namespace pmg::evaluation
