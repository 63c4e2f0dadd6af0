#include "can/linked_wiggle.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include "can/few_motors.hpp"
#include "can/wiggle_limits.hpp"

namespace pmg::can {

namespace {

constexpr double kSameWay = 0.7;     // cosine between the ways that the base turned and should have turned: 45 degrees
constexpr double kBetterLoad = 2.0;  // times worse than the best, an arrangement's load is ruled out
constexpr double kWayMargin_rad = 0.2;  // beyond a range at the start, as for other joints in the roll call

/// Motor i, as robot.yaml has it, turns crank[i] with this sign.
template <int N>
struct Arrangement {
  std::array<std::size_t, static_cast<std::size_t>(N)> crank{};
  std::array<double, static_cast<std::size_t>(N)> sign{};
  std::string words;  ///< against robot.yaml; empty: as it has it
};

template <int N>
using Angles = typename drives::RodLinkage<N>::Angles;
template <int N>
using Jacobian = typename drives::RodLinkage<N>::Jacobian;

std::string inverted_words(const drives::MotorSetup& motor) {
  return fmt::format("`direction` of {}'s motor is wrong", motor.joint);
}

/// All of them, robot.yaml's first.
template <int N>
std::vector<Arrangement<N>> arrangements(const BusSetup& bus, const drives::LinkedMotors<N>& linked) {
  constexpr auto kN = static_cast<std::size_t>(N);
  std::vector<Arrangement<N>> all;
  for (std::size_t swapped = 0; swapped < kN; ++swapped) {
    for (unsigned signs = 0; signs < 1U << kN; ++signs) {
      Arrangement<N> one;
      std::vector<std::string> words;
      if (swapped != 0)
        words.push_back(fmt::format("the motors of {} and {} are swapped", bus.motors[linked.motors[0]].joint,
                                    bus.motors[linked.motors[kN - 1]].joint));
      for (std::size_t i = 0; i < kN; ++i) {
        one.crank[i] = swapped != 0 ? kN - 1 - i : i;
        const bool inverted = (signs >> i & 1U) != 0;
        one.sign[i] = inverted ? -1.0 : 1.0;
        if (inverted) words.push_back(inverted_words(bus.motors[linked.motors[i]]));
      }
      one.words = fmt::format("{}", fmt::join(words, ", and "));
      all.push_back(one);
    }
  }
  return all;
}

/// (of robot.yaml's motors) => (of the cranks that they really turn).
template <int N>
Angles<N> arranged(const Arrangement<N>& arrangement, const std::vector<double>& motors) {
  Angles<N> cranks;
  for (std::size_t i = 0; i < motors.size(); ++i)
    cranks[static_cast<Eigen::Index>(arrangement.crank[i])] = arrangement.sign[i] * motors[i];
  return cranks;
}

template <int N>
bool within(const drives::LinkedMotors<N>& linked, const Angles<N>& q_rad, double margin_rad) {
  for (std::size_t j = 0; j < linked.joints.size(); ++j) {
    const double at = q_rad[static_cast<Eigen::Index>(j)];
    if (at < linked.joints[j].q_lower_rad - margin_rad || at > linked.joints[j].q_upper_rad + margin_rad) return false;
  }
  return true;
}

/// Joints within their ranges.
template <int N>
std::optional<Angles<N>> posture(const drives::LinkedMotors<N>& linked, const Angles<N>& cranks, double margin_rad) {
  const auto q = linked.linkage.joint_angles(cranks, Angles<N>::Zero());
  return q && within(linked, *q, margin_rad) ? q : std::nullopt;
}

/// Calls with the linkage that turns the motor's joint. False: there is none.
template <typename Take>
bool with_linkage(const BusSetup& bus, const drives::MotorSetup& motor, Take&& take) {
  const auto has = [&](const auto& linked) {
    return std::ranges::any_of(linked.motors, [&](std::size_t m) { return bus.motors[m].joint == motor.joint; });
  };
  const auto four_bar = std::ranges::find_if(bus.four_bars, has);
  const auto parallel = std::ranges::find_if(bus.parallel, has);
  if (four_bar != bus.four_bars.end()) {
    take(*four_bar, std::integral_constant<int, 1>());
  } else if (parallel != bus.parallel.end()) {
    take(*parallel, std::integral_constant<int, 2>());
  } else {
    return false;
  }
  return true;
}

/// A linkage in its robot.
template <int N>
class Judge {
 public:
  static constexpr auto kN = static_cast<std::size_t>(N);
  Judge(const model::RobotModel& robot, const JointVector& q, const BusSetup& bus,
        const drives::LinkedMotors<N>& linked, const model::Hanging& hanging)
      : robot_(robot), q_(q), bus_(bus), linked_(linked), hanging_(hanging) {}

