// A sensor's zero that slipped between two recordings: where, and by how much.
#include "effects/zero_slip.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "calib/synthetic_bench.hpp"
#include "calib/unknown.hpp"
#include "effects/catalogue.hpp"
#include "effects/start_screen.hpp"

namespace pmg::effects {
namespace {

constexpr int kRuns = 8;
constexpr double kSlip_rad = 0.05, kAt = 5.0 / kRuns;  // between the fifth and the sixth

calib::JointModel joint() { return test::plain_joint(0.05); }

calib::JointModel slipped(double zero_rad = 0.0) {
  calib::JointModel truth = joint();
  truth.actuator.sensor.zero_offset_rad = zero_rad;
  truth.zero_slip_rad = kSlip_rad;
  truth.zero_slip_at = kAt;
  return truth;
}

/// Recordings of a pendulum, of as many trajectories in turn.
std::vector<calib::SingleJoint> session(const calib::JointModel& truth, int trajectories = 2) {
  const bench::Bench bench = test::pd_bench(true);
  std::vector<calib::SingleJoint> found;
  for (const calib::SingleJoint& one : test::record(bench, joint(), kRuns)) {
    bench::BenchRun run = one.run();
    const int trajectory = static_cast<int>(found.size()) % trajectories;
    run.trajectory = std::to_string(trajectory);
    run.recording = test::excitation(trajectory);
    run.recording.q_rad = calib::SingleJoint(bench, run, one.step_s()).rollout(truth);
    found.emplace_back(bench, run, one.step_s());
  }
  return found;
}

TEST(ZeroSlip, ARunHasItFromItsPlaceOn) {
  const std::vector<calib::SingleJoint> runs = session(joint());
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const calib::JointModel model = runs[r].of_run(slipped(0.01));
    EXPECT_DOUBLE_EQ(model.actuator.sensor.zero_offset_rad, r < 5 ? 0.01 : 0.01 + kSlip_rad) << "run " << r;
    EXPECT_EQ(runs[r].of_run(model).actuator.sensor.zero_offset_rad, model.actuator.sensor.zero_offset_rad)
        << "it slips once";
  }
  EXPECT_DOUBLE_EQ(calib::after_the_slip(slipped(0.01)).actuator.sensor.zero_offset_rad, 0.01 + kSlip_rad)
      << "what the joint has from then on";
}

TEST(ZeroSlip, HasTwoRecordingsOnEachSide) {
  const std::vector<double> places = slip_places(session(joint()));
  ASSERT_EQ(places.size(), kRuns - 3U);
  EXPECT_DOUBLE_EQ(places.front(), 2.0 / kRuns);
  EXPECT_DOUBLE_EQ(places.back(), 6.0 / kRuns);
  std::vector<calib::SingleJoint> backwards = session(joint());
  std::reverse(backwards.begin(), backwards.end());
  EXPECT_EQ(slip_places(backwards), places) << "the place counts, not the order in memory";
}

/// Rows that are sorted by trajectory say nothing of when they were recorded.
TEST(ZeroSlip, IsNoneBetweenTrajectories) {
  EXPECT_TRUE(slip_places(session(joint(), kRuns)).empty());
  EXPECT_EQ(slip_places(session(joint(), 4)), std::vector{4.0 / kRuns}) << "all four before and after";
}

TEST(ZeroSlip, IsFoundWhereItHappenedWhateverTheZeroWasBefore) {
  const Effect& family = effect("zero_offset");
  ASSERT_EQ(family.forms.at(1).name, "slips");
  for (const double zero_rad : {0.0, -0.03}) {
    const NestedFit fit(session(slipped(zero_rad)), 1);
    NestedModel current = fit.fit(joint(), {}, 0);
    fit.linearise(current);
    const std::vector<ScreenedStart> starts =
        StartScreen(fit, current).best(family, 1, scale_of(test::pd_bench(true), fit.runs(), joint()));
    ASSERT_FALSE(starts.empty());
    const calib::JointModel& start = starts.front().model;
    EXPECT_DOUBLE_EQ(start.zero_slip_at, kAt);
    EXPECT_NEAR(start.zero_slip_rad, kSlip_rad, 0.1 * kSlip_rad);
    EXPECT_NEAR(start.actuator.sensor.zero_offset_rad, zero_rad, 0.1 * kSlip_rad);
    EXPECT_LT(fitting::sum_of_squares(fit.residuals(start)), 0.05 * current.squares);
  }
}

TEST(ZeroSlip, MovesToItsPlaceFromAnother) {
  const NestedFit fit(session(slipped()), 1);
  calib::JointModel wrong = slipped();
  wrong.zero_slip_at = 3.0 / kRuns;
  EXPECT_DOUBLE_EQ(best_slip_place(fit, wrong), kAt);
  const SlipGap gap = slip_gap(fit.runs(), kAt);
  ASSERT_NE(gap.before, nullptr);
  ASSERT_NE(gap.after, nullptr);
  EXPECT_EQ(gap.before->file, "run4.csv");
  EXPECT_EQ(gap.after->file, "run5.csv");
}

TEST(ZeroSlip, IsNotLookedForInThreeRecordings) {
  std::vector<calib::SingleJoint> few = session(joint());
  few.erase(few.begin() + 3, few.end());
  const BenchScale scale = scale_of(test::pd_bench(true), few, joint());
  EXPECT_TRUE(effect("zero_offset").forms.at(1).starts_at(joint(), scale).empty());
}

}  // namespace
}  // namespace pmg::effects
