#include "diagnosis/diagnose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "calib/fit_results.hpp"
#include "calib/joint_floor.hpp"
#include "calib/joint_runs.hpp"
#include "diagnosis/assemblies.hpp"
#include "diagnosis/effect_search.hpp"
#include "diagnosis/explanation.hpp"
#include "diagnosis/next_excitation.hpp"
#include "diagnosis/residual.hpp"
#include "effects/integration_part.hpp"
#include "effects/intervals.hpp"
#include "evidence/signature.hpp"

namespace pmg::diagnosis {

namespace {

constexpr const char* kNoBetterHeldOut = "the recordings held out are simulated no better with it";

/// One diagnosis: reads the runs, fits, chooses effects, explains them, decides the verdict.
class JointDiagnosisRun {
 public:
  JointDiagnosisRun(const bench::Bench& bench, const DiagnoseOptions& options, const work::Progress& progress)
      : bench_(bench), options_(options), by_(options.decide_by), progress_(progress) {
    diagnosis_.options = by_;
  }

  Diagnosis run(DiagnosedRuns* runs) {
    const double step_s = options_.step_s > 0.0 ? options_.step_s : calib::simulation_step_s(bench_);
    report(0.0, "reading " + bench_.folder.string());
    std::vector<calib::SingleJoint> fitted = calib::read_joints(bench_, options_.fit, step_s), scored;
    if (!options_.score.empty()) scored = calib::read_joints(bench_, options_.score, step_s);
    calib::expect_apart(fitted, scored);
    diagnosis_.noise_floor = calib::joint_floor(bench_, fitted, by_.odd_runs);
    calib::leave_out_odd_runs(diagnosis_.noise_floor, fitted);
    diagnosis_.unit = bench_.rig == bench::Rig::kLinear ? "m" : "rad";
    checks_ = checks(fitted);
    report(0.02, "fitting what the simulation has");
    const BaseModel base = base_at_chosen_step(fitted, scored);
    const bool differ =
        tell_assemblies(fitted, scored, searched(fitted).fit(base.model, base.unknowns, 0), base, false);
    const effects::NestedFit all(fitted, options_.threads), fit = searched(fitted);
    SearchLimits limits = search_limits(by_, std::pow(diagnosis_.noise_floor.rms_rad, 2), !options_.model);
    limits.recordings_have_step = diagnosis_.step.limit == calib::StepLimit::kResidual;
    EffectSearch search(
        bench_, fit, base, limits,
        direct_evidence(checks_, base.model.actuator, diagnosis_.noise_floor.rms_rad, base.scale.speed_rad_s, by_), by_,
        {.report = [this](double, std::string_view doing) { report(share_ + 0.02 * (0.9 - share_), doing); },
         .interrupted = progress_.interrupted});
    auto [chosen, final_fit] = final_model(search, all, scored);
    for (const calib::Unknown& u : search.base_model().unknowns) diagnosis_.base_parameters.push_back(u.name);
    const bool differ_at_end = tell_assemblies(fitted, scored, final_fit, base, true);
    const effects::NestedFit of_assemblies(fitted, options_.threads);
    if (differ_at_end)
      final_fit = diagnosis_.assemblies.fitted;
    else if (differ)
      final_fit = of_assemblies.fit(final_fit.model, final_fit.unknowns, 8, nullptr, final_fit.prior_weight);
    if (differ || differ_at_end) {
      of_assemblies.linearise(final_fit);
      count_step(of_assemblies, final_fit);
    }
    rest_squares_ = differ || differ_at_end
                        ? usual_rest(of_assemblies, final_fit, std::pow(diagnosis_.noise_floor.rms_rad, 2))
                        : search.usual_rest(chosen);
    if (runs != nullptr) *runs = {fitted, scored, checks_, {}};
    diagnosis_.before = search.base().fitted.model;
    if (all.runs().size() > fit.runs().size())
      diagnosis_.before = all.fit(diagnosis_.before, search.base().fitted.unknowns, 8).model;
    diagnosis_.after = final_fit.model;
    diagnosis_.step_error_after = calib::integration_error(bench_, fit.runs(), diagnosis_.after, options_.threads);
    count_integration_error(rest_squares_, fit, base);
    score(of_assemblies, scored);
    std::vector<evidence::Signature> expected;
    if (!chosen.effects.empty() || runs != nullptr) {
      expected =
          evidence::CheckPower(bench_, fitted, base.scale.quantum_rad, by_.signatures).expected(diagnosis_.after);
    }
    if (runs != nullptr) runs->expected = expected;
    explanation_ = explain(search, chosen,
                           {.searched = fit,
                            .all = of_assemblies,
                            .judged = *judged_,
                            .fitted = final_fit,
                            .checks = checks_,
                            .expected = expected,
                            .noise = diagnosis_.noise_floor,
                            .options = by_,
                            .error_after = diagnosis_.held_out_after.value,
                            .unit = diagnosis_.unit});
    diagnosis_.causes = explanation_.causes;
    for (Cause& cause : diagnosis_.causes) {
      for (evidence::ParameterEstimate& p : cause.parameters) p.unit = calib::unit_on_rig(p.unit, bench_);
    }
    diagnosis_.rejected = explanation_.rejected;
    leave_out_what_only_differs(diagnosis_, chosen.forms);
    conclude(search, of_assemblies, fit);
    if (diagnosis_.verdict == evidence::Verdict::kUnexplained)
      extend_unexplained(search, chosen, searched(fitted), of_assemblies);
    return diagnosis_;
  }

