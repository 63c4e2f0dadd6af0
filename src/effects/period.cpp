#include "effects/period.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "calib/joint_runs.hpp"
#include "calib/unknown.hpp"
#include "fitting/folds.hpp"

namespace pmg::effects {

namespace {

fitting::Residuals at(const NestedFit& fit, calib::JointModel model, const std::string& parameter, double period_s) {
  calib::set(model, parameter, period_s);
  return fit.residuals(model);
}

constexpr double kFirstPeriods = 16.0;  // of a beginning's length
/// From one to the next of the first grid, at the end of a beginning. The right period is at most half of it off, and
/// must explain more than a wrong one that is in step where the commands jump.
constexpr double kOutOfStep_periods = 0.15;
constexpr double kCoarsest = 0.01, kFinest = 0.003;  // of a period: the same, limited
constexpr double kShort_s = 0.02;                    // shorter periods lie kCoarsest apart: they would be a thousand
constexpr double kApart = 0.045;                     // of a period: those that are followed
constexpr std::size_t kFollowed = 16, kStarts = 3;   // at first, and at the end

/// A period, and the squares of a beginning's residuals with it as a share of those without it.
struct TriedPeriod {
  double period_s = 0.0, share = 0.0;
};

bool explains_more(const TriedPeriod& a, const TriedPeriod& b) { return a.share < b.share; }

/// Runs that end sooner and sooner, and how much a period explains there.
class Beginnings {
 public:
  Beginnings(const NestedFit& fit, const calib::JointModel& without, const std::string& parameter)
      : whole_(calib::spread(fit.runs(), kRunsForPeriods)),
        threads_(fit.threads()),
        without_(without),
        parameter_(parameter) {
    for (const calib::SingleJoint& joint : whole_) {
      const bench::Recording& r = joint.run().recording;
      longest_s_ = std::max(longest_s_, r.t_s.back() - r.t_s.front());
      const auto moved = std::find_if(r.q_cmd_rad.begin(), r.q_cmd_rad.end(),
                                      [&](double command_rad) { return command_rad != r.q_cmd_rad.front(); });
      const auto sample = std::min<std::ptrdiff_t>(moved - r.q_cmd_rad.begin(), std::ssize(r.t_s) - 1);
      at_rest_s_ = std::max(at_rest_s_, r.t_s[static_cast<std::size_t>(sample)] - r.t_s.front());
    }
  }

  /// Length of a beginning in which the joint moves for so many periods [s], in steps of a quarter.
  double length_s(double period_s, double periods) const {
    const double length_s = at_rest_s_ + periods * period_s;
    return std::min(longest_s_, std::pow(1.25, std::ceil(std::log(length_s) / std::log(1.25))));
  }

  TriedPeriod tried(double period_s, double length_s) {
    const auto [known, fresh] = of_length_.try_emplace(length_s);
    Beginning& beginning = known->second;
    if (fresh) {
      for (const calib::SingleJoint& joint : whole_) beginning.runs.push_back(joint.beginning(length_s));
      beginning.squares = squares(without_, beginning.runs);
    }
    calib::JointModel model = without_;
    calib::set(model, parameter_, period_s);
    return {period_s, squares(model, beginning.runs) / std::max(beginning.squares, 1e-300)};
  }

  double longest_s() const { return longest_s_; }

 private:
  struct Beginning {
    std::vector<calib::SingleJoint> runs;
    double squares = 0.0;
  };

  double squares(const calib::JointModel& model, const std::vector<calib::SingleJoint>& runs) const {
    const fitting::Residuals found = calib::residuals(model, runs, threads_);
    return found.empty() ? 1e300 : fitting::sum_of_squares(found);
  }

