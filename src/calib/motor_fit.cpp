#include "calib/motor_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

#include "work/parallel.hpp"

namespace pmg::calib {

namespace {

double seconds(const std::vector<SingleJoint>& runs) {
  double sum_s = 0.0;
  for (const SingleJoint& run : runs) sum_s += static_cast<double>(run.steps()) * run.step_s();
  return sum_s;
}

/// One fit: screening => searches from several starts => polish.
class MotorFitRun {
 public:
  MotorFitRun(const FitProblem& problem, const FitOptions& options, const work::Progress& progress)
      : all_(problem), few_(problem.thinned(options.runs_while_searching)), options_(options), progress_(progress) {}

  Fit run() {
    std::vector<Found> starts = screen();
    work::for_each_in_parallel(starts.size(), options_.threads, [&](std::size_t i) {
      starts[i] = search(options_.method, loss_of(few_, 1), starts[i].point,
                         limits(options_.method, 0.1, static_cast<unsigned>(i)), stopping());
      report(0.1 + 0.5 * static_cast<double>(++done_) / static_cast<double>(starts.size()),
             fmt::format("start {} of {}", done_.load(), starts.size()));
    });
    sort(starts);
    Fit fit;
    fit.starts = starts;
    polish(fit);
    fit.model = all_.model_at(fit.point);
    fit.evaluations = evaluations_;
    fit.simulated_s = simulated_s_;
    fit.interrupted = stopped_;
    return fit;
  }

 private:
  /// The best of the neutral start and a Latin hypercube of points.
  std::vector<Found> screen() {
    std::vector<std::vector<double>> points =
        spread_points(options_.screened_per_dimension * all_.dimensions(), all_.dimensions(), options_.seed);
    points.push_back(all_.point_of(all_.start()));
    const auto count = static_cast<double>(points.size());
    const Loss loss = loss_of(few_, 1);
    std::atomic<int> looks{0};
    const auto looked = [&](const std::vector<double>& point) {
      if (const int look = looks++; look % 16 == 0) report(0.1 * look / count, "looking for starts");
      return stopped_ ? 1e9 : loss(point);
    };
    std::vector<Found> found = screened(looked, std::move(points), options_.threads);
    found.resize(std::min<std::size_t>(found.size(), std::max(1U, options_.starts)));
    return found;
  }

  /// The best start, and the next best one that is nearly as good and not close to it.
  std::vector<Found> candidates(const std::vector<Found>& starts) const {
    constexpr double kNearlyAsGood = 1.05, kElsewhere = 0.02;  // of the loss, of the cube's edge
    std::vector<Found> chosen{starts.front()};
    for (const Found& other : starts) {
      double apart = 0.0;
      for (std::size_t d = 0; d < other.point.size(); ++d) {
        apart = std::max(apart, std::abs(other.point[d] - starts.front().point[d]));
      }
      if (apart < kElsewhere || other.loss > kNearlyAsGood * starts.front().loss) continue;
      chosen.push_back(other);
      break;
    }
    return chosen;
  }

  /// Fits the candidates to all runs: BOBYQA, which models the loss by parabolas, then SBPLX, which tolerates kinks.
  /// Never worse than the start model.
  void polish(Fit& fit) {
    const std::vector<Found> chosen = candidates(fit.starts);
    std::vector<double> history;
    const Loss loss = loss_of(all_, options_.threads);
    Found best{all_.point_of(all_.start()), 0.0, 1};
    best.loss = loss(best.point);
    const Loss remembered = [&](const std::vector<double>& point) {
      const double value = loss(point);
      history.push_back(history.empty() ? value : std::min(history.back(), value));
      return value;
    };
    if (stopped_) {  // no polish: keep the best so far
      const double found = remembered(chosen.front().point);
      if (found < best.loss) best = {chosen.front().point, found, 1};
    }
    for (std::size_t c = 0; c < chosen.size() && !stopped_; ++c) {
      Found at = followed(chosen[c], loss);
      for (const Method method : {Method::kBobyqa, Method::kSbplx}) {
        SearchOptions finely = limits(method, 0.03, 0);
        finely.relative_tolerance = 1e-6;
        at = search(method, remembered, at.point, finely, stopping());
        report(0.6 + 0.4 * (static_cast<double>(c) + (method == Method::kSbplx ? 1.0 : 0.5)) /
                         static_cast<double>(chosen.size()),
               fmt::format("polishing, {:.2f} mrad rms", 1e3 * std::sqrt(at.loss)));
      }
      if (at.loss < best.loss) best = at;
    }
    fit.point = best.point;
    fit.loss_rad2 = best.loss;
    fit.history = history;
  }

