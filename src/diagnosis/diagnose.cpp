#include "diagnosis/diagnose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "bench/noise_floor.hpp"
#include "calib/fit_problem.hpp"
#include "diagnosis/effect_search.hpp"
#include "diagnosis/explanation.hpp"
#include "diagnosis/intervals.hpp"
#include "diagnosis/next_excitation.hpp"
#include "diagnosis/residual.hpp"
#include "evidence/signature.hpp"

namespace pmg::diagnosis {

namespace {

constexpr std::size_t kSearchedRuns = 40;  // the choice is made on so many, the result fitted to all
// What remains is something where its mean square is more than that of so much noise (loads are weighed to a percent,
// friction changes from day to day, and no joint is quite its model), and no small rest of what was found.
constexpr double kRemains = 8.0, kRemainsOfBeginning = 0.1;

std::vector<calib::SingleJoint> read(const bench::Bench& bench, const std::string& filter, double step_s) {
  std::vector<calib::SingleJoint> joints;
  for (bench::BenchRun& run : bench.read_runs(bench::RowFilter(filter))) {
    joints.emplace_back(bench, std::move(run), step_s);
  }
  return joints;
}

/// At most so many, spread over the list by steps of the golden ratio: no period of its order is met.
std::vector<calib::SingleJoint> spread(const std::vector<calib::SingleJoint>& runs, std::size_t most) {
  if (runs.size() <= most) return runs;
  std::vector<bool> taken(runs.size(), false);
  std::vector<calib::SingleJoint> found;
  for (double position = 0.5; found.size() < most; position = std::fmod(position + 0.6180339887498949, 1.0)) {
    const auto index = static_cast<std::size_t>(position * static_cast<double>(runs.size()));
    if (!taken[index]) found.push_back(runs[index]);
    taken[index] = true;
  }
  return found;
}

/// Scoring what was fitted would say nothing.
void expect_apart(const std::vector<calib::SingleJoint>& fitted, const std::vector<calib::SingleJoint>& scored) {
  std::set<std::string> files;
  for (const calib::SingleJoint& joint : fitted) files.insert(joint.run().file);
  for (const calib::SingleJoint& joint : scored) {
    if (!files.contains(joint.run().file)) continue;
    throw std::invalid_argument(
        fmt::format("{} is both in --fit and in --score; expected different runs", joint.run().file));
  }
}

/// From whatever the bench repeats; else the sensor's own noise in the fitted runs.
NoiseFloor noise_floor(const bench::Bench& bench, const std::vector<calib::SingleJoint>& fitted) {
  const std::vector<bench::BenchRun> all = bench.read_runs(bench::RowFilter(""));
  std::vector<const bench::BenchRun*> runs;
  for (const bench::BenchRun& run : all) runs.push_back(&run);
  const bench::NoiseFloor found = bench::noise_floor(runs);
  if (!found.pairs.empty()) {
    return {found.mean_absolute_rad, found.rms_rad, true,
            fmt::format("{} pairs of repeats, each about what both have in common", found.pairs.size())};
  }
  double squares = 0.0;
  for (const calib::SingleJoint& joint : fitted) squares += std::pow(bench::sensor_noise_rad(joint.run().recording), 2);
  const double rms_rad = std::sqrt(squares / static_cast<double>(fitted.size()));
  return {std::sqrt(2.0 / 3.141592653589793) * rms_rad, rms_rad, false,
          "nothing was repeated: the sensor's own noise, from sixth differences of its readings"};
}

class Diagnosing {
 public:
  Diagnosing(const bench::Bench& bench, const DiagnoseOptions& options, const DiagnoseProgress& progress)
      : bench_(bench), options_(options), progress_(progress) {}

