// The wiping task: who judges it, what the operator may see of it, and that its whole way from the headset to the towel
// is connected.
#include "teleoperation/wiping.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "teleoperation/person.hpp"
#include "teleoperation/view.hpp"
#include "vr/head_motion.hpp"

namespace pmg::teleoperation {
namespace {

TEST(Wiping, ATowelThatMovedMoreThanAMetreOnTheTableIsDoneAndOneThatLeftItIsNot) {
  EXPECT_EQ(judge_towel({0.0, 0.0, 0.03}, 0.0), std::nullopt);
  EXPECT_EQ(judge_towel({0.0, 0.0, 0.03}, 0.999), std::nullopt);
  EXPECT_EQ(judge_towel({0.0, 0.0, 0.03}, -1.5), std::nullopt) << "the other way";
  EXPECT_EQ(judge_towel({0.0, 0.0, 0.03}, 1.001), End::kDone);
  EXPECT_EQ(judge_towel({0.26, 0.0, 0.03}, 1.5), End::kOffTable);
  EXPECT_EQ(judge_towel({0.0, -1.21, 0.03}, 1.5), End::kOffTable);
  EXPECT_EQ(judge_towel({0.0, 0.0, -0.03}, 1.5), End::kOffTable) << "below its top";
}

TEST(Wiping, APersonLeansAsFarAsTheShareThatIsWanted) {
  for (const double share : {-1.0, -0.4, 0.05, 0.3, 1.0}) {
    const Eigen::Vector2d lean_m = lean_for({0.6 * share, 0.8 * share});
    const auto asks = vr::head_asks({}, {.p_m = {lean_m.x(), lean_m.y(), 0.0}});
    ASSERT_TRUE(asks);
    EXPECT_NEAR(asks->share[kVx], 0.6 * share, 1e-6);
    EXPECT_NEAR(asks->share[kVy], 0.8 * share, 1e-6);
  }
  EXPECT_EQ(lean_for({0.0, 0.01}).norm(), 0.0);
}

/// Seconds until the hands are raised: the whole way from the headset's messages to the arms of a robot that walks.
TEST(Wiping, HandsInAHeadsetsControllersRaiseTheRobotsPalmsThroughTheWholeWay) {
  int asked = 0;
  double highest_m = 0.0;
  const work::Progress ends{.report = {}, .interrupted = [&] { return ++asked > 560; }};
  const TaskResult result =
      run_wiping({"pmg", {}}, {}, WipingPlan::of(0), ends, [&](const LedRobot& robot, const std::string&) {
        const Eigen::Isometry3d T_WL = robot.world().pose("right_wrist_pitch_link");
        highest_m = std::max(highest_m, T_WL.translation().z());
      });
  EXPECT_EQ(result.end, End::kInterrupted);
  EXPECT_EQ(result.stage, "raise the hands");
  EXPECT_GT(highest_m, 0.90) << "they hung at 0.76 m";
}

TEST(Wiping, TheOperatorSeesLateInexactlyAndNothingOutsideThePicture) {
  const model::RobotModel robot = model::load_robot(model::find_robot("z1"));
  sim::WorldOptions options;
  options.props = {{.name = "table", .half_size_m = {0.25, 1.0, 0.02}, .p_WP_m = {0.65, 0.0, 0.74}},
                   {.name = "towel", .half_size_m = {0.1, 0.1, 0.01}, .p_WP_m = {0.6, 0.1, 0.77}},
                   {.name = "behind", .half_size_m = {0.1, 0.1, 0.01}, .p_WP_m = {-0.6, 0.1, 0.77}}};
  const sim::World world(robot, options);
  const Eigen::Vector3d half_m = options.props.front().half_size_m;
  View view(robot, world, "towel", "table", half_m, 1), blind(robot, world, "behind", "table", half_m, 1);
  EXPECT_EQ(view.look(0.0), nullptr) << "no picture has arrived";
  EXPECT_EQ(view.look(0.11), nullptr);
  const Picture* picture = view.look(0.13);
  ASSERT_NE(picture, nullptr);
  EXPECT_EQ(picture->time_s, 0.0);
  ASSERT_TRUE(picture->object_m && picture->edge_m);
  const Eigen::Vector3d truth_m = view.torso().inverse() * world.pose("towel").translation();
  EXPECT_LT((*picture->object_m - truth_m).norm(), 0.03);
  EXPECT_GT((*picture->object_m - truth_m).norm(), 1e-5);
  EXPECT_NEAR(*picture->edge_m, 0.40 - view.torso().translation().x(), 0.03);
  blind.look(0.0);
  ASSERT_NE(blind.look(0.13), nullptr);
  EXPECT_FALSE(blind.look(0.13)->object_m);
}

/// A few trials of the many that pmg_eval table3 makes: most of them are done.
TEST(WipingTrials, AnOperatorInAHeadsetWipesATable) {
  int done = 0;
  for (const std::uint64_t trial : {2, 3, 5}) {
    const TaskResult result = run_wiping({"pmg", {}}, {}, WipingPlan::of(trial));
    done += result.end == End::kDone ? 1 : 0;
    RecordProperty("trial_" + std::to_string(trial), end_name(result.end));
  }
  EXPECT_GE(done, 2);
}

}  // namespace
}  // namespace pmg::teleoperation
