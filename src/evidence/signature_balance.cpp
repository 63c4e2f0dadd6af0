#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "evidence/signature_checks.hpp"

namespace pmg::evidence {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Columns of the balance: drive = load + rotor + friction, all at the joint, in the drive's unit.
struct Columns {
  explicit Columns(const TorqueBalance& balance)
      : load(balance.integral([](const BalancePoint& p) { return p.gravity_Nm; }) + balance.load_inertia_Nm()),
        acceleration(balance.acceleration_rad_s2()),
        speed(balance.speed_rad_s()),
        direction(balance.integral([](const BalancePoint& p) { return p.direction; })),
        one(Column::Ones(direction.size())),
        heavy(balance.integral([](const BalancePoint& p) { return std::abs(p.load_Nm) * p.direction; })) {}
  Column load, acceleration, speed, direction, one, heavy;
};

Interval around(double value, double deviation) { return {value, value - 2.0 * deviation, value + 2.0 * deviation}; }

class BalanceChecks {
 public:
  BalanceChecks(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs, const SignatureOptions& options)
      : bench_(bench), options_(options), balance_(bench, runs, options.balance) {}

  std::vector<Signature> all() {
    const FoundShape shape = find_shape(balance_, options_.shape, options_.balance.collinear_share);
    if (balance_.shaped()) found_ = command_shape_checks(shape, balance_.sample_s(), options_.shape);
    columns_.emplace_back(balance_);
    drive_ = balance_.drive();
    const std::vector<int> clusters = balance_.clusters();
    enough_ = !clusters.empty() && clusters.back() + 1 >= options_.fewest_clusters;
    add_friction();
    add_offsets();
    add_drive();
    add_cogging();
    add_thermal();
    return std::move(found_);
  }

 private:
  const Columns& c() const { return columns_.front(); }
  bool position_pd() const { return bench_.law == bench::DriveLaw::kPositionPd; }
  bool pendulum() const { return bench_.rig == bench::Rig::kPendulum; }
  const char* drive_unit() const {
    if (bench_.law == bench::DriveLaw::kServoVoltage || bench_.law == bench::DriveLaw::kCascadePd) return "V";
    return bench_.rig == bench::Rig::kLinear ? "N" : "Nm";
  }

  ClusterRegression regression(const std::vector<Column>& base, bool whole_runs = false) const {
    return {base, drive_, balance_.clusters(whole_runs), options_.balance.collinear_share};
  }

  static Signature undecided(const std::string& effect, const Interval& value, const std::string& unit) {
    return {effect, "balance of torques", Agreement::kCannotTell, value, unit, ""};
  }

  void cannot_tell(const std::string& effect, const std::string& why) {
    found_.push_back(undecided(effect, {kNaN, kNaN, kNaN}, ""));
    found_.back().sentence = why;
  }

  const char* no_pendulum() const {
    return bench_.rig == bench::Rig::kRobot
               ? "only the robot's model says what hangs on this joint: this check needs a bench"
               : "no load hangs";
  }

  /// An effect that is one term of the balance. must_be_positive: friction cannot drive the motion.
  void add_term(const std::string& effect, const std::vector<Column>& base, const Column& column,
                const std::string& what, const std::string& unit, bool must_be_positive, double worth_share) {
    if (!enough_) return cannot_tell(effect, "too little motion was recorded");
    const TermEstimate e = regression(base).term(column);
    if (!(e.own > options_.own_share))
      return cannot_tell(effect, what + " can't be told from the rest in these recordings");
    Signature s = undecided(effect, around(e.coefficient, e.deviation), unit);
    const bool sure = must_be_positive ? e.t() > options_.sure_deviations : std::abs(e.t()) > options_.sure_deviations;
    if (sure && e.share > worth_share) {
      s.agreement = Agreement::kAgrees;
    } else if (std::abs(e.t()) <= options_.sure_deviations && e.share_upper < options_.disagrees_share * worth_share) {
      s.agreement = Agreement::kDisagrees;
    }
    s.sentence = fmt::format("{}: {:.3g} {} (deviation {:.2g}), {:.2f} % of the drive", what, e.coefficient, unit,
                             e.deviation, 100.0 * e.share);
    found_.push_back(s);
  }

