#include "diagnosis/diagnose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/joint_floor.hpp"
#include "calib/joint_runs.hpp"
#include "diagnosis/effect_search.hpp"
#include "diagnosis/explanation.hpp"
#include "diagnosis/intervals.hpp"
#include "diagnosis/next_excitation.hpp"
#include "diagnosis/residual.hpp"
#include "evidence/signature.hpp"

namespace pmg::diagnosis {

namespace {

/// One diagnosis: reads the runs, fits, chooses effects, explains them, decides the verdict.
class JointDiagnosisRun {
 public:
  JointDiagnosisRun(const bench::Bench& bench, const DiagnoseOptions& options, const work::Progress& progress)
      : bench_(bench), options_(options), by_(options.decide_by), progress_(progress) {
    diagnosis_.options = listed(by_);
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
    const effects::NestedFit all(fitted, options_.threads), fit = searched(fitted);
    if (runs != nullptr) *runs = {fitted, scored, checks_};
    EffectSearch search(
        bench_, fit, base, limits(),
        direct_evidence(checks_, base.model.actuator, diagnosis_.noise_floor.rms_rad, base.scale.speed_rad_s, by_), by_,
        {.report = [this](double, std::string_view doing) { report(share_ + 0.02 * (0.9 - share_), doing); },
         .interrupted = progress_.interrupted});
    for (const effects::Unknown& u : search.base_model().unknowns) diagnosis_.base_parameters.push_back(u.name);
    Extension chosen = search.choose();
    const Extension settled = search.refit_with_priors(chosen);
    if (settled.fitted.squares < by_.settled_squares * chosen.fitted.squares) chosen = settled;
    diagnosis_.before = search.base().fitted.model;
    diagnosis_.after = settled.fitted.model;
    effects::NestedModel final_fit = settled.fitted;
    if (all.runs().size() > fit.runs().size()) {
      report(share_, "fitting all runs");
      final_fit = all.fit(settled.fitted.model, settled.fitted.unknowns, 8, nullptr, settled.fitted.prior_weight);
      all.linearise(final_fit);
      diagnosis_.before = all.fit(diagnosis_.before, search.base().fitted.unknowns, 8).model;
      diagnosis_.after = final_fit.model;
    }
    diagnosis_.step_error_after = calib::integration_error(bench_, fit.runs(), diagnosis_.after, options_.threads);
    count_integration_error(search.usual_rest(chosen));
    score(all, scored);
    std::vector<evidence::Signature> expected;
    if (!chosen.effects.empty()) {
      expected =
          evidence::CheckPower(bench_, fitted, base.scale.quantum_rad, by_.signatures).expected(diagnosis_.after);
    }
    explanation_ = explain(search, chosen,
                           {.searched = fit,
                            .all = all,
                            .judged = *judged_,
                            .fitted = final_fit,
                            .checks = checks_,
                            .expected = expected,
                            .noise = diagnosis_.noise_floor,
                            .options = by_,
                            .error_after = diagnosis_.held_out_after.value,
                            .unit = diagnosis_.unit});
    diagnosis_.causes = explanation_.causes;
    diagnosis_.rejected = explanation_.rejected;
    conclude(search, chosen, fit);
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
    BaseModel base = base_model(bench_, options_.model, first, by_, options_.threads);
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
    if (!small_error()) diagnosis_.noise_floor = calib::with_integration_error(noise_, step.error.rms_rad);
    return base;
  }

  /// True if the search needs no allowance for the integrator.
  bool small_error() const {
    return diagnosis_.step.limit == calib::StepLimit::kError || diagnosis_.step.limit == calib::StepLimit::kResidual;
  }

  /// (mean square that remains beyond the noise): what is left of the integrator's error counts as noise. An error that
  /// was small beside the base model's residual counts as far as there is a rest that it may have made. None counts
  /// where the recordings are no finer than the step.
  void count_integration_error(double rest_squares) {
    double error_rad = std::max(diagnosis_.step.error.rms_rad, diagnosis_.step_error_after.rms_rad);
    if (small_error()) error_rad = std::min(diagnosis_.step_error_after.rms_rad, std::sqrt(rest_squares));
    if (diagnosis_.step.limit == calib::StepLimit::kResidual) error_rad = 0.0;
    diagnosis_.noise_floor = calib::with_integration_error(noise_, error_rad);
  }