  Diagnosis run(DiagnosedRuns* runs) {
    const double step_s = options_.step_s > 0.0 ? options_.step_s : calib::simulation_step_s(bench_);
    tell(0.0, "reading " + bench_.folder.string());
    std::vector<calib::SingleJoint> fitted = read(bench_, options_.fit, step_s), scored;
    if (!options_.score.empty()) scored = read(bench_, options_.score, step_s);
    expect_apart(fitted, scored);
    diagnosis_.noise_floor = noise_floor(bench_, fitted);
    diagnosis_.unit = bench_.rig == bench::Rig::kLinear ? "m" : "rad";
    if (runs != nullptr) *runs = {fitted, scored};
    checks_ = checks(fitted);
    const NestedFit all(fitted, options_.threads), fit(spread(fitted, kSearchedRuns), options_.threads);
    tell(0.02, "fitting what the simulation has");
    const BaseModel base = base_model(bench_, options_.model, fit, options_.threads);
    EffectSearch search(bench_, fit, base, limits(),
                        direct_evidence(checks_, base.model.actuator, diagnosis_.noise_floor.rms_rad),
                        [this](const std::string& text) { return tell(share_ + 0.02 * (0.9 - share_), text); });
    for (const Unknown& u : search.base_model().unknowns) diagnosis_.base_parameters.push_back(u.name);
    Extension chosen = search.choose();
    const Extension settled = search.settled(chosen);
    if (settled.fitted.squares < chosen.fitted.squares) chosen = settled;
    diagnosis_.before = search.base().fitted.model;
    diagnosis_.after = settled.fitted.model;
    NestedModel final_fit = settled.fitted;
    if (all.runs().size() > fit.runs().size()) {
      tell(share_, "fitting all runs");
      final_fit = all.fit(settled.fitted.model, settled.fitted.unknowns, 8, nullptr, settled.fitted.prior_weight);
      all.linearise(final_fit);
      diagnosis_.before = all.fit(diagnosis_.before, search.base().fitted.unknowns, 8).model;
      diagnosis_.after = final_fit.model;
    }
    score(all, scored);
    explanation_ = explain(search, chosen,
                           {.searched = fit,
                            .all = all,
                            .judged = *judged_,
                            .fitted = final_fit,
                            .checks = checks_,
                            .noise = diagnosis_.noise_floor,
                            .error_after = diagnosis_.held_out_after.value,
                            .unit = diagnosis_.unit});
    diagnosis_.causes = explanation_.causes;
    diagnosis_.rejected = explanation_.rejected;
    conclude(search, chosen, fit);
    return diagnosis_;
  }

 private:
  SearchLimits limits() const {
    const double noise = std::pow(diagnosis_.noise_floor.rms_rad, 2);
    if (options_.model) return {.noise_squares = noise};
    // From scratch there are several effects to be found, the weaker in the presence of the stronger.
    return {.noise_squares = noise, .healthy_squares = noise, .of_noise = 0.4, .of_beginning = 0.05, .of_rest = 0.1};
  }

  std::vector<evidence::Signature> checks(const std::vector<calib::SingleJoint>& fitted) const {
    std::vector<bench::BenchRun> runs;
    for (const calib::SingleJoint& joint : fitted) runs.push_back(joint.run());
    return evidence::signatures(bench_, runs);
  }

  bool tell(double share, const std::string& text) {
    share_ = std::max(share_, share);
    return !progress_ || progress_(share_, text);
  }

  void score(const NestedFit& fit, const std::vector<calib::SingleJoint>& scored) {
    diagnosis_.held_out = !scored.empty();
    judged_.emplace(scored.empty() ? fit.runs() : scored, options_.threads);
    const HeldOutErrors errors = held_out_errors(*judged_, diagnosis_.before, diagnosis_.after, options_.seed);
    diagnosis_.held_out_before = errors.before;
    diagnosis_.held_out_after = errors.after;
    const double way = errors.before.value - diagnosis_.noise_floor.mean_absolute_rad;
    diagnosis_.share_of_way_to_floor = way > 0.0 ? (errors.before.value - errors.after.value) / way : 0.0;
  }

  /// What no run would tell apart is one cause with several names.
  void ask_for_more(const NestedFit& fit) {
    if (explanation_.rivals.empty()) return;
    tell(share_, "looking for what to record next");
    const SeparationWanted wanted{kApartDeviations, std::pow(diagnosis_.noise_floor.rms_rad, 2)};
    AskedFor asked = next_excitation(bench_, fit.runs(), explanation_.rivals, wanted, options_.threads);
    diagnosis_.next_excitation = std::move(asked.next);
    for (Cause& cause : diagnosis_.causes) {
      for (const auto& [first, second] : asked.same_here) {
        if (first != cause.effect || std::erase(cause.or_instead, second) == 0) continue;
        cause.same_here.push_back(second);
      }
    }
  }

  void conclude(const EffectSearch& search, const Extension& chosen, const NestedFit& fit) {
    const double noise = std::max(1e-300, std::pow(diagnosis_.noise_floor.rms_rad, 2));
    const double rest = search.usual_rest(chosen), beginning = search.usual_rest(search.base());
    diagnosis_.before_over_noise = std::sqrt(1.0 + beginning / noise);
    diagnosis_.after_over_noise = std::sqrt(1.0 + rest / noise);
    const bool remains = rest > (kRemains - 1.0) * noise && rest > kRemainsOfBeginning * beginning;
    if (remains) {
      for (const Dependence& d :
           dependences(residual_samples(bench_, fit.runs(), chosen.fitted.model, options_.threads))) {
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

  const bench::Bench& bench_;
  const DiagnoseOptions& options_;
  const DiagnoseProgress& progress_;
  double share_ = 0.0;
  Diagnosis diagnosis_;
  std::optional<NestedFit> judged_;
  std::vector<evidence::Signature> checks_;  // without a model
  Explanation explanation_;
};

}  // namespace

Diagnosis diagnose(const bench::Bench& bench, const DiagnoseOptions& options, DiagnosedRuns* runs,
                   const DiagnoseProgress& progress) {
  return Diagnosing(bench, options, progress).run(runs);
}

}  // namespace pmg::diagnosis