  void add_friction() {
    add_term("coulomb", {c().load, c().acceleration, c().speed, c().one, c().heavy}, c().direction,
             "torque against the direction of motion, whatever the speed", drive_unit(), true, options_.friction_share);
    if (position_pd()) {
      add_term("viscous", {c().load, c().acceleration, c().direction, c().one, c().heavy}, c().speed,
               "torque against motion that grows with speed", "Nm s/rad", true, options_.friction_share);
    } else {
      cannot_tell("viscous", "the back-EMF of this drive looks the same");
    }
    const double slow_rad_s = options_.slow_share * balance_.fastest_rad_s();
    const Column slow = balance_.integral([slow_rad_s](const BalancePoint& p) {
      const double ratio = p.dq_rad_s / slow_rad_s;
      return std::exp(-ratio * ratio) * p.direction;
    });
    add_term("stribeck", {c().load, c().acceleration, c().speed, c().direction, c().one, c().heavy}, slow,
             fmt::format("friction below {:.2g} rad/s beyond that above", slow_rad_s), drive_unit(), false,
             options_.friction_share);
    if (pendulum()) {
      add_term("load_friction", {c().load, c().acceleration, c().speed, c().direction, c().one}, c().heavy,
               "friction per torque of gravity", "", true, options_.friction_share);
    } else {
      cannot_tell("load_friction", no_pendulum());
    }
  }

  void add_offsets() {
    const Column hanging = balance_.integral([](const BalancePoint& p) { return p.hanging_Nm; });
    std::vector<Column> base = {c().load, c().acceleration, c().speed, c().direction, c().heavy};
    std::vector<Column> with_hanging = base;
    if (pendulum()) with_hanging.push_back(hanging);
    for (const char* effect : {"offset", "direction_friction"}) {
      add_term(effect, with_hanging, c().one, "torque that one direction needs more than the other", drive_unit(),
               false, options_.constant_share);
    }
    base.push_back(c().one);
    if (pendulum()) {
      add_term("zero_offset", base, hanging, "gravity as if the joint stood elsewhere, by", "rad", false,
               options_.constant_share);
    } else {
      cannot_tell("zero_offset", no_pendulum());
    }
  }

  void add_drive() {
    const std::vector<Column> base = {c().load, c().acceleration, c().speed, c().direction, c().one, c().heavy};
    add_gain();
    add_dead_band();
    if (pendulum()) {
      add_term("load", base, balance_.load_inertia_Nm(), "inertia of the load beyond what its weight says", "", false,
               options_.load_share);
    }
    add_supply_sag(base);
    const double fastest_rad_s = balance_.fastest_rad_s();
    const Column hard_and_fast = balance_.integral([fastest_rad_s](const BalancePoint& p) {
      return p.drive * p.direction > 0.0 ? p.drive * std::abs(p.dq_rad_s) / fastest_rad_s : 0.0;
    });
    if (position_pd()) {
      add_term("torque_speed", base, hard_and_fast, "share of a driving torque that is missing at the highest speed",
               "", true, options_.drive_share);
    }
    const Column turning = balance_.integral(
        [this](const BalancePoint& p) { return p.since_turn_s < options_.reversal_s ? p.drive : 0.0; });
    add_term(
        "backlash", base, turning,
        fmt::format("share of the drive that is missing within {:.3g} ms of its reversal", 1e3 * options_.reversal_s),
        "", true, options_.drive_share);
  }

  /// With motor current i and duty d, the bridge draws the current d i from the bus. A source resistance R lowers the
  /// bus by R d i, and the motor's voltage by R d^2 i. The column is d^2 times the load's torque, which is proportional
  /// to i.
  void add_supply_sag(const std::vector<Column>& base) {
    if (bench_.law != bench::DriveLaw::kServoVoltage) {
      return cannot_tell("supply_sag", "this drive regulates its current, whatever the bus");
    }
    const double full = bench_.known.drive.limit * bench_.supply_V;
    add_term("supply_sag", base,
             balance_.integral([full](const BalancePoint& p) { return std::pow(p.drive / full, 2) * p.load_Nm; }),
             "drive that torques need beyond their share at full duty", "V/Nm", true, options_.drive_share);
  }

