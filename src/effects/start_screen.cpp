#include "effects/start_screen.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/fit_problem.hpp"
#include "calib/joint_runs.hpp"

namespace pmg::effects {

namespace {

constexpr std::size_t kMostStarts = 4;
constexpr std::size_t kRunsForOrders = 10;  // a hundred orders of a wave are screened on so many runs first
constexpr double kPi = 3.141592653589793;

}  // namespace

StartScreen::StartScreen(const NestedFit& fit, const NestedModel& current)
    : fit_(fit),
      current_(current),
      residuals_(fit.residuals(current.model)),
      jacobian_(fit.jacobian(current, residuals_)) {
  const Eigen::Index count = current.coordinates.size();
  information_ = Eigen::MatrixXd::Zero(count, count);
  for (const Eigen::MatrixXd& slope : jacobian_.of_run) information_ += slope.transpose() * slope;
}

/// One bounded Gauss-Newton step d of the unknowns that the effect does not set; expected squares
/// r^T r + 2 g^T d + d^T A d, with g = J^T r and A = J^T J of the current model's Jacobian.
void StartScreen::refit_linearly(const fitting::Residuals& residuals, const Effect& effect,
                                 ScreenedStart& start) const {
  start.squares = fitting::sum_of_squares(residuals);
  if (!std::isfinite(start.squares) || current_.coordinates.size() == 0) return;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(current_.coordinates.size());
  for (std::size_t i = 0; i < residuals.size(); ++i) gradient += jacobian_.of_run[i].transpose() * residuals[i];
  const Eigen::VectorXd step =
      fitting::bounded_step(information_, gradient, current_.ranges, current_.coordinates, 1e-3);
  start.squares = std::max(0.0, start.squares + 2.0 * gradient.dot(step) + step.dot(information_ * step));
  for (Eigen::Index i = 0; i < step.size(); ++i) {
    const Unknown& u = current_.unknowns[static_cast<std::size_t>(i)];
    if (std::find(effect.parameters.begin(), effect.parameters.end(), u.name) != effect.parameters.end()) continue;
    calib::set(start.model, u.name, u.value(current_.coordinates[i] + step[i]));
  }
}

void StartScreen::screen(const Effect& effect, const std::vector<double>& values,
                         std::vector<ScreenedStart>& into) const {
  ScreenedStart start{current_.model, 0.0};
  for (std::size_t p = 0; p < values.size(); ++p) calib::set(start.model, effect.parameters[p], values[p]);
  const fitting::Residuals there = fit_.residuals(start.model);
  if (there.empty()) return;
  refit_linearly(there, effect, start);
  if (std::isfinite(start.squares)) into.push_back(start);
  if (values.size() == 1 || effect.name == "load") line_search(effect, values, there, into);
}

/// Line search on the linear model r0 + s (r - r0) from the model without the effect: s = -(r - r0).r0 / |r - r0|^2,
/// within 0..3. For the load's effect and effects of one parameter, in which rollouts are nearly linear.
void StartScreen::line_search(const Effect& effect, const std::vector<double>& values, const fitting::Residuals& there,
                              std::vector<ScreenedStart>& into) const {
  double along = 0.0, across = 0.0;
  for (std::size_t i = 0; i < there.size(); ++i) {
    const Eigen::VectorXd direction = there[i] - residuals_[i];
    along -= direction.dot(residuals_[i]);
    across += direction.squaredNorm();
  }
  if (!(across > 0.0)) return;
  const double share = std::clamp(along / across, 0.0, 3.0);
  if (share < 0.02) return;
  ScreenedStart scaled{current_.model, 0.0};
  for (std::size_t p = 0; p < values.size(); ++p) {
    const double from = calib::value(current_.model, effect.parameters[p]);
    if (!std::isfinite(from)) return;
    calib::set(scaled.model, effect.parameters[p], from + share * (values[p] - from));
  }
  fitting::Residuals moved = there;
  for (std::size_t i = 0; i < there.size(); ++i) moved[i] = residuals_[i] + share * (there[i] - residuals_[i]);
  refit_linearly(moved, effect, scaled);
  if (std::isfinite(scaled.squares)) into.push_back(scaled);
}

/// The response to a small wave over the joint's angle is linear in its sine and cosine parts: two rollouts give the
/// least-squares amplitude and phase (2 x 2 normal equations).
void StartScreen::screen_wave(const Effect& effect, const std::string& amplitude, const std::string& phase,
                              double height, const calib::JointModel& flat, std::vector<ScreenedStart>& into) const {
  ScreenedStart start{flat, 0.0};
  calib::set(start.model, amplitude, height);
  calib::set(start.model, phase, 0.0);
  const fitting::Residuals sine = fit_.residuals(start.model);
  calib::set(start.model, phase, 0.5 * kPi);
  const fitting::Residuals cosine = fit_.residuals(start.model);
  if (sine.empty() || cosine.empty()) return;
  Eigen::Matrix2d a = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < sine.size(); ++i) {
    const Eigen::VectorXd s = sine[i] - residuals_[i], c = cosine[i] - residuals_[i];
    a(0, 0) += s.squaredNorm();
    a(0, 1) += s.dot(c);
    a(1, 1) += c.squaredNorm();
    b[0] -= s.dot(residuals_[i]);
    b[1] -= c.dot(residuals_[i]);
  }
  a(1, 0) = a(0, 1);
  const double determinant = a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0);
  if (!(determinant > 1e-9 * a(0, 0) * a(1, 1))) return;
  const Eigen::Vector2d share((a(1, 1) * b[0] - a(0, 1) * b[1]) / determinant,
                              (-a(0, 1) * b[0] + a(0, 0) * b[1]) / determinant);
  fitting::Residuals moved = residuals_;
  for (std::size_t i = 0; i < sine.size(); ++i) {
    moved[i] += share[0] * (sine[i] - residuals_[i]) + share[1] * (cosine[i] - residuals_[i]);
  }
  calib::set(start.model, amplitude, height * std::min(share.norm(), 10.0));
  calib::set(start.model, phase, std::atan2(share[1], share[0]));
  refit_linearly(moved, effect, start);
  if (std::isfinite(start.squares)) into.push_back(start);
}

