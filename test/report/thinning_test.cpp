#include "report/thinning.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "report/limited_joints.hpp"

namespace pmg::report {
namespace {

constexpr double kTick_s = 0.01, kPause_s = 0.1;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Recording {
  std::vector<double> t_s, wide;
  std::vector<float> narrow;
  Thinning thinning;

  void add(double time_s, double value) {
    t_s.push_back(time_s);
    wide.push_back(value);
    narrow.push_back(static_cast<float>(-value));
    thinning.appended({.t_s = &t_s, .wide = {&wide}, .narrow = {&narrow}}, kPause_s);
  }
};

TEST(Thinning, FewSamplesStayAsTheyAre) {
  Recording recording;
  for (std::size_t i = 0; i + 1 < Thinning::kMost; ++i) recording.add(kTick_s * static_cast<double>(i), std::sin(i));
  ASSERT_EQ(recording.t_s.size(), Thinning::kMost - 1);
  EXPECT_EQ(recording.wide[777], std::sin(777));
  EXPECT_EQ(recording.thinning.widest_pair_s(), 0.0);
}

TEST(Thinning, AnHourKeepsItsPeaksWithinBoundsAndInTheirPlaces) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> small(-1.0, 1.0);
  Recording recording;
  constexpr int kTicks = 360'000;
  std::size_t most = 0;
  for (int tick = 0; tick < kTicks; ++tick) {
    const double value = tick == 7 ? 50.0 : tick == 200'001 ? -60.0 : tick == kTicks - 1 ? 70.0 : small(random);
    recording.add(kTick_s * tick, value);
    most = std::max(most, recording.t_s.size());
  }
  EXPECT_LE(most, Thinning::kMost);
  EXPECT_GT(recording.t_s.size(), Thinning::kMost / 4) << "more than a chart shows";
  EXPECT_TRUE(std::ranges::is_sorted(recording.t_s));
  EXPECT_EQ(recording.t_s.front(), 0.0);
  EXPECT_EQ(recording.t_s.back(), kTick_s * (kTicks - 1));
  const double pair_s = recording.thinning.widest_pair_s();
  EXPECT_LT(pair_s, 1.0);
  for (const auto& [time_s, value] : {std::pair{0.07, 50.0}, std::pair{2000.01, -60.0}, std::pair{3599.99, 70.0}}) {
    const auto found = std::ranges::find(recording.wide, value);
    ASSERT_NE(found, recording.wide.end()) << value;
    const auto place = static_cast<std::size_t>(found - recording.wide.begin());
    EXPECT_NEAR(recording.t_s[place], time_s, pair_s);
    EXPECT_NE(std::ranges::find(recording.narrow, static_cast<float>(-value)), recording.narrow.end());
  }
  for (std::size_t i = 1; i < recording.t_s.size(); ++i)
    ASSERT_LE(recording.t_s[i] - recording.t_s[i - 1], std::max(kTick_s, pair_s) + 1e-9) << "no part is thinner";
}

TEST(Thinning, APauseStaysBetweenPairs) {
  Recording recording;
  for (int tick = 0; tick < 200'000; ++tick) recording.add(kTick_s * tick + (tick >= 100'003 ? 500.0 : 0.0), 1.0);
  std::size_t pauses = 0;
  for (std::size_t i = 1; i < recording.t_s.size(); ++i) {
    if (recording.t_s[i] - recording.t_s[i - 1] < 100.0) continue;
    ++pauses;
    EXPECT_NEAR(recording.t_s[i - 1], kTick_s * 100'002, 1e-6);
    EXPECT_NEAR(recording.t_s[i], kTick_s * 100'003 + 500.0, 1e-6);
  }
  EXPECT_EQ(pauses, 1U);
  EXPECT_LT(recording.thinning.widest_pair_s(), 1.0);
}

TEST(Thinning, PausesEverywhereAreBoundedToo) {
  Recording recording;
  for (int tick = 0; tick < 200'000; ++tick) recording.add(tick, tick % 100);
  EXPECT_LE(recording.t_s.size(), Thinning::kMost);
}

TEST(Thinning, WhatIsNoNumberHidesNoNumber) {
  Recording recording;
  for (int tick = 0; tick < 100'000; ++tick) recording.add(kTick_s * tick, tick % 50 == 0 ? 1.0 : kNone);
  EXPECT_GE(std::ranges::count(recording.wide, 1.0), 2000);
  Recording none;
  for (int tick = 0; tick < 100'000; ++tick) none.add(kTick_s * tick, kNone);
  EXPECT_TRUE(std::ranges::all_of(none.wide, [](double value) { return std::isnan(value); }));
}

TEST(Sampled, CountsAllAndKnowsTheLargest) {
  Sampled sampled;
  for (int i = 0; i < 1'000'000; ++i) sampled.add(i == 4321 ? 1e9 : i % 1000);
  sampled.add(kNone);
  EXPECT_LT(sampled.values().size(), Sampled::kMost);
  EXPECT_NEAR(sampled.each() * static_cast<double>(sampled.values().size()), 1e6, 2.0 * sampled.each());
  EXPECT_EQ(sampled.largest(), 1e9);
  double sum = 0.0;
  for (const double value : sampled.values()) sum += value < 1e9 ? value : 0.0;
  EXPECT_NEAR(sum / static_cast<double>(sampled.values().size()), 499.5, 15.0)
      << "evenly taken; every 32nd of 0, 1, ... 999 has a mean between 492 and 508";
}

TEST(LimitedStretches, AreJoinedWhereThereAreTooManyAndTheLongestIsKnown) {
  LimitedJoints limited;
  pmg_msgs::limited_t message{};
  message.count = 1;
  message.joint = {3};
  constexpr int kTimes = 20'000;  // every second tick of 400 s
  for (int i = 0; i < kTimes; ++i) {
    message.by = {i % 2 == 0 ? pmg_msgs::limited_t::SPEED : pmg_msgs::limited_t::TORQUE};
    limited.add(2.0 * kTick_s * i, message);
  }
  const auto joints = limited.most_first();
  ASSERT_EQ(joints.size(), 1U);
  const LimitedJoint& joint = joints.front();
  EXPECT_LE(joint.stretches.size(), kMostStretches);
  EXPECT_GT(joint.stretches.size(), kMostStretches / 4);
  EXPECT_EQ(joint.stretches.front().from_s, 0.0);
  EXPECT_NEAR(joint.stretches.back().to_s, 2.0 * kTick_s * (kTimes - 1) + kTick_s, 1e-9);
  for (std::size_t i = 1; i < joint.stretches.size(); ++i)
    ASSERT_GT(joint.stretches[i].from_s, joint.stretches[i - 1].to_s);
  EXPECT_TRUE(joint.stretches.front().by[1] && joint.stretches.front().by[2]) << "joined with its neighbour's reason";
  EXPECT_NEAR(joint.longest_s, kTick_s, 1e-9) << "as if they were apart";
  EXPECT_EQ(joint.ticks[1] + joint.ticks[2], kTimes);
}

TEST(Intervals, BeginAndEndWithTheConditionAndAtPauses) {
  Intervals intervals;
  for (int tick = 0; tick < 100; ++tick)
    intervals.add(kTick_s * tick + (tick >= 50 ? 5.0 : 0.0), tick >= 10 && tick != 30 && tick < 60, kPause_s);
  ASSERT_EQ(intervals.all().size(), 3U);
  EXPECT_NEAR(intervals.all()[0].from_s, 0.10, 1e-9);
  EXPECT_NEAR(intervals.all()[0].to_s, 0.30, 1e-9);
  EXPECT_NEAR(intervals.all()[1].from_s, 0.31, 1e-9);
  EXPECT_NEAR(intervals.all()[1].to_s, 0.49, 1e-9);
  EXPECT_NEAR(intervals.all()[2].from_s, 5.50, 1e-9);
  EXPECT_NEAR(intervals.all()[2].to_s, 5.60, 1e-9);
}

}  // namespace
}  // namespace pmg::report
