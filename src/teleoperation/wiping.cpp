#include "teleoperation/wiping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "arms_operator/arms_text.hpp"
#include "faults/fault.hpp"
#include "pmg_msgs/arms_state_t.hpp"
#include "pmg_msgs/mode_t.hpp"
#include "teleoperation/led_robot.hpp"
#include "teleoperation/person.hpp"
#include "teleoperation/view.hpp"

namespace pmg::teleoperation {

namespace {

constexpr const char* kTowel = "towel";
constexpr const char* kTable = "table";
constexpr double kTableThickness_m = 0.04;

/// The scripted operator: (picture, what its page tells) => head and hands.
class Wiper {
 public:
  explicit Wiper(bool to_right) : hand_(to_right ? kRight : kLeft), sign_(to_right ? -1.0 : 1.0) {}

  void step(LedRobot& robot, const Picture* picture) {
    const double now_s = robot.time_s();
    person_.move_hand(kLeft, Eigen::Vector3d::Zero());
    person_.move_hand(kRight, Eigen::Vector3d::Zero());
    if (picture != nullptr) act(robot, *picture, now_s);
    robot.step(&person_.next(robot.now_ns()));
  }
  const char* stage() const noexcept { return kNames.at(static_cast<std::size_t>(stage_)); }
  bool wipes() const noexcept { return stage_ >= Stage::kWipe; }

 private:
  enum class Stage : std::uint8_t { kStand, kGrip, kRaise, kApproach, kOver, kPress, kWipe };
  static constexpr std::array kNames = {
      "stand", "squeeze the grip", "raise the hands", "walk to the table", "hand over the towel", "press", "wipe"};
  // Where the operator wants things, in the torso's frame and from the table's edge [m].
  static constexpr double kStandOff_m = 0.18, kRaised_m = 0.12, kHover_m = 0.09, kClear_m = 0.08, kBehind_m = 0.04,
                          kDeep_m = 0.14, kHardest_m = 0.05, kTouch_m = 0.065, kDown_m_s = 0.03;

  void go(Stage stage, double now_s) {
    stage_ = stage;
    since_s_ = now_s;
  }

  /// Table height in the torso's frame, as it is seen: the towel lies on it.
  void act(LedRobot& robot, const Picture& picture, double now_s) {
    if (picture.object_m) towel_m_ = *picture.object_m;
    const double in_stage_s = now_s - since_s_;
    switch (stage_) {
      case Stage::kStand:
        if (robot.mode() == pmg_msgs::mode_t::STAND && in_stage_s > 3.0) go(Stage::kGrip, now_s);
        return;
      case Stage::kGrip:
        if (!person_.squeezes()) person_.squeeze();
        if (in_stage_s > 0.3) walk(0.12, 0.0, 0.0);
        if (robot.driving() && robot.mode() == pmg_msgs::mode_t::WALK) go(Stage::kRaise, now_s);
        return;
      case Stage::kRaise:
        stay();
        for (const Foot side : {kLeft, kRight}) raise(robot, picture, side, now_s);
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

  /// Velocities that are wanted: forwards, left [m/s], turn [rad/s].
  void walk(double ahead_m_s, double left_m_s, double turn_rad_s) {
    const Eigen::Vector2d lean_m =
        lean_for({std::clamp(ahead_m_s, -0.2, 0.25) / 0.8, std::clamp(left_m_s, -0.2, 0.2) / 0.35});
    person_.lean({lean_m.x(), lean_m.y(), 0.0}, turn_for(std::clamp(turn_rad_s, -0.3, 0.3) / 0.8));
  }
  /// A velocity that closes this gap; none where it is small.
  static double towards(double gap, double small) {
    return std::abs(gap) < 0.6 * small ? 0.0 : 0.6 * gap + std::copysign(0.05, gap);
  }
  void stay() { person_.lean(Eigen::Vector3d::Zero(), 0.0); }

  void raise(const LedRobot& robot, const Picture& picture, Foot side, double now_s) {
    if (!person_.pulls(side) || (!follows(robot, side) && now_s - pulled_s_[side] > 1.0)) {
      person_.release(side);
      if (now_s - pulled_s_[side] > 1.2) {
        person_.pull(side);
        pulled_s_[side] = now_s;
      }
      return;
    }
    const double y_m = side == kLeft ? 0.22 : -0.22;
    if (picture.palm_m[side])
      steer(side, Eigen::Vector3d(0.22, y_m, towel_m_.z() + kRaised_m) - *picture.palm_m[side]);
    else
      person_.move_hand(side, {0.1, 0.0, 0.15});
  }
  static bool follows(const LedRobot& robot, Foot side) {
    const ops::HeardArms* arms = robot.arms();
    return arms != nullptr && ops::arm_news(arms->state, side).activity != pmg_msgs::arms_state_t::REFERENCE;
  }
  void steer(Foot side, const Eigen::Vector3d& error_m) { person_.move_hand(side, 1.5 * error_m); }
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

  std::optional<Eigen::Vector3d> place_m_;
  Person person_;
  Foot hand_;
  double sign_;
  Stage stage_ = Stage::kStand;
  double since_s_ = 0.0, pressed_m_ = 0.0, press_m_ = 0.03;
  PerFoot<double> pulled_s_{-10.0, -10.0};
  Eigen::Vector3d towel_m_{0.4, 0.0, -0.1};
};

}  // namespace

const char* end_name(End end) noexcept {
  constexpr std::array kNames = {
      "done", "fell", "fault", "towel off the table", "palm not on the towel in time", "towel lost", "interrupted"};
  return kNames.at(static_cast<std::size_t>(end));
}

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

WipingResult run_wiping(const evaluation::Candidate& candidate, sim::WorldOptions world, const WipingPlan& plan,
                        const work::Progress& progress, const WipingObserver& observer) {
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
  View view(loaded.robot, robot.world(), kTowel, kTable, WipingPlan::kTableDepth_m, plan.seed);
  Wiper wiper(plan.from_left);
  const Eigen::Isometry3d T_WE = robot.world().pose(kTable);
  const auto towel_E_m = [&] { return Eigen::Vector3d(T_WE.inverse() * robot.world().pose(kTowel).translation()); };
  const double from_m = towel_E_m().y();
  constexpr double kSteadied_s = 2.5, kSetDown_s = 1.0;  // until it stands a gantry steadies it
  robot.set_hoist(1.0);
  robot.ask_for_stand();
  WipingResult result;
  while (robot.time_s() < WipingPlan::kLongest_s) {
    if (progress.interrupted_now()) return result;
    robot.set_hoist(std::clamp((kSteadied_s + kSetDown_s - robot.time_s()) / kSetDown_s, 0.0, 1.0));
    wiper.step(robot, view.look(robot.time_s()));
    if (observer) observer(robot, wiper.stage());
    const Eigen::Vector3d towel_m = towel_E_m();
    result.moved_m = (from_m - towel_m.y()) * end_sign;
    result.duration_s = robot.time_s();
    result.stage = wiper.stage();
    result.words = robot.text();
    if (robot.world().diverged() || robot.world().truth().p_WB.z() < 0.5 * loaded.robot.standing_height_m) {
      result.end = End::kFell;
      return result;
    }
    if (robot.result().mode == control::Mode::kFault) {
      result.end = End::kFault;
      result.words = faults::describe(robot.result().fault, loaded.robot);
      return result;
    }
    if (const auto end = judge_towel(towel_m, result.moved_m)) {
      result.end = *end;
      return result;
    }
  }
  result.end = wiper.wipes() ? End::kLostTowel : End::kNotReached;
  return result;
}

}  // namespace pmg::teleoperation