std::vector<ScreenedStart> StartScreen::at(const Effect& effect, const std::vector<double>& values) const {
  ScreenedStart start{current_.model, 0.0};
  for (std::size_t p = 0; p < values.size(); ++p) calib::set(start.model, effect.parameters[p], values[p]);
  const fitting::Residuals there = fit_.residuals(start.model);
  if (there.empty()) return {};
  refit_linearly(there, effect, start);
  if (!std::isfinite(start.squares)) return {};
  return {start};
}

/// Start values of a wave over the joint's angle. With many runs only those that are best on a few of them: there are
/// about a hundred orders, and each costs two rollouts of every run.
std::vector<std::vector<double>> StartScreen::promising_waves(const Effect& effect, const BenchScale& scale) const {
  if (fit_.runs().size() <= 2 * kRunsForOrders) return starts(effect, current_.model, scale);
  const NestedFit few(calib::spread(fit_.runs(), kRunsForOrders), fit_.threads());
  std::vector<std::vector<double>> found;
  for (const ScreenedStart& start : StartScreen(few, current_).best(effect, scale)) {
    std::vector<double> values;
    for (const std::string& parameter : effect.parameters) values.push_back(calib::value(start.model, parameter));
    found.push_back(std::move(values));
  }
  return found;
}

std::vector<ScreenedStart> StartScreen::best(const Effect& effect, const BenchScale& scale) const {
  std::vector<ScreenedStart> found;
  const bool waves = effect.name == "cogging";
  for (const std::vector<double>& values :
       waves ? promising_waves(effect, scale) : starts(effect, current_.model, scale)) {
    if (waves) {
      calib::JointModel flat = current_.model;
      flat.actuator.ripple.order = values[1];
      screen_wave(effect, "ripple.amplitude_Nm", "ripple.phase_rad", values[0], flat, found);
    } else if (effect.name == "eccentricity") {
      screen_wave(effect, "sensor.eccentricity_rad", "sensor.eccentricity_phase_rad", values[0], current_.model, found);
    } else {
      screen(effect, values, found);
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const ScreenedStart& a, const ScreenedStart& b) { return a.squares < b.squares; });
  found.resize(std::min(found.size(), kMostStarts));
  return found;
}

}  // namespace pmg::effects
