// The quick model with an effect that its fit cannot reach from nothing.
#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/joint_runs.hpp"
#include "data_faults/quick_model.hpp"
#include "effects/catalogue.hpp"

namespace pmg::data_faults {

/// The errors of a fit's model.
QuickFit QuickModel::at(const std::vector<calib::SingleJoint>& runs, QuickFit fit) const {
  fit.factors.clear();
  fit.log_error = log_errors(runs, fit.model);
  fit.loss = 0.0;
  for (const double log : fit.log_error) fit.loss += log / static_cast<double>(runs.size());
  return fit;
}

/// A rate limit has no effect where it is infinite, so that no step leads to it: it is tried at a few values.
QuickFit QuickModel::with_rate_limit(const std::vector<calib::SingleJoint>& runs, const QuickFit& fit) const {
  constexpr double kWorth = 0.1;  // a tenth of the error
  const effects::BenchScale scale = effects::scale_of(*bench_, runs, fit.model);
  QuickFit best = fit;
  for (const double share : {0.3, 0.5, 0.7, 0.85, 1.0, 1.3}) {
    QuickFit tried = fit;
    tried.model.actuator.command.rate_limit_rad_s = share * scale.speed_rad_s;
    tried.extra = {"command.rate_limit_rad_s"};
    tried = at(runs, tried);
    if (tried.loss < best.loss) best = tried;
  }
  return best.loss < fit.loss - kWorth ? refit(runs, best, {}) : fit;
}

QuickFit QuickModel::with_best_effect(const std::vector<calib::SingleJoint>& runs, const QuickFit& fit) const {
  constexpr std::size_t kRefitted = 3, kStarts = 6, kRuns = 8;
  const std::vector<calib::SingleJoint> few = calib::spread(runs, kRuns);
  const effects::BenchScale scale = effects::scale_of(*bench_, runs, fit.model);
  std::vector<QuickFit> tried;
  for (const effects::Effect& effect : effects::catalogue()) {
    const effects::Form& form = effect.forms.front();
    QuickFit best = fit;
    best.loss = std::numeric_limits<double>::infinity();
    const std::vector<std::vector<double>> starts = form.starts_at(fit.model, scale);
    const std::size_t stride = std::max<std::size_t>(1, starts.size() / kStarts);
    for (std::size_t s = 0; s < starts.size(); s += stride) {
      const std::vector<double>& values = starts[s];
      QuickFit one = fit;
      for (std::size_t i = 0; i < values.size(); ++i) {
        const std::string& name = form.parameters[i];
        calib::set(one.model, name, values[i]);
        if (!effects::is_jagged(name)) one.extra.push_back(name);
      }
      one = at(few, one);
      if (one.loss < best.loss) best = one;
    }
    if (std::isfinite(best.loss)) tried.push_back(best);
  }
  std::sort(tried.begin(), tried.end(), [](const QuickFit& a, const QuickFit& b) { return a.loss < b.loss; });
  tried.resize(std::min(kRefitted, tried.size()));
  QuickFit best = fit;
  for (const QuickFit& one : tried) {
    const QuickFit refitted = refit(runs, one, {}, 4);
    if (refitted.loss < best.loss) best = refitted;
  }
  return best;
}

}  // namespace pmg::data_faults