 private:
  effects::NestedFit searched(const std::vector<calib::SingleJoint>& fitted) const {
    return {calib::spread(fitted, static_cast<std::size_t>(by_.searched_runs)), options_.threads};
  }

  /// The base model, at the step that its integration error asks for. Changes the runs to this step, and adds what
  /// remains of the error to the noise floor.
  BaseModel base_at_chosen_step(std::vector<calib::SingleJoint>& fitted, std::vector<calib::SingleJoint>& scored) {
    const effects::NestedFit first = searched(fitted);
    BaseModel base =
        base_model(bench_, options_.model, first, by_, std::pow(diagnosis_.noise_floor.rms_rad, 2), options_.threads);
    noise_ = diagnosis_.noise_floor;
    calib::ChosenStep& step = diagnosis_.step;
    if (options_.step_s > 0.0) {
      step.first = step.error = calib::integration_error(bench_, first.runs(), base.model, options_.threads);
      step.limit = calib::StepLimit::kGiven;
    } else {
      const auto refit = [&](const std::vector<calib::SingleJoint>& at_step, const calib::JointModel& start) {
        const effects::NestedFit fit(at_step, options_.threads);
        const calib::JointModel model = fit.fit(start, base.unknowns, static_cast<int>(by_.many_iterations)).model;
        const fitting::BlockComparison compare(fit.blocks(), {}, std::pow(noise_.rms_rad, 2));
        const double usual_squares = std::exp(compare.mean_log_square(fit.blocks().squares(fit.residuals(model))));
        return calib::FittedAtStep{model, usual_squares - std::pow(noise_.rms_rad, 2)};
      };
      step = calib::chosen_step(bench_, first.runs(), base.model, noise_.rms_rad, refit, by_.step, options_.threads);
    }
    if (step.error.step_s != step.first.step_s) {
      fitted = calib::with_step(bench_, fitted, step.error.step_s);
      scored = calib::with_step(bench_, scored, step.error.step_s);
    }
    if (!small_error())
      diagnosis_.noise_floor =
          calib::with_integration_error(noise_, error_in(searched(fitted), base.model, base, step.error.rms_rad));
    return base;
  }