  /// Inside the band the gain's whole output is missing: a coefficient near 1 tells a dead band from friction.
  void add_dead_band() {
    if (!balance_.shaped() || !enough_) return cannot_tell("dead_band", "too little motion was recorded");
    if (bench_.rig == bench::Rig::kLinear) return cannot_tell("dead_band", "looked for on turning joints only");
    const ClusterRegression base =
        regression({c().load, c().acceleration, c().speed, c().direction, c().one, c().heavy});
    double band_rad = 0.0, surest_t = 0.0, largest_share = 0.0;
    TermEstimate surest;
    constexpr double kStep = 1.35;  // ratio of neighbouring bands: the resolution of the band found
    for (double limit_rad = options_.band_smallest_rad; limit_rad < options_.band_largest_rad; limit_rad *= kStep) {
      const TermEstimate e = base.term(balance_.integral(
          [limit_rad](const BalancePoint& p) { return std::abs(p.error_rad) < limit_rad ? p.error_drive : 0.0; }));
      if (std::abs(e.coefficient - 1.0) < options_.band_possible_within)
        largest_share = std::max(largest_share, e.share_upper);
      if (e.t() > surest_t) surest_t = e.t(), band_rad = limit_rad, surest = e;
    }
    Signature s = undecided("dead_band", {band_rad, band_rad / kStep, band_rad * kStep}, "rad");
    if (surest_t > options_.sure_deviations && std::abs(surest.coefficient - 1.0) < options_.band_agrees_within &&
        surest.share > options_.constant_share) {
      s.agreement = Agreement::kAgrees;
    } else if (surest.coefficient + 2.0 * surest.deviation < options_.band_disagrees_below ||
               largest_share < options_.disagrees_share * options_.constant_share) {
      s.agreement = Agreement::kDisagrees;
    }
    s.sentence = fmt::format("of the output of errors below {:.2g} rad a share of {:.2g} (deviation {:.2g}) is missing",
                             band_rad, surest.coefficient, surest.deviation);
    found_.push_back(s);
  }

  void add_gain() {
    if (!position_pd()) return cannot_tell("gain", "the unit of this drive is fitted anyway");
    if (!enough_) return cannot_tell("gain", "too little motion was recorded");
    const TermEstimate e = regression({c().acceleration, c().speed, c().direction, c().one, c().heavy}).term(c().load);
    if (!(e.own > options_.own_share) || !(e.coefficient > options_.gain_least)) {
      return cannot_tell("gain", "no load of known weight or inertia was moved");
    }
    const double gain = 1.0 / e.coefficient, deviation = e.deviation * gain * gain;
    Signature s = undecided("gain", around(gain, deviation), "");
    if (std::abs(gain - 1.0) > std::max<double>(options_.sure_deviations * deviation, options_.gain_error)) {
      s.agreement = Agreement::kAgrees;
    } else if (std::abs(gain - 1.0) + 2.0 * deviation < options_.gain_error) {
      s.agreement = Agreement::kDisagrees;
    }
    s.sentence = fmt::format("the drive gives {:.3g} (deviation {:.2g}) of what the load takes, by its own account",
                             e.coefficient, e.deviation);
    found_.push_back(s);
  }

