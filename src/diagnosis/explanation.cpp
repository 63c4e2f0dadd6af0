#include "diagnosis/explanation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "calib/unknown.hpp"
#include "effects/catalogue.hpp"
#include "effects/folds.hpp"
#include "effects/form_choice.hpp"
#include "effects/intervals.hpp"
#include "effects/period.hpp"
#include "effects/separation.hpp"
#include "effects/strengths.hpp"
#include "effects/zero_slip.hpp"

namespace pmg::diagnosis {

namespace {

/// What keeps a rival open, in words.
std::string in_its_place(const std::string& other, const effects::SeenSeparation& apart,
                         const effects::ApartLimits& enough) {
  if (apart.blocks == 0) return fmt::format("with {} in its place the simulation moves alike in all recordings", other);
  const std::string fits = fmt::format(
      "{} in its place fits {} by {:.1f} standard deviations in the {} half-seconds in which the two differ", other,
      apart.deviations < 0.0 ? "better" : "worse", std::abs(apart.deviations), apart.blocks);
  if (apart.deviations < enough.deviations) return fmt::format("{}; {:.0f} would tell", fits, enough.deviations);
  if (apart.blocks < enough.blocks) return fmt::format("{}; {} half-seconds would tell", fits, enough.blocks);
  return fmt::format("{}, but by less than {:.0f} % of what it should", fits, 100.0 * enough.share_of_expected);
}

class Explaining {
 public:
  Explaining(EffectSearch& search, const Extension& chosen, const ExplainedFrom& from)
      : search_(search),
        chosen_(chosen),
        from_(from),
        noise_squares_(std::pow(from.noise.rms_rad, 2)),
        intervals_(effects::reaching(
            from.searched, from.fitted,
            effects::told(parameter_intervals(from.fitted, folds(from.all), noise_squares_, from.options.intervals),
                          from.fitted, from.options.intervals),
            search.fitted_parameters(chosen), from.options.intervals)) {}

