#include "effects/start_screen.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "calib/joint_runs.hpp"
#include "calib/unknown.hpp"
#include "effects/period.hpp"
#include "effects/strengths.hpp"
#include "effects/zero_slip.hpp"
#include "fitting/covariance.hpp"

namespace pmg::effects {

namespace {

constexpr std::size_t kMostStarts = 4;
constexpr double kDamping = 1e-3;
constexpr double kMayBeWorth = 1.0 / 3.0;   // of a form's worth: a start that is off may explain so little
constexpr std::size_t kRunsForOrders = 5;   // a hundred orders of a wave are screened on so many runs first
constexpr std::size_t kRunsForAThird = 16;  // with more, a third start costs more than it finds

bool better(const ScreenedStart& a, const ScreenedStart& b) { return a.squares < b.squares; }

/// The parameters of a wave over the joint's angle: its amplitude stands right before its order and phase.
struct Wave {
  std::string amplitude, phase;
};

std::vector<Wave> waves_of(const Form& form) {
  std::vector<Wave> found;
  for (std::size_t p = 1; p < form.parameters.size(); ++p) {
    if (calib::quantity(form.parameters[p]) != model::Quantity::kPhase) continue;
    const std::size_t amplitude = p - (is_order(form.parameters[p - 1]) ? 2 : 1);
    found.push_back({form.parameters[amplitude], form.parameters[p]});
  }
  return found;
}

bool has_order(const Form& form) { return std::any_of(form.parameters.begin(), form.parameters.end(), is_order); }

double dot(const fitting::Residuals& a, const fitting::Residuals& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

}  // namespace

StartScreen::StartScreen(const NestedFit& fit, NestedModel current)
    : fit_(fit),
      current_(std::move(current)),
      residuals_(fit.residuals(current_.model)),
      jacobian_(fit.jacobian(current_, residuals_)),
      information_(fitting::products(jacobian_.of_run, jacobian_.of_run)),
      gradient_(fitting::products(jacobian_.of_run, residuals_)) {}

/// The current model in this form, with these values of its parameters.
calib::JointModel StartScreen::with(const Form& form, const std::vector<double>& values) const {
  calib::JointModel model = current_.model;
  for (const FixedValue& fixed : form.fixed) calib::set(model, fixed.parameter, fixed.value);
  for (std::size_t p = 0; p < values.size(); ++p) calib::set(model, form.parameters[p], values[p]);
  return model;
}

/// One bounded Gauss-Newton step d of the unknowns that the form does not set; expected squares
/// r^T r + 2 g^T d + d^T A d, with g = J^T r and A = J^T J of the current model's Jacobian.
void StartScreen::refit_linearly(const fitting::Residuals& residuals, const Form& form, ScreenedStart& start) const {
  start.squares = fitting::sum_of_squares(residuals);
  if (!std::isfinite(start.squares) || current_.coordinates.size() == 0) return;
  const Eigen::VectorXd gradient = fitting::products(jacobian_.of_run, residuals);
  const Eigen::VectorXd step =
      fitting::bounded_step(information_, gradient, current_.ranges, current_.coordinates, kDamping);
  start.squares = std::max(0.0, start.squares + 2.0 * gradient.dot(step) + step.dot(information_ * step));
  for (Eigen::Index i = 0; i < step.size(); ++i) {
    const calib::Unknown& u = current_.unknowns[static_cast<std::size_t>(i)];
    if (contains(form.parameters, u.name)) continue;
    calib::set(start.model, u.name, u.value(current_.coordinates[i] + step[i]));
  }
}

/// A start whose residuals are these, as expected or rolled out.
void StartScreen::add(const calib::JointModel& model, const fitting::Residuals& residuals, const Form& form,
                      std::vector<ScreenedStart>& into) const {
  ScreenedStart start{model, 0.0};
  refit_linearly(residuals, form, start);
  if (std::isfinite(start.squares)) into.push_back(start);
}

void StartScreen::screen(const Effect& effect, const Form& form, const std::vector<double>& values,
                         std::vector<ScreenedStart>& into) const {
  const calib::JointModel model = with(form, values);
  const fitting::Residuals there = fit_.residuals(model);
  if (there.empty()) return;
  add(model, there, form, into);
  scale_strengths(effect, form, values, there, into);
}

/// The start with its strengths scaled: the share s of 0..3 that is best on the linear model r0 + s (r - r0), with r0
/// from the model without the effect, while the other unknowns follow. For forms that are linear in what is scaled: of
/// one strength, loads and constant torques. The strengths must be finite without the effect.
void StartScreen::scale_strengths(const Effect& effect, const Form& form, const std::vector<double>& values,
                                  const fitting::Residuals& there, std::vector<ScreenedStart>& into) const {
  constexpr double kLeast = 0.02, kMost = 3.0;
  const std::vector<std::string> scaled = strengths(effect, form);
  if (scaled.size() != 1 && effect.name != "load" && effect.name != "offset") return;
  fitting::Residuals direction = there;
  for (std::size_t i = 0; i < there.size(); ++i) direction[i] -= residuals_[i];
  const Eigen::Index others = current_.coordinates.size();
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(others + 1, others + 1);
  Eigen::VectorXd gradient(others + 1), from = Eigen::VectorXd::Zero(others + 1);
  information(others, others) = dot(direction, direction);
  gradient[others] = dot(direction, residuals_);
  if (!(information(others, others) > 0.0)) return;
  fitting::Coordinates ranges = current_.ranges;
  ranges.push_back({.lower = 0.0, .upper = kMost});
  if (others > 0) {
    information.topLeftCorner(others, others) = information_;
    information.col(others).head(others) = fitting::products(jacobian_.of_run, direction);
    information.row(others).head(others) = information.col(others).head(others).transpose();
    gradient.head(others) = gradient_;
    from.head(others) = current_.coordinates;
  }
  const double share = fitting::bounded_step(information, gradient, ranges, from, kDamping)[others];
  if (share < kLeast) return;
  std::vector<double> scaled_values = values;
  for (std::size_t p = 0; p < values.size(); ++p) {
    if (!contains(scaled, form.parameters[p])) continue;
    const double none = calib::value(current_.model, form.parameters[p]);
    if (!std::isfinite(none)) return;
    scaled_values[p] = none + share * (values[p] - none);
  }
  fitting::Residuals moved = residuals_;
  for (std::size_t i = 0; i < there.size(); ++i) moved[i] += share * direction[i];
  add(with(form, scaled_values), moved, form, into);
}

/// The response to small waves over the joint's angle is linear in their sine and cosine parts: two rollouts for each
/// wave give the least-squares amplitudes and phases.
void StartScreen::screen_waves(const Form& form, const std::vector<double>& values,
                               std::vector<ScreenedStart>& into) const {
  const calib::JointModel flat = with(form, values);
  const std::vector<Wave> waves = waves_of(form);
  std::vector<fitting::Residuals> parts;
  for (const Wave& wave : waves) {
    for (const double phase : {0.0, 0.5 * std::numbers::pi}) {
      calib::JointModel model = flat;
      for (const Wave& other : waves) {
        if (other.amplitude != wave.amplitude) calib::set(model, other.amplitude, 0.0);
      }
      calib::set(model, wave.phase, phase);
      parts.push_back(fit_.residuals(model));
      if (parts.back().empty()) return;
      for (std::size_t i = 0; i < residuals_.size(); ++i) parts.back()[i] -= residuals_[i];
    }
  }
  const auto count = static_cast<Eigen::Index>(parts.size());
  Eigen::MatrixXd a(count, count);
  Eigen::VectorXd b(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    b[i] = -dot(parts[static_cast<std::size_t>(i)], residuals_);
    for (Eigen::Index j = 0; j < count; ++j)
      a(i, j) = dot(parts[static_cast<std::size_t>(i)], parts[static_cast<std::size_t>(j)]);
  }
  if (!(a.diagonal().minCoeff() > 0.0)) return;
  const Eigen::VectorXd scale = a.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * a * scale.asDiagonal();
  if (!(scaled.determinant() > 1e-9)) return;  // waves that do the same
  const Eigen::VectorXd share = scale.cwiseProduct(scaled.ldlt().solve(scale.cwiseProduct(b)));
  fitting::Residuals moved = residuals_;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += share[static_cast<Eigen::Index>(p)] * parts[p][i];
  }
  calib::JointModel best = flat;
  for (std::size_t w = 0; w < waves.size(); ++w) {
    const Eigen::Vector2d own = share.segment<2>(2 * static_cast<Eigen::Index>(w));
    calib::set(best, waves[w].amplitude, calib::value(flat, waves[w].amplitude) * std::min(own.norm(), 10.0));
    calib::set(best, waves[w].phase, std::atan2(own[1], own[0]));
  }
  add(best, moved, form, into);
}

/// A zero before each place, and another one after it: on both sides the response to an offset is linear. One rollout
/// shows all places.
void StartScreen::screen_slips(const Form& form, const std::vector<double>& values,
                               std::vector<ScreenedStart>& into) const {
  constexpr double kMost = 10.0;  // of the offset that is rolled out
  const std::vector<calib::SingleJoint>& runs = fit_.runs();
  const double zero_rad = calib::value(current_.model, form.parameters[1]);
  fitting::Residuals there = fit_.residuals(with(form, {values[0], zero_rad, values[2]}));
  if (there.empty()) return;
  for (std::size_t r = 0; r < there.size(); ++r) there[r] -= residuals_[r];
  for (const double place : slip_places(runs)) {
    const auto is_after = [&](std::size_t r) { return runs[r].run().place < place ? 0U : 1U; };
    double along[2] = {}, across[2] = {};  // before and after
    for (std::size_t r = 0; r < there.size(); ++r) {
      along[is_after(r)] -= there[r].dot(residuals_[r]);
      across[is_after(r)] += there[r].squaredNorm();
    }
    if (!(across[0] > 0.0 && across[1] > 0.0)) continue;
    const double share[2] = {std::clamp(along[0] / across[0], -kMost, kMost),
                             std::clamp(along[1] / across[1], -kMost, kMost)};
    fitting::Residuals moved = residuals_;
    for (std::size_t r = 0; r < there.size(); ++r) moved[r] += share[is_after(r)] * there[r];
    add(with(form, {(share[1] - share[0]) * values[0], zero_rad + share[0] * values[0], place}), moved, form, into);
  }
}

/// Rollouts with a period that is off by a percent soon are out of step with the recording. So between the first and
/// the last of the grid's periods those that stay in step are screened too.
void StartScreen::screen_periods(const Effect& effect, const Form& form, const std::vector<std::vector<double>>& grid,
                                 std::vector<ScreenedStart>& into) const {
  if (grid.size() < 2) return;
  for (const double period_s :
       promising_periods_s(fit_, current_.model, form.parameters.front(), grid.front().front(), grid.back().front()))
    screen(effect, form, {period_s}, into);
}

std::vector<ScreenedStart> StartScreen::at(const Effect& effect, std::size_t form,
                                           const std::vector<double>& values) const {
  const calib::JointModel model = with(effect.forms.at(form), values);
  const fitting::Residuals there = fit_.residuals(model);
  std::vector<ScreenedStart> found;
  if (!there.empty()) add(model, there, effect.forms.at(form), found);
  for (ScreenedStart& start : found) start.form = form;
  return found;
}

struct StartScreen::OfFewRuns {
  OfFewRuns(const StartScreen& all, std::size_t count)
      : fit(calib::spread(all.fit_.runs(), count), all.fit_.threads()), screen(fit, all.current_) {}
  NestedFit fit;
  StartScreen screen;
};

std::vector<double> values_of(const Form& form, const calib::JointModel& model) {
  std::vector<double> values;
  for (const std::string& parameter : form.parameters) values.push_back(calib::value(model, parameter));
  return values;
}

/// Start values of a wave of some order. With many runs only those that are best on a few of them: there are about a
/// hundred orders, and each costs two rollouts of every run.
std::vector<std::vector<double>> StartScreen::promising_waves(const Effect& effect, std::size_t form_index,
                                                              const BenchScale& scale) const {
  const Form& form = effect.forms.at(form_index);
  if (fit_.runs().size() <= kRunsForOrders) return form.starts_at(current_.model, scale);
  if (for_orders_ == nullptr) for_orders_ = std::make_shared<OfFewRuns>(*this, kRunsForOrders);
  std::vector<std::vector<double>> found;
  for (const ScreenedStart& start : for_orders_->screen.best(effect, form_index, scale))
    found.push_back(values_of(form, start.model));
  return found;
}

std::vector<ScreenedStart> StartScreen::best(const Effect& effect, std::size_t form_index,
                                             const BenchScale& scale) const {
  std::vector<ScreenedStart> found;
  const Form& form = effect.forms.at(form_index);
  const bool waves = !waves_of(form).empty();
  const std::vector<std::vector<double>> grid =
      has_order(form) ? promising_waves(effect, form_index, scale) : form.starts_at(current_.model, scale);
  for (const std::vector<double>& values : grid) {
    if (waves)
      screen_waves(form, values, found);
    else if (is_place(form.parameters.back()))
      screen_slips(form, values, found);
    else
      screen(effect, form, values, found);
  }
  if (is_period(form.parameters.front())) screen_periods(effect, form, grid, found);
  for (ScreenedStart& start : found) start.form = form_index;
  std::stable_sort(found.begin(), found.end(), better);
  found.resize(std::min(found.size(), kMostStarts));
  return found;
}

std::vector<ScreenedStart> StartScreen::best_of_forms(const Effect& effect, const BenchScale& scale,
                                                      double worth) const {
  std::vector<ScreenedStart> all;
  for (std::size_t form = 0; form < effect.forms.size(); ++form) {
    const std::vector<ScreenedStart> of_form = best(effect, form, scale);
    all.insert(all.end(), of_form.begin(), of_form.end());
  }
  std::stable_sort(all.begin(), all.end(), better);
  if (all.size() < 3) return all;
  const double now = fitting::sum_of_squares(residuals_);
  const auto other =
      std::find_if(all.begin(), all.end(), [&](const ScreenedStart& s) { return s.form != all[0].form; });
  const auto other_explains = [&](double share) {
    return other != all.end() && now - other->squares > share * (now - all[0].squares);
  };
  if (other_explains(worth)) return {all[0], *other};
  if (fit_.runs().size() <= kRunsForAThird && other_explains(kMayBeWorth * worth)) return {all[0], all[1], *other};
  return {all[0], all[1]};
}

}  // namespace pmg::effects
