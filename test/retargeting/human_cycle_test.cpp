// The promises of a human's cycle: what it keeps of the person, and how it is aligned.
#include "retargeting/human_cycle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "files/config_error.hpp"
#include "generator/gait_task.hpp"
#include "generator/published_gait.hpp"
#include "made_up_people.hpp"

namespace pmg::retargeting {
namespace {
using generator::kClipSamples;

TEST(HumanCycle, HasThePersonsAnglesWhateverTheHeadingTheSizeAndTheRate) {
  constexpr unsigned kSeed = 19;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> leg_m(0.45, 1.1), heading(-3.0, 3.0), rate_hz(60.0, 240.0);
  for (int person = 0; person < 4; ++person) {
    const mocap::test::Walker walker{
        .leg_m = leg_m(random), .period_s = 1.1, .rate_hz = rate_hz(random), .heading_rad = heading(random)};
    const mocap::Recording recording = mocap::test::walk(walker);
    const HumanCycle cycle = human_cycle(recording, test::cycle_of(recording));
    ASSERT_EQ(cycle.pose.size(), kClipSamples);
    EXPECT_NEAR(cycle.mean_velocity.x(), mocap::test::walking_speed(walker), 0.01);
    EXPECT_NEAR(cycle.mean_velocity.y(), 0.0, 0.005);
    EXPECT_NEAR(cycle.mean_velocity.z(), 0.0, 0.005);
    // Detected events are off by a few hundredths of a cycle, alike at both feet: find the shift, then compare curves.
    double best = 1e9;
    for (int shift = -8; shift <= 8; ++shift) {
      double sum = 0.0;
      for (std::size_t k = 0; k < kClipSamples; ++k) {
        const double phase = static_cast<double>(k) / kClipSamples + 0.01 * shift;
        const double expected = generator::published_gait().knee_flexion.at_rad(phase);
        sum += std::pow(knee_flexion_rad(cycle.pose[k].side[0]) - std::abs(expected), 2);
      }
      best = std::min(best, std::sqrt(sum / kClipSamples));
    }
    EXPECT_LT(best, 2.0 * kRadPerDegree) << person;  // smoothing at 10 Hz flattens the swing's peak
  }
}

TEST(HumanCycle, IsTheSameMovementMirroredHalfACycleLaterForASymmetricPerson) {
  const mocap::Recording recording = mocap::test::walk({.rate_hz = 200.0});
  const HumanCycle cycle = human_cycle(recording, test::cycle_of(recording));
  for (std::size_t k = 0; k < kClipSamples; ++k) {
    const std::size_t later = (k + kClipSamples / 2) % kClipSamples;
    EXPECT_NEAR(knee_flexion_rad(cycle.pose[k].side[0]), knee_flexion_rad(cycle.pose[later].side[1]), 0.05) << k;
  }
}

TEST(HumanCycle, PutsEventsOfALimpingPersonWhereClipsHaveThem) {
  mocap::GaitCycle cut = test::cycle_of(mocap::test::walk({}));
  const double moved = cut.contact[1].center;
  cut.contact[1].center = moved + 0.04;  // the right foot lands late
  const HumanCycle even = human_cycle(mocap::test::walk({}), test::cycle_of(mocap::test::walk({})));
  const HumanCycle late = human_cycle(mocap::test::walk({}), cut);
  EXPECT_GT(late.warp_cycles, even.warp_cycles + 0.01);
  EXPECT_NEAR(late.duty_factor, even.duty_factor, 1e-9);
  // What the person does at the late landing, the clip does at phase 0.5: the left knee bends before it lifts.
  const auto left_knee = [](const HumanCycle& cycle, std::size_t k) { return knee_flexion_rad(cycle.pose[k].side[0]); };
  ASSERT_GT(left_knee(even, 54) - left_knee(even, 50), 0.06);
  EXPECT_NEAR(left_knee(late, 50), left_knee(even, 54), 0.02);
}

TEST(HumanCycle, CountsTheSolesPitchFromItsRest) {
  mocap::Recording recording = mocap::test::walk({});
  const mocap::GaitCycle cut = test::cycle_of(recording);
  for (const mocap::Side side :
       {mocap::Side::left, mocap::Side::right}) {  // markers high on the heels, fixed to the feet
    auto& heel = recording.bodies[static_cast<std::size_t>(of_side(mocap::KeyBody::left_heel, side))].position_m;
    const auto& ankle = recording.body(of_side(mocap::KeyBody::left_ankle, side)).position_m;
    for (std::size_t f = 0; f < heel.size(); ++f) heel[f] += 0.6 * (ankle[f] - heel[f]);
  }
  const HumanCycle cycle = human_cycle(recording, cut);
  EXPECT_GT(cycle.flat_to - cycle.flat_from, 0.15);
  EXPECT_GT(cycle.flat_from, 0.0);
  for (std::size_t k = 0; k < kClipSamples; ++k) {
    const double share =
        generator::stance_phase(static_cast<double>(k) / kClipSamples, kLeft, cycle.duty_factor) / cycle.duty_factor +
        0.5;
    if (share < cycle.flat_from || share > cycle.flat_to) continue;
    EXPECT_LT(std::abs(cycle.pose[k].side[0].sole.z()), 0.1) << k;
  }
}

TEST(HumanCycle, RefusesAHopOnBothFeet) {
  const mocap::Recording recording = mocap::test::walk({});
  mocap::GaitCycle cut = test::cycle_of(recording);
  cut.contact[1] = cut.contact[0];
  try {
    human_cycle(recording, cut);
    FAIL() << "no error";
  } catch (const files::ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("expected walking"), std::string::npos) << error.what();
  }
}

TEST(HumanCycle, RefusesARecordingWithoutAFoot) {
  mocap::Recording recording = mocap::test::walk({});
  const mocap::GaitCycle cut = test::cycle_of(recording);
  recording.bodies[static_cast<std::size_t>(mocap::KeyBody::right_toe)] = {};
  try {
    human_cycle(recording, cut);
    FAIL() << "no error";
  } catch (const files::ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("right_toe"), std::string::npos) << error.what();
  }
}