  /// True if the search needs no allowance for the integrator.
  bool small_error() const {
    return diagnosis_.step.limit == calib::StepLimit::kError || diagnosis_.step.limit == calib::StepLimit::kResidual;
  }

  /// An integrator's error as far as the residual may be made of it. A given step may have an error beyond the
  /// residual, most of which the base model's numbers have taken up.
  double error_in(const effects::NestedFit& fit, const calib::JointModel& model, const BaseModel& base,
                  double error_rad) const {
    return std::min(error_rad, effects::integration_part_rms(bench_, fit, model, base.unknowns));
  }

  /// (mean square that remains beyond the noise): the final model's integration error counts as noise as far as the
  /// rest may be made of it. None counts where the recordings are no finer than the step.
  void count_integration_error(double rest_squares, const effects::NestedFit& fit, const BaseModel& base) {
    double error_rad = diagnosis_.step.error.rms_rad;
    if (small_error()) error_rad = std::min(diagnosis_.step_error_after.rms_rad, std::sqrt(rest_squares));
    const bool counts = diagnosis_.step.limit != calib::StepLimit::kResidual;
    diagnosis_.noise_floor =
        calib::with_integration_error(noise_, counts ? error_in(fit, diagnosis_.after, base, error_rad) : 0.0);
  }

  /// Why the effect leaves the extension if the scored runs are simulated no worse without it, or "".
  static std::string no_better(EffectSearch& search, const Extension& chosen, const std::string& name,
                               const effects::NestedFit& judged) {
    if (judged.runs().empty()) return "";
    const auto error_rad = [&](const Extension& with) {
      return judged.blocks().absolutes(judged.residuals(with.fitted.model)).mean();
    };
    const bool better = error_rad(chosen) < error_rad(search.refit_without(chosen, name));
    return better ? "" : kNoBetterHeldOut;
  }

  /// The search's result, and its fit with priors to all runs. Effects whose numbers are unsure on all runs leave, and
  /// those that the scored runs are no better for.
  std::pair<Extension, effects::NestedModel> final_model(EffectSearch& search, const effects::NestedFit& all,
                                                         const std::vector<calib::SingleJoint>& scored) {
    const std::vector<fitting::Fold> all_folds = folds(all);
    const effects::NestedFit judged(scored, options_.threads);
    for (Extension chosen = search.choose();;) {
      const Settled settled = search.settled(std::move(chosen));
      chosen = settled.chosen;
      report(share_, "fitting from other starts");
      effects::NestedModel fitted = search.from_other_starts(settled.with_priors);
      if (all.runs().size() > search.runs()) {
        report(share_, "fitting all runs");
        fitted = all.fit(fitted.model, fitted.unknowns, 8, nullptr, fitted.prior_weight);
        if (fitted.blocks.empty()) all.linearise(fitted);
      }
      fitted = with_wide_differences(all, std::move(fitted), all_folds, std::pow(diagnosis_.noise_floor.rms_rad, 2),
                                     by_.intervals);
      std::string none, why;
      for (const std::string& name : chosen.effects) {
        if (search.measured(name) != nullptr) continue;
        why = search.unsure(name, chosen.forms, fitted, &all_folds);
        if (why.empty()) why = no_better(search, chosen, name, judged);
        if (!why.empty()) {
          none = name;
          break;
        }
      }
      if (none.empty()) {
        count_step(all, fitted);
        return {std::move(chosen), std::move(fitted)};
      }
      chosen = search.leave_out(chosen, none, why);
    }
  }

  /// Intervals reach to where an exact integrator would put the numbers, unless the recordings are no finer than the
  /// step.
  void count_step(const effects::NestedFit& fit, effects::NestedModel& model) const {
    if (diagnosis_.step.limit != calib::StepLimit::kResidual) model.step_shift = step_shift(bench_, fit, model);
  }

