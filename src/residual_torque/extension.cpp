#include "residual_torque/extension.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "effects/folds.hpp"
#include "residual_torque/rest_start.hpp"

namespace pmg::residual_torque {

namespace {

std::string objection(const LeftOutGain& gain, const Options& options) {
  if (!(gain.error_rad > 0.0)) return "recordings left out are predicted no better with it";
  if (gain.deviations < options.least_deviations)
    return fmt::format("its gain on recordings left out is only {:.1f} of its deviations", gain.deviations);
  if (gain.folds_won < options.least_folds_won)
    return fmt::format("recordings left out are better in only {:.0f} % of the folds", 100.0 * gain.folds_won);
  return "";
}

/// The best of each choice of quantities: other widths, lags or smoothness of the same ones are hardly another try.
std::vector<TorqueFit> worth_fitting(std::vector<TorqueFit> fits, const Options& options) {
  const double least = fits.empty() ? 0.0 : std::max(0.0, options.worth_fitting * fits.front().gain);
  std::vector<TorqueFit> found;
  for (TorqueFit& fit : fits) {
    if (std::ssize(found) >= static_cast<std::ptrdiff_t>(options.fitted_candidates)) break;
    const auto same = [&](const TorqueFit& other) { return text(other.candidate.term) == text(fit.candidate.term); };
    if (!(fit.gain > 0.0 && fit.gain >= least) || std::ranges::any_of(found, same)) continue;
    found.push_back(std::move(fit));
  }
  return found;
}

struct Tried {
  TorqueFit start;
  RolloutFit fitted;
  LeftOutGain gain;
};

}  // namespace

Extension extend(const Unexplained& from, const Options& options, const work::Progress& progress) {
  Extension extension;
  extension.model = from.model.model;
  extension.why_not = "no curve over a quantity of the joint predicts the torque that is missing";
  if (!progress(work::kUnknownShare, "looking for what the remaining torque depends on")) return extension;
  const std::vector<fitting::Fold> folds = effects::folds(from.fit);
  const double bound_Nm = options.bound_of_peak * from.scale.torque_peak_Nm;
  const auto iterations = static_cast<int>(options.iterations);
  const MissingTorque missing = missing_torque(from.bench, from.fit, from.model.model, from.scale);
  std::optional<Tried> best;
  std::vector<TorqueFit> starts = worth_fitting(torque_fits(missing, folds, from.scale.torque_Nm, options), options);
  if (auto rests = rest_start(missing, from.fit, from.model.model, from.scale.torque_Nm, bound_Nm))
    starts.push_back(*std::move(rests));
  for (TorqueFit& start : starts) {
    if (!progress(work::kUnknownShare, "fitting a " + text(start.candidate.term))) break;
    std::optional<RolloutFit> fitted = rollout_fit(from.fit, from.model, start, bound_Nm, iterations);
    if (!fitted) continue;
    const LeftOutGain gain =
        left_out_gain(from.fit.blocks(), folds, from.held_out, held_out_squares(from.fit, *fitted, folds));
    if (best && gain.error_rad <= best->gain.error_rad) continue;
    best = Tried{std::move(start), std::move(*fitted), gain};
  }
  if (!best) return extension;
  extension.gain = best->gain;
  extension.term = best->fitted.model().actuator.residual_torque.terms[0];
  extension.why_not = objection(best->gain, options);
  extension.kept = extension.why_not.empty();
  if (!extension.kept) return extension;
  if (from.all.runs().size() > from.fit.runs().size()) {
    TorqueFit start = best->start;
    start.amplitudes = best->fitted.coordinates.tail(start.amplitudes.size());
    effects::NestedModel without = from.model;
    without.coordinates = best->fitted.coordinates.head(without.coordinates.size());
    if (auto fitted = rollout_fit(from.all, without, start, bound_Nm, iterations)) best->fitted = std::move(*fitted);
  }
  extension.model = best->fitted.model();
  extension.term = extension.model.actuator.residual_torque.terms[0];
  return extension;
}

}  // namespace pmg::residual_torque