TEST(MirroredRecording, MirroredTwiceIsTheOriginal) {
  mocap::Recording recording = mocap::test::walk({.heading_rad = 0.4, .seed = 3});
  for (mocap::Body& body : recording.bodies) {
    for (std::size_t f = 0; f < body.position_m.size(); ++f)
      body.orientation.emplace_back(Eigen::AngleAxisd(0.01 * static_cast<double>(f), Eigen::Vector3d(1, 2, 2) / 3.0));
  }
  const mocap::Recording once = mirrored(recording), twice = mirrored(once);
  for (std::size_t b = 0; b < mocap::kKeyBodies; ++b) {
    ASSERT_EQ(twice.bodies[b].position_m, recording.bodies[b].position_m);
    for (std::size_t f = 0; f < recording.bodies[b].orientation.size(); ++f)
      ASSERT_EQ(twice.bodies[b].orientation[f].coeffs(), recording.bodies[b].orientation[f].coeffs());
  }
  EXPECT_NE(once.body(mocap::KeyBody::left_knee).position_m, recording.body(mocap::KeyBody::left_knee).position_m);
}

TEST(MirroredRecording, TurnsLeftInstead) {
  const mocap::Recording recording = mocap::test::walk({.heading_rad = 0.4});
  const mocap::Recording image = mirrored(recording);
  const Eigen::Vector3d before = recording.body(mocap::KeyBody::left_hip).position_m[0];
  EXPECT_EQ(image.body(mocap::KeyBody::right_hip).position_m[0], Eigen::Vector3d(before.x(), -before.y(), before.z()));
}

}  // namespace
}  // namespace pmg::retargeting