  const std::string& joint(std::size_t j) const { return bus_.motors[linked_.motors[j]].joint; }
  /// All joints, with these of the linkage.
  JointVector whole(const Angles<N>& q_rad) const {
    JointVector q = q_;
    for (std::size_t j = 0; j < kN; ++j) q[bus_.motors[linked_.motors[j]].index] = q_rad[static_cast<Eigen::Index>(j)];
    return q;
  }
  /// Torques of the cranks that hold the joints at rest: J^-T times the joints'.
  Angles<N> holding_Nm(const Angles<N>& q_rad, const Angles<N>& crank_rad,
                       const std::optional<Plumb::Sample>& plumb) const {
    model::Hanging hanging = hanging_;
    if (plumb) hanging.down_B = plumb->down_B;
    const JointVector q = whole(q_rad);
    Angles<N> joints;
    for (std::size_t j = 0; j < kN; ++j) {
      const auto at = static_cast<Eigen::Index>(j);
      joints[at] = model::gravity_load(robot_, joint(j), q, hanging).holding_Nm(q_rad[at]);
    }
    return to_cranks(q_rad, crank_rad).transpose() * joints;
  }
  /// Within which torques can't be compared: friction of both joints, and a step of a reading.
  Angles<N> friction_Nm(const Angles<N>& q_rad, const Angles<N>& crank_rad) const {
    Angles<N> joints, steps;
    for (std::size_t j = 0; j < kN; ++j) {
      const drives::MotorSetup& motor = bus_.motors[linked_.motors[j]];
      const auto at = static_cast<Eigen::Index>(j);
      joints[at] = robot_.joints[static_cast<std::size_t>(motor.index)].friction_Nm;
      steps[at] = std::abs(
          motor.transmission.to_joint(drives::MotorCommand{.torque_Nm = motor.drive->torque_step_Nm()}).torque_Nm);
    }
    return to_cranks(q_rad, crank_rad).cwiseAbs().transpose() * joints + steps;
  }

  /// How far the load is from what was held, in frictions; infinite: a joint is beyond its range.
  double load_error(const Arrangement<N>& arrangement, const std::vector<LinkedWay>& ways) const {
    double worst = 0.0;
    for (const LinkedWay& way : ways) {
      Angles<N> mean = Angles<N>::Zero(), friction = Angles<N>::Zero();
      for (const CrankEnd* end : {&way.highest, &way.lowest}) {
        const Angles<N> cranks = arranged<N>(arrangement, end->crank_rad);
        const auto q = posture(linked_, cranks, kOnStop_rad);
        if (!q) return std::numeric_limits<double>::infinity();
        mean += 0.5 * (arranged<N>(arrangement, end->torque_Nm) - holding_Nm(*q, cranks, end->plumb));
        friction = friction.cwiseMax(friction_Nm(*q, cranks));
      }
      worst = std::max(worst, mean.cwiseAbs().cwiseQuotient(friction).maxCoeff());
    }
    return worst;
  }