  /// Takes the strongest of the orders, with a Bonferroni threshold for all of them: P(t2 > x) = exp(-x / 2) for
  /// chi-square with 2 degrees of freedom.
  void add_cogging() {
    if (!enough_) return cannot_tell("cogging", "too little motion was recorded");
    if (bench_.rig == bench::Rig::kLinear) return cannot_tell("cogging", "looked for on turning joints only");
    const ClusterRegression base = regression({c().load, c().acceleration, c().speed, c().direction, c().one, c().heavy,
                                               balance_.integral([](const BalancePoint& p) { return p.hanging_Nm; })});
    const auto highest = static_cast<int>(options_.cogging_highest_order);
    const double threshold = 2.0 * std::log(highest / options_.cogging_false_alarms);
    double best = 0.0, largest_missed = 0.0;
    int at = 0;
    ClusterRegression::Pair strongest;
    for (int order = static_cast<int>(options_.cogging_lowest_order); order <= highest; ++order) {
      const auto pair =
          base.pair(balance_.integral([order](const BalancePoint& p) { return std::sin(order * p.q_rad); }),
                    balance_.integral([order](const BalancePoint& p) { return std::cos(order * p.q_rad); }));
      if (!(pair.own > options_.cogging_own_share)) continue;
      largest_missed = std::max(largest_missed, pair.share);
      if (pair.t2 > best && pair.share > options_.friction_share) best = pair.t2, at = order, strongest = pair;
    }
    const double amplitude = strongest.coefficients.norm();
    const double deviation = best > 0.0 ? amplitude / std::sqrt(best) : 0.0;
    Signature s = undecided("cogging", around(amplitude, deviation), drive_unit());
    if (best > threshold) {
      s.agreement = Agreement::kAgrees;
    } else if (largest_missed < options_.disagrees_share * options_.friction_share) {
      s.agreement = Agreement::kDisagrees;
    }
    s.sentence = at == 0
                     ? "no torque that repeats with the angle"
                     : fmt::format("a torque of {:.3g} {} that repeats {} times a turn", amplitude, drive_unit(), at);
    found_.push_back(s);
  }

  void add_thermal() {
    const Column temperature = balance_.integral([](const BalancePoint& p) { return p.temp_C; });
    if (!enough_ || !temperature.allFinite()) return cannot_tell("thermal_drift", "no temperature was recorded");
    const double usual_C = temperature.mean(), range_K = temperature.maxCoeff() - temperature.minCoeff();
    const std::vector<int> runs = balance_.clusters(true);
    if (range_K < options_.thermal_range_K || runs.back() + 1 < options_.thermal_fewest_runs) {
      return cannot_tell("thermal_drift", fmt::format("temperatures differ by {:.1f} K only, or in few runs", range_K));
    }
    const ClusterRegression base =
        regression({c().load, c().acceleration, c().speed, c().direction, c().one, c().heavy}, true);
    const TermEstimate friction =
        base.term(balance_.integral([usual_C](const BalancePoint& p) { return (p.temp_C - usual_C) * p.direction; }));
    const TermEstimate load = base.term(c().load.cwiseProduct(temperature - usual_C * c().one));
    const bool by_friction = std::abs(friction.t()) > std::abs(load.t());
    const TermEstimate& e = by_friction ? friction : load;
    Signature s = undecided("thermal_drift", around(e.coefficient, e.deviation),
                            by_friction ? std::string(drive_unit()) + "/K" : "1/K");
    if (std::abs(e.t()) > options_.sure_deviations && e.share > options_.friction_share) {
      s.agreement = Agreement::kAgrees;
    } else if (std::max(friction.share_upper, load.share_upper) < options_.disagrees_share * options_.friction_share) {
      s.agreement = Agreement::kDisagrees;
    }
    s.sentence =
        fmt::format("{} changes by {:.3g} (deviation {:.2g}) a kelvin over {:.1f} K",
                    by_friction ? "friction" : "the drive that a load takes", e.coefficient, e.deviation, range_K);
    found_.push_back(s);
  }

  const bench::Bench& bench_;
  const SignatureOptions& options_;
  TorqueBalance balance_;
  std::vector<Columns> columns_;
  Column drive_;
  bool enough_ = false;
  std::vector<Signature> found_;
};

}  // namespace

std::vector<Signature> balance_checks(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                      const SignatureOptions& options) {
  return BalanceChecks(bench, runs, options).all();
}

}  // namespace pmg::evidence
