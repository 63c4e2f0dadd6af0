#include "effects/form_choice.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>

#include "calib/unknown.hpp"
#include "effects/period.hpp"
#include "effects/strengths.hpp"
#include "effects/unknowns.hpp"

namespace pmg::effects {

namespace {

Eigen::VectorXd fitted_squares(const Extension& extension) {
  Eigen::VectorXd squares(static_cast<Eigen::Index>(extension.fitted.blocks.size()));
  for (Eigen::Index b = 0; b < squares.size(); ++b)
    squares[b] = extension.fitted.blocks[static_cast<std::size_t>(b)].squares;
  return squares;
}

/// (parameter, value, factor) => (its value where the effect is so many times as large).
double in_size(const std::string& parameter, double value, double factor) {
  const double neutral = calib::value(calib::JointModel{}, parameter);
  return std::isfinite(neutral) ? neutral + factor * (value - neutral) : value / factor;
}

/// (form, a start) => (the same in other sizes, where the form has several strengths). Two thresholds make rollouts
/// jump: no slope tells how large they are.
std::vector<ScreenedStart> in_other_sizes(const StartScreen& screen, const Effect& family, std::size_t form,
                                          const ScreenedStart& start) {
  std::vector<ScreenedStart> found;
  const std::vector<std::string>& parameters = family.forms[form].parameters;
  const std::vector<std::string> sizes = strengths(family, family.forms[form]);
  if (sizes.size() < 2) return found;
  const std::vector<double> begun = values_of(family.forms[form], start.model);
  for (const double factor : {0.35, 0.5, 0.7, 0.84, 1.19, 1.41, 1.68, 2.0, 2.8}) {
    std::vector<double> values = begun;
    for (std::size_t p = 0; p < values.size(); ++p)
      if (contains(sizes, parameters[p])) values[p] = in_size(parameters[p], values[p], factor);
    std::ranges::move(screen.at(family, form, values), std::back_inserter(found));
  }
  return found;
}

/// The best starts of the form, in other sizes too, and where all its parameters are those of the present form, their
/// present values.
std::vector<ScreenedStart> starts_of(const StartScreen& screen, const Effect& family, std::size_t form,
                                     const Extension& current, const BenchScale& scale) {
  std::vector<ScreenedStart> found = screen.best(family, form, scale);
  if (found.empty()) return found;
  for (const ScreenedStart& start : in_other_sizes(screen, family, form, found.front())) {
    if (start.squares < found.front().squares) found.front() = start;
  }
  const std::vector<std::string>& parameters = family.forms[form].parameters;
  if (parameters != form_of(family.name, current.forms).parameters) return found;
  for (const ScreenedStart& start : screen.at(family, form, values_of(family.forms[form], current.fitted.model))) {
    found.insert(start.squares < found.front().squares ? found.begin() : found.end(), start);
  }
  return found;
}

/// True if the form's fit may have ended beside its best, for lack of the effects that came later: rollouts get in and
/// out of step with a period or an order, and a time constant may be another effect's.
bool has_several_minima(const Form& form, const Extension& current) {
  return current.effects.size() > 1 && std::ranges::any_of(form.parameters, [](const std::string& name) {
           return is_period(name) || is_order(name) || calib::quantity(name) == model::Quantity::kTimeConstant;
         });
}

/// The extension with the effect in another form; nothing where these recordings can't have it, or where it is far from
/// explaining as much.
std::optional<Extension> in_form(const ExtensionFits& fits, const StartScreen& screen, const Extension& current,
                                 const Effect& family, std::size_t form, const FormLimits& limits) {
  const std::vector<ScreenedStart> starts = starts_of(screen, family, form, current, fits.base().scale);
  if (starts.empty()) return std::nullopt;
  Forms forms = current.forms;
  forms[family.name] = form;
  const NestedModel first = fits.fit().fit(starts.front().model, fits.unknowns(current.effects, forms),
                                           limits.first_iterations, &screen.jacobian());
  const Eigen::VectorXd squares = fits.fit().blocks().squares(fits.fit().residuals(first.model));
  if (fits.compare()(squares, fitted_squares(current)).deviations > limits.hopeless_deviations) return std::nullopt;
  Extension found = fits.fitted(current.effects, forms, first.model, limits.most_iterations);
  if (fades_unseen(family.name, forms, found.fitted.model, fits.base().scale.speed_rad_s)) return std::nullopt;
  return found;
}

/// The extension with the effect in its present form, from its best start beside the numbers that the other effects
/// have by now.
std::optional<Extension> again(const ExtensionFits& fits, const Extension& current, const Effect& family,
                               std::size_t form, const FormLimits& limits) {
  std::vector<std::string> others = current.effects;
  std::erase(others, family.name);
  const calib::JointModel rest = fits.without(current.fitted.model, family.name, others, current.forms);
  const StartScreen screen(fits.fit(), fits.fit().fit(rest, fits.unknowns(others, current.forms), 0));
  return in_form(fits, screen, current, family, form, limits);
}

}  // namespace

bool told_apart(const SeenSeparation& seen, const ApartLimits& limits) {
  return seen.blocks >= limits.blocks && seen.deviations >= limits.deviations &&
         seen.share_of_expected >= limits.share_of_expected;
}

Extension in_best_form(const ExtensionFits& fits, const Extension& current, const StartScreen& without,
                       const std::string& effect_name, const FormLimits& limits) {
  const Effect& family = effect(effect_name);
  if (family.forms.size() < 2) return current;
  const auto taken = current.forms.find(effect_name);
  const std::size_t present = taken == current.forms.end() ? 0 : taken->second;
  std::map<std::size_t, Extension> tried = {{present, current}};
  for (std::size_t form = 0; form < family.forms.size(); ++form) {
    if (form == present && !has_several_minima(family.forms[form], current)) continue;
    std::optional<Extension> other = form == present ? again(fits, current, family, form, limits)
                                                     : in_form(fits, without, current, family, form, limits);
    if (!other || (form == present && !(other->fitted.squares < current.fitted.squares))) continue;
    tried.insert_or_assign(form, *std::move(other));
  }
  const auto level = [&](const auto& one) { return fits.compare().mean_log_square(one.second.held_out.mean()); };
  const auto best =
      std::min_element(tried.begin(), tried.end(), [&](const auto& a, const auto& b) { return level(a) < level(b); });
  const auto chosen = std::find_if(tried.begin(), tried.end(), [&](const auto& one) {
    return one.first == best->first ||
           fits.compare()(one.second.held_out, best->second.held_out).deviations < limits.better_deviations;
  });
  Extension found = chosen->second;
  found.open_forms = current.open_forms;
  std::vector<OpenForm>& open = found.open_forms[effect_name];
  open.clear();
  for (const auto& [form, other] : tried) {
    if (form == chosen->first || is_nested(effect_name, found.forms, effect_name, other.forms)) continue;
    const SeenSeparation seen =
        seen_separation(fits.fit(), found.fitted.model, other.fitted.model, found.held_out.mean(),
                        other.held_out.mean(), limits.apart.noise_squares, limits.apart.visible_share);
    if (told_apart(seen, limits.apart)) continue;
    open.push_back({family.forms[form].name, {}});
    for (const std::string& parameter : family.forms[form].parameters)
      open.back().values[parameter] = calib::value(other.fitted.model, parameter);
  }
  return found;
}

}  // namespace pmg::effects
