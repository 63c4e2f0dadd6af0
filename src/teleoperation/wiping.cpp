#include "teleoperation/wiping.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "teleoperation/scripted_operator.hpp"
#include "teleoperation/view.hpp"

namespace pmg::teleoperation {

namespace {

constexpr const char* kTowel = "towel";
constexpr const char* kTable = "table";
constexpr double kTableThickness_m = 0.04;

/// The scripted operator: (picture, what its page tells) => head and hands.
class Wiper : public ScriptedOperator {
 public:
  Wiper(View& view, bool to_right) : view_(view), hand_(to_right ? kRight : kLeft), sign_(to_right ? -1.0 : 1.0) {}

  const char* stage() const noexcept override { return kNames.at(static_cast<std::size_t>(stage_)); }
  bool wipes() const noexcept { return stage_ >= Stage::kWipe; }

 private:
  enum class Stage : std::uint8_t { kStand, kRaise, kApproach, kOver, kPress, kWipe };
  static constexpr std::array kNames = {"stand up and squeeze the grip", "raise the hands", "walk to the table",
                                        "hand over the towel",           "press",           "wipe"};
  // Where the operator wants things, in the torso's frame and from the table's edge [m].
  static constexpr double kStandOff_m = 0.18, kRaised_m = 0.12, kHover_m = 0.09, kClear_m = 0.08, kBehind_m = 0.04,
                          kDeep_m = 0.14, kHardest_m = 0.05, kTouch_m = 0.065, kDown_m_s = 0.03;

  void go(Stage stage, double now_s) {
    stage_ = stage;
    since_s_ = now_s;
  }

  bool look(double now_s) override {
    picture_ = view_.look(now_s);
    return picture_ != nullptr;
  }

  /// Table height in the torso's frame, as it is seen: the towel lies on it.
  void act(LedRobot& robot, double now_s) override {
    const Picture& picture = *picture_;
    if (picture.object_m) towel_m_ = *picture.object_m;
    const double in_stage_s = now_s - since_s_;
    switch (stage_) {
      case Stage::kStand:
        if (takes_over(robot, now_s)) go(Stage::kRaise, now_s);
        return;
      case Stage::kRaise:
        stay();
        raise(robot, picture,
              {Eigen::Vector3d(0.22, 0.22, towel_m_.z() + kRaised_m),
               Eigen::Vector3d(0.22, -0.22, towel_m_.z() + kRaised_m)},
              now_s);
        if (in_stage_s > 4.0) go(Stage::kApproach, now_s);
        return;
      case Stage::kApproach: {
        const double ahead_m = picture.edge_m.value_or(1.0) - kStandOff_m;
        const double left_m = towel_m_.y() - (hand_ == kRight ? -0.24 : 0.24);
        hover(picture);
        if (picture.palm_m[hand_] &&
            picture.palm_m[hand_]->z() < towel_m_.z() + kClear_m) {  // not along with the towel
          since_s_ = now_s;
          return stay();
        }
        const bool there = std::abs(ahead_m) < 0.04 && std::abs(left_m) < 0.07 && std::abs(picture.edge_yaw_rad) < 0.12;
        if (there) {
          stay();
        } else {
          since_s_ = now_s;
          walk(towards(ahead_m, 0.04), towards(left_m, 0.07), towards(picture.edge_yaw_rad, 0.10));
        }
        if (in_stage_s > 0.8) go(Stage::kOver, now_s);
        return;
      }
      case Stage::kOver: {
        stay();
        const Eigen::Vector3d to_m = towel_m_ + Eigen::Vector3d(0.0, -sign_ * kBehind_m, kHover_m);
        if (!reach(picture, to_m)) since_s_ = now_s;
        if (in_stage_s > 0.5) go(Stage::kPress, now_s);
        return;
      }
      case Stage::kPress:
        stay();
        press(picture);
        if (in_stage_s > 2.5) go(Stage::kWipe, now_s);
        return;
      case Stage::kWipe: {
        if (!place_m_) place_m_ = picture.palm_m[hand_];
        if (place_m_ && picture.edge_m) place_m_->x() = *picture.edge_m + kDeep_m;  // along the table, not off it
        follow(picture, 0.0);
        if (!on_towel(picture)) {  // the hand slides: it presses harder
          stay();
          pressed_m_ = 0.0;
          place_m_.reset();
          press_m_ = std::min(press_m_ + 0.01, kHardest_m);
          return go(Stage::kApproach, now_s);
        }
        const double ahead_m = picture.edge_m.value_or(kStandOff_m) - kStandOff_m;
        walk(1.0 * ahead_m, sign_ * 0.10, 1.2 * picture.edge_yaw_rad);
        return;
      }
    }
  }

