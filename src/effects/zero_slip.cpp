#include "effects/zero_slip.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <string>

#include "calib/unknown.hpp"

namespace pmg::effects {

namespace {

constexpr double kBeforeAll = 0.0, kAfterAll = 1.0;

/// Squares of each run's residuals; none where the model can't be simulated.
std::vector<double> squares_of_runs(const NestedFit& fit, const calib::JointModel& model) {
  std::vector<double> found;
  for (const Eigen::VectorXd& run : fit.residuals(model)) found.push_back(run.squaredNorm());
  return found;
}

}  // namespace

bool is_place(const std::string& parameter) { return calib::quantity(parameter) == model::Quantity::kPlace; }

std::vector<double> slip_places(const std::vector<calib::SingleJoint>& runs) {
  std::vector<const bench::BenchRun*> by_place;
  for (const calib::SingleJoint& joint : runs) by_place.push_back(&joint.run());
  std::ranges::sort(by_place, {}, &bench::BenchRun::place);
  const auto recorded = [&](std::size_t begin, std::size_t end) {
    std::set<std::string> trajectories;
    for (std::size_t i = begin; i < end; ++i) trajectories.insert(by_place[i]->trajectory);
    return trajectories;
  };
  const std::size_t count = by_place.size();
  std::vector<double> found;
  for (std::size_t i = kFewestBesideSlip; i + kFewestBesideSlip <= count; ++i) {
    const double before = by_place[i - 1]->place, after = by_place[i]->place;
    if (after > before && recorded(0, i) == recorded(i, count)) found.push_back(0.5 * (before + after));
  }
  return found;
}

double best_slip_place(const NestedFit& fit, calib::JointModel model) {
  double best = model.zero_slip_at, least = std::numeric_limits<double>::infinity();
  model.zero_slip_at = kBeforeAll;
  const std::vector<double> after = squares_of_runs(fit, model);
  model.zero_slip_at = kAfterAll;
  const std::vector<double> before = squares_of_runs(fit, model);
  if (before.empty() || after.empty()) return best;
  for (const double place : slip_places(fit.runs())) {
    double squares = 0.0;
    for (std::size_t r = 0; r < before.size(); ++r) squares += fit.runs()[r].run().place < place ? before[r] : after[r];
    if (!(squares < least)) continue;
    least = squares;
    best = place;
  }
  return best;
}

SlipGap slip_gap(const std::vector<calib::SingleJoint>& runs, double place) {
  SlipGap found;
  for (const calib::SingleJoint& joint : runs) {
    const bench::BenchRun& run = joint.run();
    if (run.place < place) {
      if (found.before == nullptr || run.place > found.before->place) found.before = &run;
    } else if (found.after == nullptr || run.place < found.after->place) {
      found.after = &run;
    }
  }
  return found;
}

}  // namespace pmg::effects