  /// The base turned otherwise than it would have. Only of joints between the base and what the gantry holds.
  bool base_denies(const Arrangement<N>& arrangement, const std::vector<LinkedWay>& ways) const {
    return std::ranges::any_of(ways, [&](const LinkedWay& way) {
      if (!model::turns_base(robot_, way.joint, hanging_)) return false;
      if (!way.highest.plumb || !way.lowest.plumb || !way.begin.plumb || !way.back.plumb) return false;
      const auto held_in_base = [&](const CrankEnd& end) {
        const auto q = posture(linked_, arranged<N>(arrangement, end.crank_rad), kOnStop_rad);
        return link_in_base(robot_, hanging_.held_link, whole(q.value_or(Angles<N>::Zero())));
      };
      const Plumb::Sample low{.down_B = {}, .base_WB = held_in_base(way.lowest).conjugate()},
          high{.down_B = {}, .base_WB = held_in_base(way.highest).conjugate()};
      const Eigen::Vector3d expected = turned_rad(low, high),
                            turned = turned_rad(*way.lowest.plumb, *way.highest.plumb);
      const double least = std::max({kLeastLean_rad, kLeastTurn * expected.norm(),
                                     kSureOfLean * turned_rad(*way.begin.plumb, *way.back.plumb).norm()});
      return turned.norm() >= least && turned.dot(expected) < kSameWay * turned.norm() * expected.norm();
    });
  }

  /// What the eye would see for the + of each joint that robot.yaml has.
  std::string look(const Arrangement<N>& arrangement, const std::vector<LinkedWay>& ways) const {
    std::vector<std::string> seen;
    for (const LinkedWay& way : ways) {
      const auto from = posture(linked_, arranged<N>(arrangement, way.lowest.crank_rad), kOnStop_rad),
                 to = posture(linked_, arranged<N>(arrangement, way.highest.crank_rad), kOnStop_rad);
      if (from && to)
        seen.push_back(fmt::format("for {}'s + the limb goes {}", way.joint,
                                   way_between(robot_, whole(*from), whole(*to), joint(0))));
    }
    return fmt::format("{}", fmt::join(seen, "; "));
  }

 private:
  Jacobian<N> to_cranks(const Angles<N>& q_rad, const Angles<N>& crank_rad) const {
    return linked_.linkage.jacobian(crank_rad, q_rad).inverse();
  }
  const model::RobotModel& robot_;
  const JointVector& q_;
  const BusSetup& bus_;
  const drives::LinkedMotors<N>& linked_;
  const model::Hanging& hanging_;
};

/// Drives the motors of a linkage through it.
template <int N>
class Driven {
 public:
  static constexpr auto kN = static_cast<std::size_t>(N);
  struct Given {
    const model::RobotModel& robot;
    const JointVector& q;
    const BusSetup& bus;
    const drives::LinkedMotors<N>& linked;
    const WiggleOptions& options;
    const std::function<bool()>& interrupted;
    const model::Hanging& hanging;
    Plumb* plumb;
  };
  Driven(const Given& given, Link& link, const std::function<void()>& tick)
      : given_(given),
        judge_(given.robot, given.q, given.bus, given.linked, given.hanging),
        motors_(given.bus, setups(given), link, tick, [plumb = given.plumb](const drives::Message& message) {
          if (plumb != nullptr) plumb->hear(message);
        }) {
    measure();
    if (!within(given.linked, q_rad_, kOnStop_rad)) {
      const std::string other = arranged_within_ranges(given.bus, setup(0), crank_angles());
      throw std::runtime_error(fmt::format("{} are at {:.3f} rad; expected a start within their ranges: {}",
                                           fmt::join(linked_joints(given.bus, setup(0)), " and "),
                                           fmt::join(q_rad_.begin(), q_rad_.end(), " and "),
                                           other.empty() ? "set their zeros first" : other + ", or the zeros"));
    }
    target_rad_ = q_rad_;
    motors_.switch_on();
  }

  LinkedWay way(std::size_t j) {
    const auto at = static_cast<Eigen::Index>(j);
    const double start_rad = target_rad_[at];
    const double by_rad = given_.options.by_rad.value_or(
        telling_way_rad(given_.robot, judge_.whole(q_rad_), judge_.joint(j), given_.hanging));
    const drives::MotorLimits& range = given_.linked.joints[j];
    const double up = std::min(start_rad + by_rad, range.q_upper_rad),
                 low = std::max(start_rad - by_rad, range.q_lower_rad);
    LinkedWay way{.joint = judge_.joint(j), .asked_rad = up - start_rad, .asked_down_rad = start_rad - low};
    allow_load(j, up, low);
    way.begin = go_to(j, start_rad);
    const double began_rad = mean_rad_[at];
    way.highest = go_to(j, up);
    way.moved_rad = mean_rad_[at] - began_rad;
    way.lowest = go_to(j, low);
    way.moved_down_rad = began_rad - mean_rad_[at];
    way.back = go_to(j, start_rad);
    return way;
  }