  SearchLimits limits() const {
    const double noise = std::pow(diagnosis_.noise_floor.rms_rad, 2);
    if (options_.model) {
      return {.noise_squares = noise,
              .healthy_squares = 0.0,
              .of_noise = by_.amplitude_of_noise,
              .of_beginning = by_.amplitude_of_beginning,
              .of_rest = by_.gain_of_rest};
    }
    // From scratch: several effects are missing, so weaker ones must be found beside stronger ones.
    return {.noise_squares = noise,
            .healthy_squares = noise,
            .of_noise = by_.scratch_amplitude_of_noise,
            .of_beginning = by_.scratch_amplitude_of_beginning,
            .of_rest = by_.scratch_gain_of_rest};
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
    const HeldOutErrors errors = held_out_errors(*judged_, diagnosis_.before, diagnosis_.after, options_.seed);
    diagnosis_.held_out_before = errors.before;
    diagnosis_.held_out_after = errors.after;
    const double way = errors.before.value - diagnosis_.noise_floor.mean_absolute_rad;
    diagnosis_.share_of_way_to_floor = way > 0.0 ? (errors.before.value - errors.after.value) / way : 0.0;
  }

  /// Plans the next excitation. Effects that no run on this rig can separate become one cause with several names.
  void ask_for_more(const effects::NestedFit& fit) {
    if (explanation_.rivals.empty()) return;
    report(share_, "looking for what to record next");
    const SeparationWanted wanted{.deviations = by_.apart_deviations,
                                  .noise_squares = std::pow(diagnosis_.noise_floor.rms_rad, 2),
                                  .enough = by_.enough_deviations,
                                  .most_runs = static_cast<std::size_t>(by_.most_asked_runs),
                                  .most_recordings = static_cast<int>(by_.most_asked_recordings)};
    AskedFor asked = next_excitation(bench_, fit.runs(), explanation_.rivals, wanted, options_.threads);
    diagnosis_.next_excitation = std::move(asked.next);
    for (Cause& cause : diagnosis_.causes) {
      for (const auto& [first, second] : asked.same_here) {
        if (first != cause.effect || std::erase(cause.or_instead, second) == 0) continue;
        cause.same_here.push_back(second);
      }
    }
  }

  void conclude(const EffectSearch& search, const Extension& chosen, const effects::NestedFit& fit) {
    const double noise = std::max(1e-300, std::pow(diagnosis_.noise_floor.rms_rad, 2));
    const double rest = search.usual_rest(chosen), beginning = search.usual_rest(search.base());
    diagnosis_.before_over_noise = std::sqrt(1.0 + beginning / noise);
    diagnosis_.after_over_noise = std::sqrt(1.0 + rest / noise);
    const bool remains = rest > (by_.remains_of_noise - 1.0) * noise && rest > by_.remains_of_beginning * beginning;
    if (remains) {
      for (const Dependence& d : dependences(
               residual_samples(bench_, fit.runs(), chosen.fitted.model, options_.threads, by_.signatures.step))) {
        if (d.significant()) diagnosis_.depends_on.push_back(d.name);
      }
    }
    ask_for_more(fit);
    const bool alike = std::any_of(diagnosis_.causes.begin(), diagnosis_.causes.end(),
                                   [](const Cause& cause) { return !cause.or_instead.empty(); });
    diagnosis_.verdict = remains                     ? evidence::Verdict::kUnexplained
                         : alike                     ? evidence::Verdict::kAmbiguous
                         : diagnosis_.causes.empty() ? evidence::Verdict::kNone
                                                     : evidence::Verdict::kFound;
  }

  const bench::Bench bench_;
  const DiagnoseOptions& options_;
  const JointDiagnosisOptions& by_;
  const work::Progress& progress_;
  double share_ = 0.0;
  Diagnosis diagnosis_;
  calib::JointFloor noise_;  // without the integrator's error
  std::optional<effects::NestedFit> judged_;
  std::vector<evidence::Signature> checks_;
  Explanation explanation_;
};

}  // namespace

Diagnosis diagnose(const bench::Bench& bench, const DiagnoseOptions& options, DiagnosedRuns* runs,
                   const work::Progress& progress) {
  const data_faults::Examination data =
      data_faults::examine(bench, {options.fit, options.score}, options.model, options.data, options.threads, progress);
  Diagnosis found = JointDiagnosisRun(data_faults::examined_bench(bench, data), options, progress).run(runs);
  found.data = data;
  return found;
}

}  // namespace pmg::diagnosis