  /// Line search over a common factor on all torques. A load that is light relative to the rotor hardly determines it,
  /// and dry friction makes local minima along this valley, in which every search stops.
  std::vector<double> rescaled(const std::vector<double>& point, const Loss& loss) {
    constexpr int kLooks = 8;      // to either side
    constexpr double kMost = 4.0;  // up or down
    std::vector<double> best = point;
    double lowest = loss(point);
    for (int k = -kLooks; k <= kLooks && !stopped_; ++k) {
      const std::vector<double> there =
          all_.with_torques_scaled(point, std::pow(kMost, static_cast<double>(k) / kLooks));
      const double value = loss(there);
      if (value < lowest) lowest = value, best = there;
    }
    return best;
  }

  /// Gauss-Newton steps along a valley in which a search stopped: if the load is light relative to the rotor, a common
  /// factor on all torques hardly changes the rollouts. A search of one parameter at a time stops in this valley; a
  /// step in all parameters follows it. Never worse than the rescaled start.
  Found followed(const Found& start, const Loss& loss) {
    if (options_.newton_steps == 0) return start;
    const std::vector<double> from = rescaled(start.point, loss);
    const Found before{from, loss(from), 1};
    const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(from.data(), std::ssize(from));
    const fitting::Minimum minimum = fitting::gauss_newton(
        all_.least_squares(options_.threads), x,
        // Finite-difference slopes hold for about a tenth of the range: the longest step.
        {.most_iterations = options_.newton_steps, .relative_tolerance = 1e-6, .most_tries = 8, .longest_step = 0.1},
        stopping());
    Found after{{minimum.x.begin(), minimum.x.end()}, 0.0, minimum.evaluations + 1};
    after.loss = all_.loss(after.point, options_.threads);
    evaluations_ += after.evaluations;
    simulated_s_ += after.evaluations * seconds(all_.runs());
    return after.loss < before.loss ? after : before;
  }

  /// Global searches need more evaluations than local ones.
  SearchOptions limits(Method method, double step, unsigned turn) const {
    const int looks = method == Method::kCrs2 || method == Method::kCmaes ? 5 : 1;
    return {.most_evaluations = looks * options_.evaluations_per_dimension * static_cast<int>(all_.dimensions()),
            .first_step = step,
            .seed = options_.seed + turn};
  }

  Loss loss_of(const FitProblem& problem, unsigned threads) {
    const double each_s = seconds(problem.runs());
    return [this, &problem, threads, each_s](const std::vector<double>& point) {
      ++evaluations_;
      simulated_s_ += each_s;
      return problem.loss(point, threads);
    };
  }

  /// For searches: passes interruptions on, reports nothing.
  work::Progress stopping() {
    return {.report = {}, .interrupted = [this] {
              if (progress_.interrupted_now()) stopped_ = true;
              return stopped_.load();
            }};
  }

  /// Called by one thread at a time; the share never falls.
  void report(double share, const std::string& doing) {
    const std::lock_guard lock(reporting_);
    share_ = std::max(share_, share);
    if (!progress_(share_, doing)) stopped_ = true;
  }

  const FitProblem& all_;
  const FitProblem few_;
  const FitOptions& options_;
  const work::Progress& progress_;
  std::mutex reporting_;
  double share_ = 0.0;
  std::atomic<bool> stopped_{false};
  std::atomic<int> evaluations_{0};
  std::atomic<int> done_{0};
  std::atomic<double> simulated_s_{0.0};
};

}  // namespace

Fit fit(const FitProblem& problem, const FitOptions& options, const work::Progress& progress) {
  Fit found = MotorFitRun(problem, options, progress).run();
  if (!found.point.empty()) problem.expect_simulated(found.point);
  return found;
}

}  // namespace pmg::calib