  /// True if parameters differ from assembly to assembly: the runs have them from then on.
  bool tell_assemblies(std::vector<calib::SingleJoint>& fitted, std::vector<calib::SingleJoint>& scored,
                       const effects::NestedModel& model, const BaseModel& base, bool loads_too) {
    report(share_, "comparing assemblies");
    const double noise_squares = std::pow(diagnosis_.noise_floor.rms_rad, 2);
    diagnosis_.assemblies =
        told_apart(bench_, fitted, scored, model, base.model, noise_squares, loads_too, options_.threads, by_.assembly);
    return !diagnosis_.assemblies.varies.empty();
  }

  std::vector<evidence::Signature> checks(const std::vector<calib::SingleJoint>& fitted) const {
    std::vector<bench::BenchRun> runs;
    for (const calib::SingleJoint& joint : fitted) runs.push_back(joint.run());
    return evidence::signatures(bench_, runs, by_.signatures);
  }

  void report(double share, std::string_view doing) {
    share_ = std::max(share_, share);
    if (progress_.report) progress_.report(share_, doing);
  }

  void score(const effects::NestedFit& fit, const std::vector<calib::SingleJoint>& scored) {
    diagnosis_.held_out = !scored.empty();
    judged_.emplace(scored.empty() ? fit.runs() : scored, options_.threads);
    const effects::NestedFit before(assembly::without_differences(judged_->runs()), options_.threads);
    const effects::HeldOutErrors errors =
        held_out_errors(before, diagnosis_.before, *judged_, diagnosis_.after, options_.seed);
    diagnosis_.held_out_before = errors.before;
    diagnosis_.standing_still = calib::standing_still(judged_->runs()).mean_absolute_rad();
    count_after(errors.after);
  }

  void count_after(const evidence::Interval& after) {
    diagnosis_.held_out_after = after;
    const double before = diagnosis_.held_out_before.value, way = before - diagnosis_.noise_floor.mean_absolute_rad;
    diagnosis_.share_of_way_to_floor = way > 0.0 ? (before - after.value) / way : 0.0;
  }

  void ask_for_more(const effects::NestedFit& fit) {
    if (explanation_.rivals.empty()) return;
    report(share_, "looking for what to record next");
    AskedFor asked =
        next_excitation(bench_, fit.runs(), explanation_.rivals,
                        separation_wanted(by_, std::pow(diagnosis_.noise_floor.rms_rad, 2)), options_.threads);
    diagnosis_.next_excitation = std::move(asked.next);
    unite(asked.same_here, diagnosis_.causes);
  }

  /// True if the model misses the judged runs by more than a verdict forgives, and hardly less than a joint that stands
  /// still. The rest of usual blocks says nothing of a joint that sticks in most of them.
  bool misses_the_motion() const {
    const double after = diagnosis_.held_out_after.value;
    return after > std::sqrt(by_.remains_of_noise) * diagnosis_.noise_floor.mean_absolute_rad &&
           after > calib::kExplainedShare * diagnosis_.standing_still;
  }

  bool has_no_cause() const { return diagnosis_.causes.empty() && diagnosis_.assemblies.varies.empty(); }

  /// True if the model has no causes and misses the judged runs by more than that of a sound joint. The rest of usual
  /// blocks says nothing of a joint that does what no effect explains in few.
  bool misses_more_than_of_sound_joint() const {
    return has_no_cause() &&
           diagnosis_.held_out_after.value > by_.without_cause_of_floor * diagnosis_.noise_floor.mean_absolute_rad;
  }

