#include "can/first_light.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "can/few_motors.hpp"
#include "can/wiggle_limits.hpp"
#include "drives/robot_drives.hpp"
#include "model/hanging_load.hpp"
#include "pmg/types.hpp"

namespace pmg::can {

namespace {

constexpr double kMostWay_rad = 20.0 * kRadPerDegree;
constexpr double kWayMargin =
    1.5;  // soft gains don't reach the end, and a step of the drive's torque counts as friction
constexpr double kLeanWay_rad = 10.0 * kRadPerDegree;  // of a leg: the base leans by a degree or more

/// At rest at one end of the way: means over half of the time there.
struct End {
  double q_rad = 0.0, torque_Nm = 0.0;
  PlumbMean plumb;
};

/// The joint's motion alone.
class Motion {
 public:
  Motion(const model::RobotModel& robot, const JointVector& q, const model::Joint& joint, int index)
      : robot_(robot), q_(q), joint_(joint), index_(index) {}
  JointVector at(double q_rad) const {
    JointVector q = q_;
    q[index_] = q_rad;
    return q;
  }
  /// The model's torque that holds the joint at this end.
  double holding_Nm(const End& end, model::Hanging hanging) const {
    return holding_Nm(end, std::move(hanging), end.q_rad);
  }
  /// The same, told by a motor that turns the other way round.
  double inverted_Nm(const End& end, model::Hanging hanging) const {
    return -holding_Nm(end, std::move(hanging), -end.q_rad);
  }

