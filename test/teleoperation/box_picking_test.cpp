// The box-picking task: who judges it, and that its whole way from the headset to the box is connected.
#include "teleoperation/box_picking.hpp"

#include <gtest/gtest.h>

#include <string>

namespace pmg::teleoperation {
namespace {

constexpr double kTick_s = 0.01;

/// A box that is moved by hand, and its judge. World axes; the higher table's middle is kApart_m to the left.
class Box {
 public:
  Box() : judge_(state_, table()) {}

  /// Straight to there within so many seconds; whatever the judge says first.
  std::optional<End> move(const Eigen::Vector3d& to_m, double duration_s) {
    const int ticks = static_cast<int>(duration_s / kTick_s);
    const Eigen::Vector3d from_m = state_.T_WB.translation();
    for (int tick = 1; tick <= ticks; ++tick) {
      state_.T_WB.translation() = from_m + (to_m - from_m) * tick / ticks;
      if (const auto end = judge_.look(state_, kTick_s)) return end;
    }
    return std::nullopt;
  }
  std::optional<End> rest(double duration_s) { return move(state_.T_WB.translation(), duration_s); }
  void hold(bool held) { state_.held = held; }
  void turn(double rad, const Eigen::Vector3d& about) {
    state_.T_WB.linear() = Eigen::AngleAxisd(rad, about).toRotationMatrix();
  }
  End time_up() const { return judge_.time_up(); }

  static constexpr double kRise_m = BoxPlan::kHighTop_m - BoxPlan::kLowTop_m;
  static Eigen::Vector3d high(double above_m = 0.0, double apart_m = BoxPlan::kApart_m) {
    return {0.6, apart_m, BoxPlan::kHighTop_m + 0.5 * BoxPlan::kHeight_m + above_m};
  }
  /// As it should be: up, over, down, and let go.
  std::optional<End> carry(double highest_m = 0.30, double apart_m = BoxPlan::kApart_m) {
    hold(true);
    const Eigen::Vector3d up = state_.T_WB.translation() + Eigen::Vector3d(0.0, 0.0, highest_m);
    if (const auto end = move(up, 3.0)) return end;
    if (const auto end = move(high(highest_m - kRise_m, apart_m), 5.0)) return end;
    if (const auto end = move(high(0.0, apart_m), 1.0)) return end;
    hold(false);
    return std::nullopt;
  }

 private:
  static Eigen::Isometry3d table() {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = high() - Eigen::Vector3d(0.0, 0.0, 0.5 * (BoxPlan::kHeight_m + BoxPlan::kTableThickness_m));
    return T;
  }
  static BoxState start() {
    BoxState state;
    state.T_WB.translation() = Eigen::Vector3d(0.6, 0.0, BoxPlan::kLowTop_m + 0.5 * BoxPlan::kHeight_m);
    return state;
  }
  BoxState state_ = start();
  BoxJudge judge_;
};

TEST(BoxPicking, ABoxThatIsLiftedCarriedAndSetDownIsDoneOnceItRestsAlone) {
  Box box;
  EXPECT_EQ(box.carry(), std::nullopt);
  EXPECT_EQ(box.rest(0.9), std::nullopt) << "not at rest for a second yet";
  EXPECT_EQ(box.rest(0.2), End::kDone);
}

TEST(BoxPicking, ABoxInTheHandsIsNotSetDown) {
  Box box;
  box.carry();
  box.hold(true);
  EXPECT_EQ(box.rest(5.0), std::nullopt);
  EXPECT_EQ(box.time_up(), End::kNotPutDown);
}

TEST(BoxPicking, ABoxThatFallsIsDroppedAndOneThatIsLoweredIsNot) {
  for (const double speed_m_s : {0.45, 0.55}) {
    Box box;
    box.move(Box::high(0.10), 5.0);
    EXPECT_EQ(box.move(Box::high(), 0.10 / speed_m_s), speed_m_s < 0.5 ? std::nullopt : std::optional(End::kDropped));
  }
}

TEST(BoxPicking, ABoxThatTipsOverIsDropped) {
  Box box;
  box.turn(0.55, Eigen::Vector3d::UnitX());
  EXPECT_EQ(box.rest(0.1), std::nullopt);
  box.turn(0.65, Eigen::Vector3d::UnitX());
  EXPECT_EQ(box.rest(0.1), End::kDropped);
}

TEST(BoxPicking, ABoxThatWasSlidOverWithoutBeingLiftedFarEnoughIsNotDone) {
  Box box;
  box.carry(0.265);
  EXPECT_EQ(box.rest(5.0), std::nullopt);
  EXPECT_EQ(box.time_up(), End::kNotLifted);
}

TEST(BoxPicking, ABoxThatLeansThatStandsTooNearOrBesideTheTableIsNotDone) {
  Box leans;
  leans.carry();
  leans.turn(0.1, Eigen::Vector3d::UnitX());
  EXPECT_EQ(leans.rest(5.0), std::nullopt);
  Box near;
  near.carry(0.30, 0.50);
  EXPECT_EQ(near.rest(5.0), std::nullopt);
  Box beside;
  beside.carry(0.30, BoxPlan::kApart_m + 0.5 * BoxPlan::kHighLength_m + 0.01);
  EXPECT_EQ(beside.rest(5.0), std::nullopt) << "as in the air";
}

/// Seconds until the hands are raised: the whole way from the headset's messages to the arms of a robot that walks.
TEST(BoxPicking, HandsInAHeadsetsControllersRaiseBothPalmsBesideTheBox) {
  int asked = 0;
  double apart_m = 0.0;
  const work::Progress ends{.report = {}, .interrupted = [&] { return ++asked > 560; }};
  const TaskResult result =
      run_box_picking({"pmg", {}}, {}, BoxPlan::of(1000), ends, [&](const LedRobot& robot, const std::string&) {
        apart_m = (robot.world().pose("left_wrist_pitch_link").translation() -
                   robot.world().pose("right_wrist_pitch_link").translation())
                      .norm();
      });
  EXPECT_EQ(result.end, End::kInterrupted);
  EXPECT_EQ(result.stage, "raise the hands");
  EXPECT_GT(apart_m, BoxPlan::kWidth_m + 0.15) << "they hung 0.46 m apart";
  EXPECT_LT(result.lifted_m, 0.001);
}

/// A few trials of the many that pmg_eval table3 makes: most of them are done.
TEST(BoxPickingTrials, AnOperatorInAHeadsetLiftsABoxCarriesItAndSetsItDown) {
  int done = 0;
  for (const std::uint64_t trial : {1000, 1001, 1002}) {
    const TaskResult result = run_box_picking({"pmg", {}}, {}, BoxPlan::of(trial));
    done += result.end == End::kDone ? 1 : 0;
    RecordProperty("trial_" + std::to_string(trial), end_name(result.end));
  }
  EXPECT_GE(done, 2);
}

}  // namespace
}  // namespace pmg::teleoperation