 private:
  static std::vector<const drives::MotorSetup*> setups(const Given& given) {
    std::vector<const drives::MotorSetup*> setups;
    for (const std::size_t m : given.linked.motors) setups.push_back(&given.bus.motors[m]);
    return setups;
  }
  const drives::MotorSetup& setup(std::size_t i) const { return given_.bus.motors[given_.linked.motors[i]]; }
  std::vector<double> crank_angles() const { return {crank_rad_.begin(), crank_rad_.end()}; }

  /// Of each motor as much torque as the model's load may need on the joint's way, twice, and a share of its effort.
  void allow_load(std::size_t j, double up_rad, double low_rad) {
    Angles<N> load_Nm = Angles<N>::Zero();
    for (const double end_rad : {up_rad, low_rad}) {
      Angles<N> q_rad = target_rad_;
      q_rad[static_cast<Eigen::Index>(j)] = end_rad;
      const auto cranks = given_.linked.linkage.motor_angles(q_rad);
      if (cranks) load_Nm = load_Nm.cwiseMax(judge_.holding_Nm(q_rad, *cranks, std::nullopt).cwiseAbs());
    }
    for (std::size_t i = 0; i < kN; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const double effort_Nm = std::abs(
          setup(i).transmission.to_joint(drives::MotorCommand{.torque_Nm = setup(i).limits.torque_Nm}).torque_Nm);
      most_Nm_[at] = given_.options.effort_share * effort_Nm + 2.0 * load_Nm[at];
    }
  }

  /// (what the motors said) => joints and cranks.
  void measure() {
    typename drives::RodLinkage<N>::Readings cranks{};
    for (std::size_t i = 0; i < kN; ++i) {
      cranks[i] = motors_.reading(i);
      crank_rad_[static_cast<Eigen::Index>(i)] = cranks[i].q_rad;
      torque_Nm_[static_cast<Eigen::Index>(i)] = cranks[i].torque_Nm;
    }
    const auto joints = given_.linked.linkage.to_joints(cranks, q_rad_);
    if (!joints)
      throw std::runtime_error(fmt::format(
          "{}: no angles of these joints belong to their cranks' ({:.3f} rad); expected cranks and rods as `linkages` "
          "has them: look at zeros, directions, and whether the motors are swapped; they are switched off",
          fmt::join(linked_joints(given_.bus, setup(0)), " and "), fmt::join(crank_angles(), " and ")));
    for (std::size_t j = 0; j < kN; ++j) {
      q_rad_[static_cast<Eigen::Index>(j)] = (*joints)[j].q_rad;
      dq_rad_s_[static_cast<Eigen::Index>(j)] = (*joints)[j].dq_rad_s;
    }
  }

  void exchange() {
    if (given_.interrupted && given_.interrupted())
      throw std::runtime_error("interrupted; the motors are switched off");
    typename drives::RodLinkage<N>::Commands joints{};
    for (std::size_t j = 0; j < kN; ++j) {
      const model::Joint& joint = given_.robot.joints[static_cast<std::size_t>(setup(j).index)];
      joints[j] = {.q_rad = target_rad_[static_cast<Eigen::Index>(j)],
                   .kp_Nm_per_rad = given_.options.gain_share * joint.kp_Nm_per_rad,
                   .kd_Nm_s_per_rad = given_.options.gain_share * joint.kd_Nm_s_per_rad};
    }
    motors_.exchange(given_.linked.linkage.to_motors(joints, q_rad_, dq_rad_s_, crank_rad_));
    measure();
    for (std::size_t i = 0; i < kN; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      if (std::abs(torque_Nm_[at]) <= most_Nm_[at]) continue;
      throw std::runtime_error(fmt::format(
          "{} meets {:.1f} Nm at its crank; expected {:.1f} Nm at most on this way: something blocks it, or "
          "gear, zeros or rods are wrong; the motors are switched off",
          name_of(given_.bus, setup(i)), std::abs(torque_Nm_[at]), most_Nm_[at]));
    }
  }