  bool reach(const Picture& picture, const Eigen::Vector3d& to_m) {
    if (!picture.palm_m[hand_]) return false;
    const Eigen::Vector3d error_m = to_m - *picture.palm_m[hand_];
    steer(hand_, error_m);
    return error_m.norm() < 0.03;
  }
  bool on_towel(const Picture& picture) const {
    if (!picture.palm_m[hand_] || !picture.object_m) return false;
    return (towel_m_ - *picture.palm_m[hand_]).head<2>().norm() < 0.10;
  }
  /// Above the towel's height, where it is.
  void hover(const Picture& picture) {
    if (!picture.palm_m[hand_]) return;
    steer(hand_, {0.0, 0.0, std::clamp(towel_m_.z() + kRaised_m - picture.palm_m[hand_]->z(), -0.05, 0.05)});
  }
  /// Down onto the towel until it is seen to touch, then press_m_ further, for the arm to push.
  void press(const Picture& picture) {
    if (!picture.palm_m[hand_]) return;
    const bool touches = picture.palm_m[hand_]->z() - towel_m_.z() < kTouch_m;
    const bool down = !touches || pressed_m_ < press_m_;
    if (touches && down) pressed_m_ += kDown_m_s * control::ControlCycle::kPeriod_s;
    follow(picture, down ? -kDown_m_s : 0.0);
  }
  /// Over the towel's middle; while it wipes, where the hand was before its own body when that began.
  void follow(const Picture& picture, double up_m_s) {
    if (!picture.palm_m[hand_]) return;
    const Eigen::Vector3d error_m =
        (place_m_ ? *place_m_ : Eigen::Vector3d(towel_m_ - Eigen::Vector3d(0.0, sign_ * kBehind_m, 0.0))) -
        *picture.palm_m[hand_];
    Eigen::Vector3d v_m_s = Eigen::Vector3d::Zero();
    for (int k = 0; k < 2; ++k) v_m_s[k] = std::abs(error_m[k]) < 0.015 ? 0.0 : 0.8 * error_m[k];
    v_m_s.z() = up_m_s;
    person_.move_hand(hand_, v_m_s);
  }

  View& view_;
  const Picture* picture_ = nullptr;
  std::optional<Eigen::Vector3d> place_m_;
  Foot hand_;
  double sign_;
  Stage stage_ = Stage::kStand;
  double since_s_ = 0.0, pressed_m_ = 0.0, press_m_ = 0.03;
  Eigen::Vector3d towel_m_{0.4, 0.0, -0.1};
};

}  // namespace

WipingPlan WipingPlan::of(std::uint64_t trial) {
  std::mt19937_64 random(0x77697065 + trial);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  WipingPlan plan;
  plan.from_left = trial % 2 == 0;
  plan.along_m = between(0.30, 0.60);
  plan.deep_m = between(0.12, 0.18);
  plan.towel_yaw_rad = between(-0.5, 0.5);
  plan.edge_m = between(0.40, 0.55);
  plan.beside_m = between(-0.25, 0.25);
  plan.seed = trial;
  return plan;
}

std::optional<End> judge_towel(const Eigen::Vector3d& towel_E_m, double moved_m) noexcept {
  const bool on_top = std::abs(towel_E_m.x()) < 0.5 * WipingPlan::kTableDepth_m &&
                      std::abs(towel_E_m.y()) < 0.5 * WipingPlan::kTableLength_m && towel_E_m.z() > 0.0;
  if (!on_top) return End::kOffTable;
  return moved_m > WipingPlan::kMoved_m ? std::optional(End::kDone) : std::nullopt;
}

TaskResult run_wiping(const evaluation::Candidate& candidate, sim::WorldOptions world, const WipingPlan& plan,
                      const work::Progress& progress, const TaskObserver& observer) {
  control::LoadedControl loaded = control::load_control(candidate.control);
  const double end_sign = plan.from_left ? 1.0 : -1.0;
  const double towel_y_m = end_sign * (0.5 * WipingPlan::kTableLength_m - plan.along_m);
  // The robot's base is at the origin and looks along x; the towel lies beside it.
  const Eigen::Vector3d table_m(plan.edge_m + 0.5 * WipingPlan::kTableDepth_m, -plan.beside_m - towel_y_m,
                                WipingPlan::kTableTop_m - 0.5 * kTableThickness_m);
  world.props = {
      {.name = kTable,
       .half_size_m = {0.5 * WipingPlan::kTableDepth_m, 0.5 * WipingPlan::kTableLength_m, 0.5 * kTableThickness_m},
       .p_WP_m = table_m,
       .friction = WipingPlan::kTowelFriction},
      {.name = kTowel,
       .half_size_m = {0.5 * WipingPlan::kTowelLength_m, 0.5 * WipingPlan::kTowelLength_m,
                       0.5 * WipingPlan::kTowelThickness_m},
       .p_WP_m = {plan.edge_m + plan.deep_m, -plan.beside_m,
                  WipingPlan::kTableTop_m + 0.5 * WipingPlan::kTowelThickness_m + 0.001},
       .yaw_rad = plan.towel_yaw_rad,
       .mass_kg = WipingPlan::kTowelMass_kg,
       .friction = WipingPlan::kTowelFriction,
       .colour = {0.2, 0.45, 0.8, 1.0}}};
  world.hand_boxes = palm_boxes(loaded.robot);
  LedRobot robot(loaded, world);
  View view(loaded.robot, robot.world(), kTowel, kTable, world.props.front().half_size_m, plan.seed);
  Wiper wiper(view, plan.from_left);
  const Eigen::Isometry3d T_WE = robot.world().pose(kTable);
  const auto towel_E_m = [&] { return Eigen::Vector3d(T_WE.inverse() * robot.world().pose(kTowel).translation()); };
  const double from_m = towel_E_m().y();
  const auto judge = [&](TaskResult& result) {
    const Eigen::Vector3d towel_m = towel_E_m();
    result.moved_m = (from_m - towel_m.y()) * end_sign;
    return judge_towel(towel_m, result.moved_m);
  };
  const auto time_up = [&] { return wiper.wipes() ? End::kNotWiped : End::kNotReached; };
  return run_task(robot, wiper, judge, WipingPlan::kLongest_s, time_up, progress, observer);
}

}  // namespace pmg::teleoperation
