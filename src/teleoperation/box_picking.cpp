#include "teleoperation/box_picking.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "arms/arm_setup.hpp"
#include "teleoperation/scripted_operator.hpp"
#include "teleoperation/view.hpp"

namespace pmg::teleoperation {

namespace {

constexpr const char* kBox = "box";
constexpr const char* kLow = "low table";
constexpr const char* kHigh = "high table";
constexpr double kTick_s = control::ControlCycle::kPeriod_s;

/// The scripted operator: (pictures, what its page tells) => head and hands.
class BoxPicker : public ScriptedOperator {
 public:
  BoxPicker(View& low, View& high) : low_view_(low), high_view_(high) {}

  const char* stage() const noexcept override { return kNames.at(static_cast<std::size_t>(stage_)); }

 private:
  enum class Stage : std::uint8_t {
    kStand,
    kRaise,
    kApproach,
    kCrouch,
    kAround,
    kSqueeze,
    kLift,
    kBack,
    kAside,
    kForward,
    kLower,
    kOpen,
    kLeave
  };
  static constexpr std::array kNames = {"stand up and squeeze the grip",
                                        "raise the hands",
                                        "walk to the box",
                                        "crouch",
                                        "hands beside the box",
                                        "squeeze",
                                        "lift",
                                        "step back",
                                        "walk aside",
                                        "walk to the higher table",
                                        "set down",
                                        "open the hands",
                                        "leave"};
  // Where the operator wants things, in the torso's frame and from the tables' edges [m], [rad], [m/s].
  static constexpr double kStandOff_m = 0.20, kCrouch_m = -0.20, kPitch_rad = 0.3;
  static constexpr double kBeside_m = 0.5 * BoxPlan::kWidth_m + 0.065, kTouch_m = 0.5 * BoxPlan::kWidth_m + 0.03;
  static constexpr double kAbove_m = 0.06;  // palms above the box's middle
  static constexpr double kClose_m_s = 0.06, kPress_m = 0.08, kTurn_per_s = 2.0, kFingersDown_rad = 0.85,
                          kLevel_rad = 0.08;
  static constexpr double kUp_m_s = 0.06, kClear_m = 0.05;
  static constexpr double kBackOff_m = 0.42, kPutDown_m = 0.24, kDown_m_s = 0.05, kRested_m = 0.02;

  void go(Stage stage, double now_s) {
    stage_ = stage;
    since_s_ = now_s;
    gaps_.reset();
  }

  bool look(double now_s) override {
    low_ = low_view_.look(now_s);
    high_ = high_view_.look(now_s);
    return low_ != nullptr && high_ != nullptr;
  }

  void act(LedRobot& robot, double now_s) override {
    if (low_->object_m) box_m_ = *low_->object_m;
    if (stage_ >= Stage::kAround && stage_ <= Stage::kLower) turn_hands();
    if (stage_ >= Stage::kBack && stage_ <= Stage::kForward) carry();
    const double in_stage_s = now_s - since_s_;
    switch (stage_) {
      case Stage::kStand:
        if (takes_over(robot, now_s)) go(Stage::kRaise, now_s);
        return;
      case Stage::kRaise:
        stay();
        raise(robot, *low_, {Eigen::Vector3d(0.25, 0.28, -0.08), Eigen::Vector3d(0.25, -0.28, -0.08)}, now_s);
        if (in_stage_s > 4.0) go(Stage::kApproach, now_s);
        return;
      case Stage::kApproach: {
        const bool there = approach(low_->edge_m.value_or(1.0) - kStandOff_m, box_m_.y(), low_->edge_yaw_rad);
        if (!there) since_s_ = now_s;
        if (in_stage_s > 0.8) go(Stage::kCrouch, now_s);
        return;
      }
      case Stage::kCrouch:
        crouch(kCrouch_m, kPitch_rad);
        stay();
        if (in_stage_s > 4.0) go(Stage::kAround, now_s);
        return;
      case Stage::kAround:
        stay();
        if (!reach(kBeside_m)) since_s_ = now_s;
        if (in_stage_s > 0.5) go(Stage::kSqueeze, now_s);
        return;
      case Stage::kSqueeze:
        stay();
        if (squeeze()) go(Stage::kLift, now_s);
        return;
      case Stage::kLift: {
        if (in_stage_s > 1.0) crouch(0.0, 0.0);
        stay();
        if (above_m() < kClear_m && (in_stage_s < 1.0 || in_stage_s > 4.0)) both_hands({0.0, 0.0, kUp_m_s});
        if (above_m() > kClear_m && in_stage_s > 5.0) go(Stage::kBack, now_s);
        return;
      }
      case Stage::kBack:
        if (low_->edge_m.value_or(1.0) > kBackOff_m) return go(Stage::kAside, now_s);
        walk(-0.2, 0.0, towards(low_->edge_yaw_rad, 0.10, 0.12));
        return;
      case Stage::kAside:
        return to_higher_table(kBackOff_m, 0.5, Stage::kForward, now_s);
      case Stage::kForward:
        return to_higher_table(kPutDown_m, 0.8, Stage::kLower, now_s);
      case Stage::kLower: {
        stay();
        if (above_m() < 0.01) rested_m_ += kDown_m_s * kTick_s;
        both_hands({0.0, 0.0, -kDown_m_s});
        if (rested_m_ > kRested_m) go(Stage::kOpen, now_s);
        return;
      }
      case Stage::kOpen:
        stay();
        open();
        if (in_stage_s > 3.0) go(Stage::kLeave, now_s);
        return;
      case Stage::kLeave:
        walk(-0.1, 0.0, 0.0);
        return;
    }
  }