  CrankEnd go_to(std::size_t j, double end_rad) {
    double& target_rad = target_rad_[static_cast<Eigen::Index>(j)];
    Angles<N> cranks = Angles<N>::Zero(), torques = Angles<N>::Zero();
    PlumbMean plumbs;
    mean_rad_.setZero();
    for (int settled = 0; settled < kSettleCycles;) {
      target_rad += std::clamp(end_rad - target_rad, -given_.options.speed_rad_s * kCycle_s,
                               given_.options.speed_rad_s * kCycle_s);
      exchange();
      const auto plumbed = given_.plumb != nullptr ? given_.plumb->sample(judge_.whole(q_rad_)) : std::nullopt;
      if (target_rad != end_rad) continue;
      ++settled;
      if (settled <= kSettleCycles - kRestCycles) continue;
      cranks += crank_rad_ / kRestCycles;
      torques += torque_Nm_ / kRestCycles;
      mean_rad_ += q_rad_ / kRestCycles;
      plumbs.add(plumbed);
    }
    return {.crank_rad = {cranks.begin(), cranks.end()},
            .torque_Nm = {torques.begin(), torques.end()},
            .plumb = plumbs.mean()};
  }

  Given given_;
  Judge<N> judge_;
  FewMotors motors_;
  Angles<N> q_rad_ = Angles<N>::Zero(), dq_rad_s_ = Angles<N>::Zero(), crank_rad_ = Angles<N>::Zero(),
            torque_Nm_ = Angles<N>::Zero(), target_rad_ = Angles<N>::Zero(), most_Nm_ = Angles<N>::Zero(),
            mean_rad_ = Angles<N>::Zero();
};

template <int N>
Verdict judge_ways(const Judge<N>& judge, const std::vector<Arrangement<N>>& all, const std::vector<LinkedWay>& ways) {
  using Tells = Verdict::Tells;
  for (const LinkedWay& way : ways) {
    if (!is_short(way.asked_rad, way.moved_rad, kNoWay_rad) &&
        !is_short(way.asked_down_rad, way.moved_down_rad, kLeastWay_rad))
      continue;
    return {Tells::kWrong,
            fmt::format("{} moved less than half the way: a brake, a stop, another limb, too much friction, "
                        "or another joint's motor",
                        way.joint)};
  }
  std::vector<double> errors;
  for (const Arrangement<N>& one : all) errors.push_back(judge.load_error(one, ways));
  std::vector<const Arrangement<N>*> possible;
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!std::isfinite(errors[i]) || judge.base_denies(all[i], ways))
      errors[i] = std::numeric_limits<double>::infinity();
    best = std::min(best, errors[i]);
  }
  if (best > kSure)
    return {Tells::kWrong,
            "no arrangement of these motors explains what they held: look at `gear`, at the drives' torque "
            "constants, and at the zeros"};
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (std::isfinite(errors[i]) && (errors[i] <= kRuledOut || errors[i] <= kBetterLoad * best))
      possible.push_back(&all[i]);
  }
  std::vector<std::string> words;
  for (const Arrangement<N>* one : possible) words.push_back(one->words);
  Verdict verdict =
      verdict_of(words, {.name = "load and base", .advice = "compare the ways with the eye", .seems = "it moves"});
  for (const Arrangement<N>* one : possible) {
    if (one->words.empty() && verdict.tells != Tells::kNotAll) continue;
    const std::string what = one->words.empty() ? "as robot.yaml has it" : "if " + one->words;
    verdict.look.push_back(fmt::format("{}: {}", what, judge.look(*one, ways)));
  }
  return verdict;
}

}  // namespace