 private:
  double holding_Nm(const End& end, model::Hanging hanging, double q_rad) const {
    if (const auto plumb = end.plumb.mean()) hanging.down_B = plumb->down_B;
    const model::GravityLoad load = model::gravity_load(robot_, joint_.name, at(q_rad), hanging);
    return load.holding_Nm(q_rad);
  }
  const model::RobotModel& robot_;
  const JointVector& q_;
  const model::Joint& joint_;
  int index_;
};

/// The way that the base leans when the joint turns by +: a unit vector in the base's axes. A base that the joint turns
/// goes against its axis. Any other leans until the robot's centre of mass is below what holds it again, so against the
/// limb's: along d x down with the limb's way d. Nullopt: the limb's centre of mass stays, or the IMU is on the limb.
std::optional<Eigen::Vector3d> leans(const model::RobotModel& robot, const JointVector& q, const std::string& joint,
                                     const model::Hanging& hanging) {
  const model::HangingLoad limb = model::hanging_load(robot, joint, q);
  if (model::turns_base(robot, joint, hanging)) return -limb.axis;
  constexpr double kLeastShift_m = 0.01;  // of the robot's centre of mass, per rad
  const Eigen::Vector3d way = (limb.mass_kg / robot.total_mass_kg * limb.center_m_per_rad).cross(hanging.down_B);
  if (way.norm() < kLeastShift_m || model::beyond(robot, joint, robot.imu.link)) return std::nullopt;
  return way.normalized();
}

/// How far an angle is out of the joint's range; negative: within it.
double beyond_range_rad(const model::Joint& joint, double q_rad) {
  return std::max(joint.lower_rad - q_rad, q_rad - joint.upper_rad);
}

/// The joint lies on a stop, or would if its motor turned the other way round.
bool lies_on_stop(const model::Joint& joint, double q_rad) {
  return std::max(beyond_range_rad(joint, q_rad), beyond_range_rad(joint, -q_rad)) > -kOnStop_rad;
}

/// Something ended the joint's way where its range would end if its motor turned the other way round, and doesn't.
bool stopped_as_inverted(const model::Joint& joint, double start_rad, double q_rad) {
  const bool up = q_rad > start_rad;
  const double stop_rad = up ? joint.upper_rad : joint.lower_rad,
               inverted_rad = up ? -joint.lower_rad : -joint.upper_rad;
  return std::abs(q_rad - start_rad) >= kCame_rad && std::abs(q_rad - inverted_rad) <= kNearStop_rad &&
         std::abs(q_rad - stop_rad) > 2.0 * kNearStop_rad;
}

bool up_short(const Wiggle& wiggle) { return is_short(wiggle.asked_rad, wiggle.moved_rad, kNoWay_rad); }
bool down_short(const Wiggle& wiggle) { return is_short(wiggle.asked_down_rad, wiggle.moved_down_rad, kLeastWay_rad); }

/// What says something of the direction.
struct Witness {
  const char* name;
  bool right;
};

/// (measured) => the load's word, if it has one: one way round explains what was held, the other doesn't by far.
std::optional<Witness> of_load(const Wiggle& wiggle) {
  const auto off_Nm = [&wiggle](double model_Nm) { return std::abs(wiggle.held_Nm - model_Nm); };
  const auto explains = [&](double model_Nm, double other_Nm) {
    return off_Nm(model_Nm) < off_Nm(other_Nm) && off_Nm(other_Nm) > kRuledOut * wiggle.friction_Nm &&
           off_Nm(model_Nm) <= std::max(wiggle.friction_Nm, kExplains * std::abs(model_Nm));
  };
  if (wiggle.on_stop) return {};
  if (explains(wiggle.model_Nm, wiggle.model_inverted_Nm)) return Witness{"its load", true};
  if (explains(wiggle.model_inverted_Nm, wiggle.model_Nm)) return Witness{"its load", false};
  return {};
}

std::optional<Witness> of_lean(const Wiggle& wiggle) {
  if (!wiggle.leaned_rad || std::abs(*wiggle.leaned_rad) < wiggle.least_lean_rad) return {};
  return Witness{"the base that leans", *wiggle.leaned_rad > 0.0};
}

/// Its zero is right: the same is presumed where the load is compared.
std::optional<Witness> of_range(const Wiggle& wiggle) {
  if (wiggle.inverted_beyond_rad < kSureOfRange_rad) return {};
  return Witness{"its range", true};
}

constexpr const char* kStoppedAsInverted =
    "where its range ends the other way round: `direction` in robot.yaml is wrong, or the zero, or something blocks it";

}  // namespace

double telling_way_rad(const model::RobotModel& robot, const JointVector& q, const std::string& joint,
                       const model::Hanging& hanging) {
  const model::GravityLoad load = model::gravity_load(robot, joint, q, hanging);
  const double friction_Nm = robot.joints[static_cast<std::size_t>(robot.joint_index.at(joint))].friction_Nm;
  const double share = kWayMargin * kSure * friction_Nm / std::max(load.gravity_Nm, 1e-9);
  const double gear_rad = std::clamp(std::asin(std::min(share, 1.0)), kLeastWay_rad, kMostWay_rad);
  const bool load_tells =
      2.0 * load.gravity_Nm * std::abs(std::sin(load.hangs_at_rad)) > kWayMargin * kRuledOut * friction_Nm;
  return load_tells ? gear_rad : std::max(gear_rad, kLeanWay_rad);
}

Wiggle wiggle(const model::RobotModel& robot, const JointVector& q, const BusSetup& bus,
              const drives::MotorSetup& motor, Link& link, const WiggleOptions& options,
              const std::function<void()>& tick, const std::function<bool()>& interrupted,
              const model::Hanging& hanging, Plumb* plumb) {
  const model::Joint& joint = robot.joints[static_cast<std::size_t>(motor.index)];
  const Motion motion(robot, q, joint, motor.index);
  FewMotors one(bus, motor, link, tick, [plumb](const drives::Message& message) {
    if (plumb != nullptr) plumb->hear(message);
  });
  const double start_rad = one.reading().q_rad;
  const auto in_range = [&joint](double q_rad) { return beyond_range_rad(joint, q_rad) <= kOnStop_rad; };
  if (!in_range(start_rad)) {
    throw std::runtime_error(
        fmt::format("{} is at {:.3f} rad; expected a start within {:.3f} to {:.3f} rad: {}", name_of(bus, motor),
                    start_rad, joint.lower_rad, joint.upper_rad,
                    in_range(-start_rad) ? "`direction` in robot.yaml is wrong, or the zero" : "set its zero first"));
  }
  one.switch_on();
  const bool own_gains = motor.drive->loop() == drives::LoopPlace::kOwnGains;
  const double share = own_gains ? 1.0 : options.gain_share;
  const double by_rad = options.by_rad.value_or(telling_way_rad(robot, q, motor.joint, hanging));
  const double up = std::min(start_rad + by_rad, joint.upper_rad), low = std::max(start_rad - by_rad, joint.lower_rad);
  const model::GravityLoad expected = model::gravity_load(robot, motor.joint, q, hanging);
  const double most_Nm = options.effort_share * joint.effort_limit_Nm +
                         2.0 * std::max(std::abs(expected.holding_Nm(up)), std::abs(expected.holding_Nm(low)));

  double target_rad = start_rad;
  const auto go_to = [&](double end_rad) {
    const double began_rad = one.reading().q_rad;
    End end;
    for (int settled = 0; settled < kSettleCycles;) {
      if (interrupted && interrupted()) throw std::runtime_error("interrupted; the motor is switched off");
      target_rad += std::clamp(end_rad - target_rad, -options.speed_rad_s * kCycle_s, options.speed_rad_s * kCycle_s);
      one.exchange({.q_rad = target_rad,
                    .kp_Nm_per_rad = share * joint.kp_Nm_per_rad,
                    .kd_Nm_s_per_rad = share * joint.kd_Nm_s_per_rad});
      if (std::abs(one.reading().torque_Nm) > most_Nm)
        throw std::runtime_error(
            fmt::format("{} meets {:.1f} Nm; expected {:.1f} Nm at most on this way: {}; it is "
                        "switched off",
                        name_of(bus, motor), std::abs(one.reading().torque_Nm), most_Nm,
                        stopped_as_inverted(joint, began_rad, one.reading().q_rad)
                            ? std::string("it stopped ") + kStoppedAsInverted
                            : "something blocks it, or gear or zero are wrong"));
      const auto plumbed = plumb != nullptr ? plumb->sample(motion.at(one.reading().q_rad)) : std::nullopt;
      if (target_rad != end_rad) continue;
      ++settled;
      if (settled <= kSettleCycles - kRestCycles) continue;  // the second half is at rest
      end.q_rad += one.reading().q_rad / kRestCycles;
      end.torque_Nm += one.reading().torque_Nm / kRestCycles;
      end.plumb.add(plumbed);
    }
    return end;
  };
  const End begin = go_to(start_rad), highest = go_to(up), lowest = go_to(low), back = go_to(start_rad);

  const double model_up_Nm = motion.holding_Nm(highest, hanging), model_low_Nm = motion.holding_Nm(lowest, hanging);
  const bool up_on_stop = lies_on_stop(joint, highest.q_rad), low_on_stop = lies_on_stop(joint, lowest.q_rad);
  const bool up_pulls_more = low_on_stop || (!up_on_stop && std::abs(model_up_Nm) > std::abs(model_low_Nm));
  Wiggle result;
  result.asked_rad = up - start_rad;
  result.moved_rad = highest.q_rad - start_rad;
  result.asked_down_rad = start_rad - low;
  result.moved_down_rad = start_rad - lowest.q_rad;
  // Dry friction takes opposite signs on the two ways.
  result.held_Nm = 0.5 * (highest.torque_Nm + lowest.torque_Nm);
  result.model_Nm = 0.5 * (model_up_Nm + model_low_Nm);
  result.model_inverted_Nm = 0.5 * (motion.inverted_Nm(highest, hanging) + motion.inverted_Nm(lowest, hanging));
  result.on_stop = up_on_stop || low_on_stop;
  result.held_end_Nm = up_pulls_more ? highest.torque_Nm : lowest.torque_Nm;
  result.model_end_Nm = up_on_stop && low_on_stop ? 0.0 : (up_pulls_more ? model_up_Nm : model_low_Nm);
  result.inverted_end_Nm = motion.inverted_Nm(up_pulls_more ? highest : lowest, hanging);
  result.friction_Nm = joint.friction_Nm + motor.drive->torque_step_Nm();
  result.inverted_beyond_rad =
      std::max(beyond_range_rad(joint, -highest.q_rad), beyond_range_rad(joint, -lowest.q_rad));
  result.stopped_as_inverted = (up_short(result) && stopped_as_inverted(joint, start_rad, highest.q_rad)) ||
                               (down_short(result) && stopped_as_inverted(joint, highest.q_rad, lowest.q_rad));
  const auto at_begin = begin.plumb.mean(), at_back = back.plumb.mean(), at_highest = highest.plumb.mean(),
             at_lowest = lowest.plumb.mean();
  if (!at_begin || !at_back || !at_highest || !at_lowest) return result;
  model::Hanging now = hanging;
  now.down_B = at_begin->down_B;
  const auto way = leans(robot, motion.at(start_rad), motor.joint, now);
  if (!way) return result;
  result.leaned_rad = turned_rad(*at_lowest, *at_highest).dot(*way);
  result.least_lean_rad = std::max(kLeastLean_rad, kSureOfLean * std::abs(turned_rad(*at_begin, *at_back).dot(*way)));
  if (model::turns_base(robot, motor.joint, hanging))
    result.least_lean_rad = std::max(result.least_lean_rad, kLeastTurn * (highest.q_rad - lowest.q_rad));
  return result;
}

std::string way_of(const model::RobotModel& robot, const JointVector& q, const std::string& joint, double by_rad) {
  JointVector moved = q;
  moved[robot.joint_index.at(joint)] += by_rad;
  return way_between(robot, q, moved, joint);
}

std::string way_between(const model::RobotModel& robot, const JointVector& from, const JointVector& to,
                        const std::string& joint) {
  const Eigen::Vector3d way_mm =
      1e3 * (model::hanging_load(robot, joint, to).center_m - model::hanging_load(robot, joint, from).center_m);
  constexpr std::array<std::array<const char*, 2>, 3> kWays = {
      {{"forward", "backward"}, {"to the left", "to the right"}, {"up", "down"}}};
  std::vector<std::pair<double, std::string>> parts;
  for (int i = 0; i < 3; ++i) {
    const double length_mm = std::abs(way_mm(i));
    if (length_mm < 0.5) continue;
    parts.emplace_back(-length_mm, fmt::format("{:.0f} mm {}", length_mm,
                                               kWays[static_cast<std::size_t>(i)][way_mm(i) > 0.0 ? 0 : 1]));
  }
  if (parts.empty()) return "turns in place";
  std::ranges::sort(parts);
  std::vector<std::string> texts;
  for (const auto& part : parts) texts.push_back(part.second);
  return fmt::format("{}", fmt::join(texts, ", "));
}

Verdict verdict(const Wiggle& wiggle) {
  using Tells = Verdict::Tells;
  constexpr const char* kLeastAsked =
      "it moved less than half the way: a brake, a stop, another limb, too much friction, "
      "or another joint's motor";
  if (up_short(wiggle) && wiggle.moved_rad < 0.0)
    return {Tells::kWrong,
            "it moved the other way than its own drive was told: position and torque of the drive have "
            "opposite signs"};
  if (wiggle.stopped_as_inverted)
    return {Tells::kWrong, fmt::format("it moved less than half the way and stopped {}", kStoppedAsInverted)};
  if (up_short(wiggle) || down_short(wiggle)) return {Tells::kWrong, kLeastAsked};
  // Where several tell the direction, they must agree.
  const auto load = of_load(wiggle), lean = of_lean(wiggle);
  std::vector<Witness> all;
  for (const std::optional<Witness>& one : {load, lean, of_range(wiggle)}) {
    if (one) all.push_back(*one);
  }
  for (const Witness& one : all) {
    if (one.right == all.front().right) continue;
    return {Tells::kNotAll,
            fmt::format("{} says that `direction` is {}, {} says the opposite: compare the way with the eye",
                        all.front().name, all.front().right ? "right" : "wrong", one.name)};
  }
  if (lean && !lean->right)
    return {Tells::kWrong, "the base leans the other way than the model's: `direction` in robot.yaml is wrong"};
  const bool gear_known = std::abs(wiggle.model_end_Nm) >= kSure * wiggle.friction_Nm;
  // An end's torque has the friction in it, once.
  const auto carries = [&wiggle](double end_Nm) {
    const auto [lower_Nm, upper_Nm] =
        std::minmax({0.5 * end_Nm - wiggle.friction_Nm, 2.0 * end_Nm + wiggle.friction_Nm});
    return wiggle.held_end_Nm >= lower_Nm && wiggle.held_end_Nm <= upper_Nm;
  };
  const bool load_pulls_back = load && !load->right, inverted = load_pulls_back && carries(wiggle.inverted_end_Nm);
  if (gear_known && !carries(wiggle.model_end_Nm) && !inverted)
    return {
        Tells::kWrong,
        fmt::format("the drive holds {:.1f} times the model's load: look at `gear`, at the drive's torque constant, "
                    "and at the joint's zero",
                    wiggle.held_end_Nm / wiggle.model_end_Nm)};
  const bool direction_known = !all.empty();
  if (load_pulls_back)
    return {Tells::kWrong, "the load pulls the other way than the model's: `direction` in robot.yaml is wrong"};
  if (direction_known && gear_known) return {Tells::kAgrees, "direction and gear agree with the model"};
  if (gear_known)
    return {Tells::kNotAll,
            "its load agrees with the model's and would be the same the other way round: compare the way with the eye"};
  if (direction_known)
    return {Tells::kNotAll, "the direction agrees with the model; its load is too small to tell the gear"};
  return {Tells::kNotAll, "its load is too small to tell direction and gear: compare the way with the eye"};
}

}  // namespace pmg::can