  Explanation run() {
    std::vector<std::pair<double, Cause>> causes;
    for (const std::string& name : chosen_.effects) {
      const Extension& rest = search_.refit_without(chosen_, name);
      const fitting::Comparison gain = search_.compared(rest, chosen_);
      causes.emplace_back(gain.log_gain, cause(name, rest, gain));
    }
    std::stable_sort(causes.begin(), causes.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    for (auto& [gain, one] : causes) found_.causes.push_back(std::move(one));
    reject();
    return std::move(found_);
  }

 private:
  Cause cause(const std::string& name, const Extension& rest, const fitting::Comparison& gain) {
    const MeasuredCause* measured = search_.measured(name);
    Cause cause;
    cause.effect = name;
    const effects::Form& form = effects::form_of(name, chosen_.forms);
    cause.form = form.name;
    for (const std::string& parameter : form.parameters) {
      cause.parameters.push_back(measured != nullptr && measured->parameter == parameter
                                     ? evidence::ParameterEstimate{parameter, measured->value, from_.unit}
                                     : estimate(parameter));
    }
    if (const auto open = chosen_.open_forms.find(name); open != chosen_.open_forms.end()) {
      for (const effects::OpenForm& other : open->second) add_form(cause, other);
    }
    cause.held_out_error_before = judged_error(rest.fitted.model);
    cause.held_out_error_after = from_.error_after;
    if (measured == nullptr) {
      cause.evidence.push_back(
          fmt::format("runs left out are predicted better in {:.0f} % of the folds over gain, load and trajectory; the "
                      "gain is {:.0f} of its deviations",
                      100.0 * gain.folds_won, gain.deviations));
    }
    add_place(cause);
    add_checks(cause);
    if (measured == nullptr) add_rivals(cause);
    return cause;
  }

  /// An open form: its value of a parameter of the same name may be the right one, within the same interval.
  static void add_form(Cause& cause, const effects::OpenForm& other) {
    cause.form_or_instead.push_back(other.name);
    for (evidence::ParameterEstimate& p : cause.parameters) {
      const auto there = other.values.find(p.name);
      if (there == other.values.end()) continue;
      evidence::Interval& interval = p.estimate;
      const double below = interval.value - interval.low, above = interval.high - interval.value;
      interval.low = std::min(interval.low, there->second - below);
      interval.high = std::max(interval.high, there->second + above);
    }
  }

  void add_place(Cause& cause) const {
    for (const evidence::ParameterEstimate& p : cause.parameters) {
      if (!effects::is_place(p.name)) continue;
      const auto [before, after] = effects::slip_gap(from_.all.runs(), p.estimate.value);
      if (before == nullptr || after == nullptr) continue;
      cause.evidence.push_back(
          fmt::format("it slipped after {} and before {}, if runs.csv lists the recordings in their order",
                      before->file, after->file));
    }
  }

  void add_checks(Cause& cause) const {
    for (const evidence::Signature& check : from_.checks) {
      if (check.effect != cause.effect || check.agreement == evidence::Agreement::kCannotTell) continue;
      const auto conflict = evidence::size_conflict(check, from_.expected, from_.options.signatures.power);
      const bool agrees = check.agreement == evidence::Agreement::kAgrees;
      cause.evidence.push_back(
          fmt::format("without a model, {} {}: {}{}", check.check,
                      agrees && conflict ? "shows the effect, but disagrees in size" : name(check.agreement),
                      agrees && conflict ? *conflict + "; " : "", check.sentence));
    }
  }

  void add_rivals(Cause& cause) {
    Rivals rivals{{chosen_.fitted}, {cause.effect}};
    for (const Trial& other : search_.alternatives(chosen_, cause.effect)) {
      const effects::SeenSeparation apart = seen(other.extension);
      if (!is_rival(other, apart) || search_.refuted(other) || search_.is_superfluous(other, chosen_, cause.effect))
        continue;
      cause.evidence.push_back(in_its_place(other.effect, apart, search_.apart_limits()));
      cause.or_instead.push_back(other.effect);
      rivals.models.push_back(other.extension.fitted);
      rivals.names.push_back(other.effect);
    }
    if (rivals.names.size() > 1) found_.rivals.push_back(std::move(rivals));
  }

  effects::SeenSeparation seen(const Extension& other) const {
    return effects::seen_separation(from_.searched, chosen_.fitted.model, other.fitted.model, chosen_.held_out.mean(),
                                    other.held_out.mean(), noise_squares_, from_.options.visible_share);
  }

  bool is_rival(const Trial& other, const effects::SeenSeparation& apart) const {
    if (effects::at_its_limit(other.extension.fitted)) return false;
    return !effects::told_apart(apart, search_.apart_limits());
  }

  double judged_error(const calib::JointModel& model) const {
    return from_.judged.blocks().absolutes(from_.judged.residuals(model)).mean();
  }

  evidence::ParameterEstimate estimate(const std::string& parameter) const {
    for (std::size_t i = 0; i < intervals_.size(); ++i) {
      const calib::Unknown& u = from_.fitted.unknowns[i];
      if (u.name == parameter) return {parameter, intervals_[i], u.unit()};
    }
    const double value = calib::value(from_.fitted.model, parameter);
    if (effects::is_period(parameter)) {
      const auto [low_s, high_s] = effects::period_range(from_.searched, from_.fitted, parameter, noise_squares_,
                                                         from_.options.apart_deviations);
      return {parameter, {value, low_s, high_s}, "s"};
    }
    if (effects::is_place(parameter)) {
      const auto [before, after] = effects::slip_gap(from_.all.runs(), value);
      return {parameter, {value, before == nullptr ? 0.0 : before->place, after == nullptr ? 1.0 : after->place}, ""};
    }
    return {parameter, {value, value, value}, ""};
  }

  void reject() {
    std::set<std::string> listed(chosen_.effects.begin(), chosen_.effects.end());
    for (const Cause& cause : found_.causes) listed.insert(cause.or_instead.begin(), cause.or_instead.end());
    for (const auto& [effect, why] : search_.left_out()) {
      if (listed.insert(effect).second) found_.rejected.push_back({effect, why, LookedAt::kFit});
    }
    for (const effects::Effect& one : effects::catalogue()) {
      if (!listed.contains(one.name)) found_.rejected.push_back(rejected(one.name));
    }
  }

  Rejected rejected(const std::string& effect) const {
    for (const Trial& trial : search_.last_additions()) {
      if (trial.effect != effect) continue;
      // It helped, and the search took other effects, or ended before them.
      if (trial.against.empty())
        return {effect, "it helps too, but was not tried beside all of the causes", LookedAt::kLinearised};
      return {effect, trial.against, LookedAt::kFit};
    }
    if (const auto read_off = measured(effect)) return {effect, *read_off, LookedAt::kRecordings};
    if (search_.stopped()) return {effect, "the search was interrupted before it", LookedAt::kNot};
    return {effect, "not fitted in full: a quick look explains less with it than with others", LookedAt::kLinearised};
  }

  /// Why an effect that is read off the recordings is no cause; nothing for other effects, and where they don't tell.
  std::optional<std::string> measured(const std::string& effect) const {
    for (const evidence::Signature& check : from_.checks) {
      if (effect != "quantisation" || check.effect != effect) continue;
      if (check.agreement == evidence::Agreement::kDisagrees) return "the readings have no common step";
      if (check.agreement == evidence::Agreement::kAgrees)
        return "the step of the readings is small beside the noise, or the simulation has it already";
    }
    return std::nullopt;
  }

  EffectSearch& search_;
  const Extension& chosen_;
  const ExplainedFrom& from_;
  double noise_squares_;
  std::vector<evidence::Interval> intervals_;
  Explanation found_;
};

}  // namespace

const char* name(LookedAt looked_at) {
  switch (looked_at) {
    case LookedAt::kFit:
      return "fit";
    case LookedAt::kRecordings:
      return "recordings";
    case LookedAt::kLinearised:
      return "linearised";
    case LookedAt::kNot:
      break;
  }
  return "no";
}

Explanation explain(EffectSearch& search, const Extension& chosen, const ExplainedFrom& from) {
  return Explaining(search, chosen, from).run();
}

}  // namespace pmg::diagnosis