  /// Walks until these gaps are small; true: they are, and it stands. A walking robot sways: the operator goes by the
  /// means of a step.
  bool approach(double ahead_m, double left_m, double turn_rad) {
    const Eigen::Vector3d now(ahead_m, left_m, turn_rad);
    constexpr double kShare = kTick_s / 0.5;
    gaps_ = gaps_ ? Eigen::Vector3d(*gaps_ + kShare * (now - *gaps_)) : now;
    const Eigen::Vector3d& gap = *gaps_;
    const bool there = std::abs(gap[0]) < 0.03 && std::abs(gap[1]) < 0.03 && std::abs(gap[2]) < 0.08;
    if (there) {
      stay();
    } else {
      walk(towards(gap[0], 0.03, 0.12), towards(gap[1], 0.03, 0.06), towards(gap[2], 0.08, 0.12));
    }
    return there;
  }
  /// Before the place for the box, so far from the table's edge; when it has stood there for so long, the next stage.
  /// The mark: the box's place along the table.
  void to_higher_table(double edge_m, double stood_s, Stage next, double now_s) {
    const double in_stage_s = now_s - since_s_, left_m = -high_->mark_m.value_or(0.0);
    if (!approach(high_->edge_m.value_or(1.0) - edge_m, left_m, high_->edge_yaw_rad)) since_s_ = now_s;
    if (in_stage_s > stood_s) go(next, now_s);
  }
  static double left_of(Foot side) { return side == kLeft ? 1.0 : -1.0; }
  void both_hands(const Eigen::Vector3d& v_m_s) {
    for (const Foot side : {kLeft, kRight}) person_.move_hand(side, v_m_s);
  }
  /// Both palms to the box's sides, so far from its middle; true: they are there.
  bool reach(double beside_m) {
    bool there = true;
    for (const Foot side : {kLeft, kRight}) {
      if (!low_->palm_m[side]) return false;
      const Eigen::Vector3d error_m =
          box_m_ + Eigen::Vector3d(0.0, left_of(side) * beside_m, kAbove_m) - *low_->palm_m[side];
      steer(side, error_m);
      there = there && error_m.norm() < 0.03;
    }
    return there;
  }
  /// Turns the palms until they are seen to lie flat on the box's sides: before it is lifted with the fingers
  /// kFingersDown_rad below straight ahead, then so that it is level.
  void turn_hands() {
    if (!low_->object_m) return;
    const Eigen::Vector3d y_box = low_->object_R * Eigen::Vector3d::UnitY();
    const Eigen::Vector3d z_box = low_->object_R * Eigen::Vector3d::UnitZ();
    for (const Foot side : {kLeft, kRight}) {
      if (!low_->palm_m[side]) continue;
      const Eigen::Quaterniond& R = low_->palm_R[side];
      const Eigen::Vector3d flat = (R * Eigen::Vector3d::UnitY()).cross(y_box);
      const Eigen::Vector3d fingers(std::cos(kFingersDown_rad), 0.0, -std::sin(kFingersDown_rad));
      const double tilt = z_box.cross(high_->up).dot(y_box);
      const double about_y = stage_ >= Stage::kLift ? (std::abs(tilt) < kLevel_rad ? 0.0 : tilt)
                                                    : (R * -Eigen::Vector3d::UnitZ()).cross(fingers).dot(y_box);
      person_.turn_hand(side, kTurn_per_s * (flat + about_y * y_box));
    }
  }
  double above_m() const { return box_m_.z() - 0.5 * BoxPlan::kHeight_m - high_->top_m; }
  /// While it walks: both hands up or down until the box is seen kClear_m above the higher table.
  void carry() {
    const double error_m = kClear_m - above_m();
    both_hands({0.0, 0.0, std::abs(error_m) < 0.01 ? 0.0 : std::clamp(error_m, -0.05, 0.05)});
  }
  /// Together until both are seen to touch, then kPress_m further, for the arms to push; true: that far.
  bool squeeze() {
    bool pressed = true;
    for (const Foot side : {kLeft, kRight}) {
      if (!low_->palm_m[side]) return false;
      const double beside_m = left_of(side) * (low_->palm_m[side]->y() - box_m_.y());
      if (beside_m < kTouch_m) pressed_m_[side] += kClose_m_s * kTick_s;
      if (pressed_m_[side] < kPress_m) {
        pressed = false;
        const double ahead_m = pressed_m_[side] > 0.0 ? 0.0 : box_m_.x() - low_->palm_m[side]->x();
        person_.move_hand(side, {ahead_m, -left_of(side) * kClose_m_s, 0.0});
      }
    }
    return pressed;
  }
  void open() {
    for (const Foot side : {kLeft, kRight}) {
      if (!low_->palm_m[side]) continue;
      const double beside_m = left_of(side) * (low_->palm_m[side]->y() - box_m_.y());
      if (beside_m < kBeside_m + 0.02) person_.move_hand(side, {0.0, left_of(side) * kClose_m_s, 0.0});
    }
  }