std::vector<std::string> linked_joints(const BusSetup& bus, const drives::MotorSetup& motor) {
  std::vector<std::string> names;
  with_linkage(bus, motor, [&](const auto& linked, auto /*size*/) {
    for (const std::size_t m : linked.motors) names.push_back(bus.motors[m].joint);
  });
  return names;
}

std::vector<LinkedWay> wiggle_linked(const model::RobotModel& robot, const JointVector& q, const BusSetup& bus,
                                     const drives::MotorSetup& motor, Link& link, const WiggleOptions& options,
                                     const std::function<void()>& tick, const std::function<bool()>& interrupted,
                                     const model::Hanging& hanging, Plumb* plumb) {
  std::vector<LinkedWay> ways;
  with_linkage(bus, motor, [&](const auto& linked, auto size) {
    Driven<size()> driven({robot, q, bus, linked, options, interrupted, hanging, plumb}, link, tick);
    for (std::size_t j = 0; j < linked.motors.size(); ++j) ways.push_back(driven.way(j));
  });
  return ways;
}

Verdict verdict(const model::RobotModel& robot, const JointVector& q, const BusSetup& bus,
                const drives::MotorSetup& motor, const std::vector<LinkedWay>& ways, const model::Hanging& hanging) {
  Verdict said;
  with_linkage(bus, motor, [&](const auto& linked, auto size) {
    const Judge<size()> judge(robot, q, bus, linked, hanging);
    said = judge_ways<size()>(judge, arrangements<size()>(bus, linked), ways);
  });
  return said;
}

std::vector<double> cranks_at(const BusSetup& bus, const drives::MotorSetup& motor, const JointVector& q) {
  std::vector<double> cranks_rad = {q[motor.index]};
  with_linkage(bus, motor, [&](const auto& linked, auto size) {
    Angles<size()> joints;
    for (std::size_t j = 0; j < linked.motors.size(); ++j)
      joints[static_cast<Eigen::Index>(j)] = q[bus.motors[linked.motors[j]].index];
    const auto cranks = linked.linkage.motor_angles(joints);
    if (!cranks)
      throw std::runtime_error(fmt::format("no cranks' angles belong to {} at {:.3f} rad",
                                           fmt::join(linked_joints(bus, motor), " and "),
                                           fmt::join(joints.begin(), joints.end(), " and ")));
    cranks_rad = {cranks->begin(), cranks->end()};
  });
  return cranks_rad;
}

std::vector<Connection> connections(const BusSetup& bus, const drives::MotorSetup& motor,
                                    const std::vector<double>& cranks_rad) {
  std::vector<Connection> all;
  if (with_linkage(bus, motor, [&](const auto& linked, auto size) {
        for (const auto& one : arrangements<size()>(bus, linked)) {
          const auto q = posture(linked, arranged<size()>(one, cranks_rad), kWayMargin_rad);
          if (q) all.push_back({one.words, {q->begin(), q->end()}});
        }
      }))
    return all;
  return {{"", cranks_rad}, {inverted_words(motor), {-cranks_rad[0]}}};
}

std::string arranged_within_ranges(const BusSetup& bus, const drives::MotorSetup& motor,
                                   const std::vector<double>& cranks_rad) {
  std::vector<std::string> words;
  for (const Connection& one : connections(bus, motor, cranks_rad)) words.push_back(one.words);
  if (words.empty() || words.front().empty()) return {};
  return fmt::format("{}", fmt::join(words, "; or "));
}

Verdict verdict_of(const std::vector<std::string>& possible, const Evidence& evidence) {
  using Tells = Verdict::Tells;
  std::vector<std::string> others = possible;
  std::erase(others, "");
  if (others.size() == possible.size())
    return {Tells::kWrong, fmt::format("{} as if {}", evidence.seems, fmt::join(others, "; or as if "))};
  if (others.empty()) return {Tells::kAgrees, "motors, rods and directions agree with the model"};
  return {Tells::kNotAll, fmt::format("{} can't tell it from {} other arrangement{}: {}", evidence.name, others.size(),
                                      others.size() > 1 ? "s" : "", evidence.advice)};
}

}  // namespace pmg::can
