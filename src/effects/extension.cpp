#include "effects/extension.hpp"

#include <algorithm>

#include "calib/unknown.hpp"
#include "effects/period.hpp"
#include "effects/zero_slip.hpp"

namespace pmg::effects {

namespace {

bool has(const Form& form, const std::string& parameter) {
  return contains(form.parameters, parameter) ||
         std::any_of(form.fixed.begin(), form.fixed.end(),
                     [&](const FixedValue& fixed) { return fixed.parameter == parameter; });
}

}  // namespace

const Form& form_of(const std::string& effect_name, const Forms& forms) {
  const auto found = forms.find(effect_name);
  return effect(effect_name).forms.at(found == forms.end() ? 0 : found->second);
}

bool is_late(const Form& form) {
  return std::any_of(form.parameters.begin(), form.parameters.end(), [](const std::string& name) {
    const model::Quantity quantity = calib::quantity(name);
    return quantity == model::Quantity::kDelay || quantity == model::Quantity::kPeriod ||
           quantity == model::Quantity::kLag;
  });
}

bool is_nested(const std::string& effect, const Forms& its_forms, const std::string& in, const Forms& forms) {
  const std::vector<std::string>&numbers = form_of(effect, its_forms).parameters, &more = form_of(in, forms).parameters;
  return numbers.size() < more.size() &&
         std::ranges::all_of(numbers, [&](const std::string& number) { return contains(more, number); });
}

std::size_t Extension::numbers() const {
  std::size_t count = fitted.unknowns.size();
  for (const std::string& name : effects) {
    const std::vector<std::string>& parameters = form_of(name, forms).parameters;
    count += static_cast<std::size_t>(std::count_if(parameters.begin(), parameters.end(), is_jagged));
  }
  return count;
}

calib::Unknowns ExtensionFits::unknowns(const std::vector<std::string>& effects, const Forms& forms) const {
  calib::Unknowns found = base_.unknowns;
  for (const std::string& name : effects) {
    for (const std::string& parameter : form_of(name, forms).parameters) {
      if (!is_jagged(parameter)) calib::put(found, unknown(parameter, bench_, base_.scale));
    }
  }
  return found;
}

calib::JointModel ExtensionFits::without(calib::JointModel model, const std::string& effect_name,
                                         const std::vector<std::string>& kept, const Forms& forms) const {
  const auto reset = [&](const std::string& parameter) {
    const bool shared = std::any_of(kept.begin(), kept.end(),
                                    [&](const std::string& name) { return has(form_of(name, forms), parameter); });
    if (!shared) calib::set(model, parameter, calib::value(base_.model, parameter));
  };
  for (const Form& form : effect(effect_name).forms) {
    for (const std::string& parameter : form.parameters) reset(parameter);
    for (const FixedValue& fixed : form.fixed) reset(fixed.parameter);
  }
  return model;
}

Extension ExtensionFits::fitted(const std::vector<std::string>& effects, const Forms& forms,
                                const calib::JointModel& start, int most_iterations) const {
  const calib::Unknowns free = unknowns(effects, forms);
  Extension extension{effects, fit_.fit(start, free, most_iterations), {}, forms, {}};
  for (const std::string& name : effects) {
    for (const std::string& parameter : form_of(name, forms).parameters) {
      if (!is_period(parameter) && !is_place(parameter)) continue;
      calib::JointModel better = extension.fitted.model;
      const double best = is_place(parameter) ? best_slip_place(fit_, better) : best_period_s(fit_, better, parameter);
      if (best == calib::value(better, parameter)) continue;
      calib::set(better, parameter, best);
      extension.fitted = fit_.fit(better, free, most_iterations);
    }
  }
  if (extension.fitted.blocks.empty()) fit_.linearise(extension.fitted);
  extension.held_out = fit_.held_out_squares(extension.fitted, compare_.folds());
  return extension;
}

}  // namespace pmg::effects