  View &low_view_, &high_view_;
  const Picture *low_ = nullptr, *high_ = nullptr;
  Stage stage_ = Stage::kStand;
  double since_s_ = 0.0, rested_m_ = 0.0;
  std::optional<Eigen::Vector3d> gaps_;  // ahead, left [m], to turn [rad]
  PerFoot<double> pressed_m_{0.0, 0.0};
  Eigen::Vector3d box_m_{0.5, 0.0, -0.3};
};

double tilt_rad(const Eigen::Isometry3d& T_WB) noexcept {
  return std::acos(std::clamp((T_WB.linear() * Eigen::Vector3d::UnitZ()).z(), -1.0, 1.0));
}

}  // namespace

BoxPlan BoxPlan::of(std::uint64_t trial) {
  std::mt19937_64 random(0x626f78 + trial);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  BoxPlan plan;
  plan.to_left = trial % 2 == 0;
  plan.edge_m = between(0.45, 0.60);
  plan.beside_m = between(-0.20, 0.20);
  plan.along_m = between(-0.05, 0.05);
  plan.deep_m = between(0.01, 0.04);
  plan.yaw_rad = between(-0.2, 0.2);
  plan.seed = trial;
  return plan;
}

double BoxJudge::moved_m() const noexcept {
  return (last_.T_WB.translation() - start_.T_WB.translation()).head<2>().norm();
}

bool BoxJudge::stands(const BoxState& box, double speed_m_s) const noexcept {
  const Eigen::Vector3d middle_E_m = T_WE_.inverse() * box.T_WB.translation();
  const double above_m =
      middle_E_m.z() - 0.5 * BoxPlan::kTableThickness_m - 0.5 * BoxPlan::kHeight_m;  // its bottom over the top
  return !box.held && speed_m_s < kStill_m_s && tilt_rad(box.T_WB) < kUpright_rad && std::abs(above_m) < kOnTop_m &&
         std::abs(middle_E_m.x()) < 0.5 * BoxPlan::kTableDepth_m &&
         std::abs(middle_E_m.y()) < 0.5 * BoxPlan::kHighLength_m;
}

std::optional<End> BoxJudge::look(const BoxState& box, double dt_s) noexcept {
  const Eigen::Vector3d v_m_s = (box.T_WB.translation() - last_.T_WB.translation()) / dt_s;
  last_ = box;
  lifted_m_ = std::max(lifted_m_, (box.T_WB.translation() - start_.T_WB.translation()).z());
  if (-v_m_s.z() > kFall_m_s || tilt_rad(box.T_WB) > kTipped_rad) return End::kDropped;
  rested_s_ = stands(box, v_m_s.norm()) ? rested_s_ + dt_s : 0.0;
  const bool done = rested_s_ >= kRest_s && lifted_m_ >= kLifted_m && moved_m() >= kMoved_m;
  return done ? std::optional(End::kDone) : std::nullopt;
}

TaskResult run_box_picking(const evaluation::Candidate& candidate, sim::WorldOptions world, const BoxPlan& plan,
                           const work::Progress& progress, const TaskObserver& observer) {
  control::LoadedControl loaded = control::load_control(candidate.control);
  const double sign = plan.to_left ? 1.0 : -1.0;
  const double depth_m = 0.5 * BoxPlan::kTableDepth_m, thick_m = 0.5 * BoxPlan::kTableThickness_m;
  const double box_y_m = plan.along_m - plan.beside_m;
  // The robot's base is at the origin and looks along x.
  const sim::Prop low = {.name = kLow,
                         .half_size_m = {depth_m, 0.5 * BoxPlan::kLowLength_m, thick_m},
                         .p_WP_m = {plan.edge_m + depth_m, -plan.beside_m, BoxPlan::kLowTop_m - thick_m},
                         .friction = BoxPlan::kFriction};
  const sim::Prop high = {
      .name = kHigh,
      .half_size_m = {depth_m, 0.5 * BoxPlan::kHighLength_m, thick_m},
      .p_WP_m = {plan.edge_m + depth_m, box_y_m + sign * BoxPlan::kApart_m, BoxPlan::kHighTop_m - thick_m},
      .friction = BoxPlan::kFriction};
  const sim::Prop box = {.name = kBox,
                         .half_size_m = {0.5 * BoxPlan::kDepth_m, 0.5 * BoxPlan::kWidth_m, 0.5 * BoxPlan::kHeight_m},
                         .p_WP_m = {plan.edge_m + plan.deep_m + 0.5 * BoxPlan::kDepth_m, box_y_m,
                                    BoxPlan::kLowTop_m + 0.5 * BoxPlan::kHeight_m + 0.001},
                         .yaw_rad = plan.yaw_rad,
                         .mass_kg = BoxPlan::kMass_kg,
                         .friction = BoxPlan::kFriction,
                         .colour = {0.25, 0.50, 0.80, 1.0}};
  world.props = {low, high, box};
  world.hand_boxes = palm_boxes(loaded.robot);
  LedRobot robot(loaded, world);
  View low_view(loaded.robot, robot.world(), kBox, kLow, low.half_size_m, 2 * plan.seed);
  View high_view(loaded.robot, robot.world(), kBox, kHigh, high.half_size_m, 2 * plan.seed + 1);
  BoxPicker picker(low_view, high_view);
  const auto state = [&] {
    BoxState seen{.T_WB = robot.world().pose(kBox), .held = false};
    for (const sim::HandBox& palm : world.hand_boxes) seen.held = seen.held || robot.world().touches(palm.link, kBox);
    return seen;
  };
  BoxJudge judge(state(), robot.world().pose(kHigh));
  const auto look = [&](TaskResult& result) {
    const std::optional<End> end = judge.look(state(), kTick_s);
    result.moved_m = judge.moved_m();
    result.lifted_m = judge.lifted_m();
    return end;
  };
  return run_task(
      robot, picker, look, BoxPlan::kLongest_s, [&] { return judge.time_up(); }, progress, observer);
}

}  // namespace pmg::teleoperation