  std::vector<calib::SingleJoint> whole_;
  unsigned threads_;
  const calib::JointModel& without_;
  const std::string& parameter_;
  double longest_s_ = 0.0, at_rest_s_ = 0.0;
  std::map<double, Beginning> of_length_;
};

/// Of the first grid, as a share of the period.
double grid_step(double period_s, double length_s) {
  return period_s < kShort_s ? kCoarsest : std::clamp(kOutOfStep_periods * period_s / length_s, kFinest, kCoarsest);
}

/// The best periods that lie apart by more than this share.
std::vector<TriedPeriod> best_apart(std::vector<TriedPeriod> all, double share, std::size_t most) {
  std::stable_sort(all.begin(), all.end(), explains_more);
  std::vector<TriedPeriod> found;
  for (const TriedPeriod& one : all) {
    const bool near = std::any_of(found.begin(), found.end(), [&](const TriedPeriod& other) {
      return std::abs(one.period_s - other.period_s) <= share * one.period_s;
    });
    if (!near && found.size() < most) found.push_back(one);
  }
  return found;
}

}  // namespace

bool is_period(const std::string& parameter) { return calib::quantity(parameter) == model::Quantity::kPeriod; }

std::vector<double> promising_periods_s(const NestedFit& fit, const calib::JointModel& model,
                                        const std::string& parameter, double low_s, double high_s) {
  Beginnings beginnings(fit, model, parameter);
  std::vector<TriedPeriod> tried;
  for (double period_s = low_s; period_s <= high_s;) {
    const double length_s = beginnings.length_s(period_s, kFirstPeriods);
    tried.push_back(beginnings.tried(period_s, length_s));
    period_s *= 1.0 + grid_step(period_s, length_s);
  }
  // Each time on runs twice as long, half as many of them stay.
  std::vector<TriedPeriod> best = best_apart(std::move(tried), kApart, kFollowed);
  double periods = kFirstPeriods, finer = 0.5;
  for (bool whole = false; !whole; periods *= 2.0, finer *= 0.5) {
    whole = true;
    for (TriedPeriod& one : best) {
      const double length_s = beginnings.length_s(one.period_s, periods);
      const double step = finer * grid_step(one.period_s, beginnings.length_s(one.period_s, kFirstPeriods));
      whole = whole && length_s >= beginnings.longest_s();
      one = std::min({beginnings.tried(one.period_s, length_s), beginnings.tried(one.period_s * (1.0 - step), length_s),
                      beginnings.tried(one.period_s * (1.0 + step), length_s)},
                     explains_more);
    }
    best = best_apart(best, 0.0, std::max(kStarts, best.size() / 2));
  }
  std::vector<double> found;
  for (const TriedPeriod& one : best) found.push_back(one.period_s);
  return found;
}

double best_period_s(const NestedFit& fit, const calib::JointModel& model, const std::string& parameter) {
  double best_s = calib::value(model, parameter);
  double least = fitting::sum_of_squares(fit.residuals(model));
  for (const double width : {0.04, 0.012, 0.004}) {
    const double middle_s = best_s;
    for (const double step : {-1.0, -0.5, 0.5, 1.0}) {
      const double period_s = middle_s * (1.0 + step * width);
      const double squares = fitting::sum_of_squares(at(fit, model, parameter, period_s));
      if (!(squares < least)) continue;
      least = squares;
      best_s = period_s;
    }
  }
  return best_s;
}

PeriodRange period_range(const NestedFit& fit, const NestedModel& model, const std::string& parameter,
                         double noise_squares, double deviations) {
  const double period_s = calib::value(model.model, parameter);
  const fitting::BlockComparison compare(fit.blocks(), {}, noise_squares);
  const fitting::Residuals residuals = fit.residuals(model.model);
  const Eigen::VectorXd here = fit.blocks().squares(residuals);
  const RolloutJacobian known = fit.jacobian(model, residuals);
  const auto worse = [&](const fitting::Residuals& there) {
    return there.empty() || compare(fit.blocks().squares(there), here).deviations > deviations;
  };
  const auto edge_s = [&](double side) {
    double tried_s = period_s;
    for (const double share : {0.01, 0.02, 0.04, 0.08, 0.15, 0.25, 0.35, 0.5}) {
      tried_s = period_s * (1.0 + side * share);
      if (worse(at(fit, model.model, parameter, tried_s)) &&
          worse(fit.residuals(fit.beside(model, parameter, tried_s, &known).model)))
        break;
    }
    return tried_s;
  };
  return {edge_s(-1.0), edge_s(1.0)};
}

}  // namespace pmg::effects