  void conclude(const EffectSearch& search, const effects::NestedFit& of_assemblies, const effects::NestedFit& fit) {
    const double noise = std::max(1e-300, std::pow(diagnosis_.noise_floor.rms_rad, 2));
    const double rest = rest_squares_, beginning = search.usual_rest(search.base());
    diagnosis_.before_over_noise = std::sqrt(1.0 + beginning / noise);
    diagnosis_.after_over_noise = std::sqrt(1.0 + rest / noise);
    const auto leaves = [&](double of_noise, double of_beginning) {
      return rest > (of_noise - 1.0) * noise && rest > of_beginning * beginning;
    };
    const bool remains =
        leaves(by_.remains_of_noise, by_.remains_of_beginning) || misses_the_motion() ||
        misses_more_than_of_sound_joint() ||
        (!diagnosis_.causes.empty() && leaves(by_.causes_leave_of_noise, by_.causes_leave_of_beginning));
    if (remains) {
      diagnosis_.depends_on = significant_dependences(
          residual_samples(bench_, of_assemblies.runs(), diagnosis_.after, options_.threads, by_.signatures.step));
    }
    ask_for_more(fit);
    const bool alike = std::any_of(diagnosis_.causes.begin(), diagnosis_.causes.end(),
                                   [](const Cause& cause) { return !cause.or_instead.empty(); });
    diagnosis_.verdict = progress_.interrupted_now() ? evidence::Verdict::kInterrupted
                         : remains                   ? evidence::Verdict::kUnexplained
                         : alike                     ? evidence::Verdict::kAmbiguous
                         : has_no_cause()            ? evidence::Verdict::kNone
                                                     : evidence::Verdict::kFound;
  }

  /// No effect explains the rest: a residual torque may at least describe it.
  void extend_unexplained(const EffectSearch& search, const Extension& from, const effects::NestedFit& fit,
                          const effects::NestedFit& all) {
    diagnosis_.residual_extension = residual_torque::extend(
        {bench_, fit, all, from.fitted, from.held_out, search.base_model().scale}, by_.extension, progress_);
    residual_torque::Extension& found = *diagnosis_.residual_extension;
    const effects::HeldOutErrors errors =
        held_out_errors(*judged_, diagnosis_.after, *judged_, found.model, options_.seed);
    found.held_out_before = found.held_out_after = errors.before;
    if (found.kept && diagnosis_.held_out && !(errors.after.value < errors.before.value)) {
      found.kept = false;
      found.why_not = kNoBetterHeldOut;
    }
    if (!found.kept) return;
    found.held_out_after = errors.after;
    diagnosis_.after = found.model;
    count_after(errors.after);
  }

  const bench::Bench bench_;
  const DiagnoseOptions& options_;
  const JointDiagnosisOptions& by_;
  const work::Progress& progress_;
  double share_ = 0.0, rest_squares_ = 0.0;
  Diagnosis diagnosis_;
  calib::JointFloor noise_;  // without the integrator's error
  std::optional<effects::NestedFit> judged_;
  std::vector<evidence::Signature> checks_;
  Explanation explanation_;
};

}  // namespace

Diagnosis diagnose(const bench::Bench& bench, const DiagnoseOptions& options, DiagnosedRuns* runs,
                   const work::Progress& progress) {
  const std::vector<std::string> filters = {options.fit, options.score};
  data_faults::Examination data =
      data_faults::examine(bench, filters, options.model, options.data, options.threads, progress);
  std::atomic<bool> stopped{false};  // for good: whoever asked has cut its work short
  const work::Progress lasting{.report = progress.report, .interrupted = [&] {
                                 if (progress.interrupted_now()) stopped = true;
                                 return stopped.load();
                               }};
  Diagnosis found = JointDiagnosisRun(data_faults::examined_bench(bench, data), options, lasting).run(runs);
  // A wrong mass or gain shows beside a model that misses little, and so does one that only seemed wrong.
  if (!found.causes.empty() && !lasting.interrupted_now()) {
    if (auto again = data_faults::examine_again(bench, filters, data, found.after, options.threads)) {
      data = *std::move(again);
      if (!data.uncorrected())
        found = JointDiagnosisRun(data_faults::examined_bench(bench, data), options, lasting).run(runs);
    }
  }
  found.data = data;
  return found;
}

}  // namespace pmg::diagnosis
