#include "diagnosis/next_excitation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "effects/excitation_candidates.hpp"
#include "effects/separation.hpp"
#include "work/parallel.hpp"

namespace pmg::diagnosis {

namespace {

constexpr int kTimes = 2, kMostTimes = 8;
constexpr double kWorthARun = 0.01;  // least gain of a recording, as a share of all pairs' targets

bool are(const std::string& a, const std::string& b, const char* one, const char* other) {
  return (a == one && b == other) || (a == other && b == one);
}

/// Dry friction c (1 + a) in one direction and c (1 - a) in the other equals friction c in both and a constant torque
/// -a c, sliding or sticking, unless c varies with speed, load, temperature or heat.
bool are_one_torque(const std::string& a, const std::string& b, const model::ActuatorParameters& model) {
  const auto& f = model.friction;
  const bool varies = f.stribeck_Nm != 0.0 || f.load_driving != 0.0 || f.load_backdriving != 0.0 ||
                      model.thermal.friction_per_K != 0.0 || model.thermal.friction_per_Nm2_s != 0.0;
  return !varies && are(a, b, "offset", "direction_friction");
}

/// Two rival models, the first taken as the truth.
struct Pair {
  std::size_t rivals, truth, other;
  effects::Separation separation;
};

/// A candidate run: its blocks for every pair.
using Seen = std::vector<effects::Separation::Blocks>;

class Campaign {
 public:
  Campaign(const bench::Bench& bench, const std::vector<calib::SingleJoint>& runs, const std::vector<Rivals>& rivals,
           const SeparationWanted& wanted, unsigned threads)
      : rivals_(rivals),
        wanted_(wanted),
        candidates_(effects::excitation_candidates(bench, runs)),
        seen_(candidates_.size()) {
    for (std::size_t g = 0; g < rivals.size(); ++g) {
      const std::vector<effects::NestedModel>& models = rivals[g].models;
      for (std::size_t t = 0; t < models.size(); ++t) {
        for (std::size_t o = 0; o < models.size(); ++o) {
          if (t == o) continue;
          if (are_one_torque(rivals[g].names[t], rivals[g].names[o], models[t].model.actuator)) {
            if (t < o) same_here_.emplace_back(rivals[g].names[t], rivals[g].names[o]);
            continue;
          }
          pairs_.push_back({g, t, o, effects::Separation(models[t], models[o], wanted.noise_squares)});
        }
      }
    }
    work::for_each_in_parallel(candidates_.size(), threads, [&](std::size_t c) {
      seen_[c] = look(bench, candidates_[c].run, runs.front().step_s());
    });
  }

  /// The chosen candidates, and how often to record each.
  std::map<std::size_t, int> choose() {
    std::map<std::size_t, int> chosen;
    const auto count = static_cast<double>(pairs_.size());
    double reached = total(nullptr);
    for (int recorded = 0; recorded < wanted_.most_recordings && reached < wanted_.enough * count; recorded += kTimes) {
      std::size_t best = 0;
      double most = -1.0;
      for (std::size_t c = 0; c < candidates_.size(); ++c) {
        const auto already = chosen.find(c);
        if (already == chosen.end() ? chosen.size() >= wanted_.most_runs : already->second >= kMostTimes) continue;
        const double there = total(&seen_[c]);
        if (there > most) most = there, best = c;
      }
      if (most < reached + kWorthARun * count) break;
      for (std::size_t p = 0; p < pairs_.size(); ++p) pairs_[p].separation.add(seen_[best][p]);
      chosen[best] += kTimes;
      reached = total(nullptr);
    }
    return chosen;
  }

  /// Pairs of effects that are the same on this rig.
  const std::vector<std::pair<std::string, std::string>>& same_here() const { return same_here_; }
  const effects::ExcitationCandidate& candidate(std::size_t c) const { return candidates_[c]; }

  /// Expected deviations of each pair of rivals, the smaller of both directions.
  std::vector<ExpectedPair> expected() const {
    std::vector<ExpectedPair> found;
    for (const Pair& p : pairs_) {
      if (p.truth > p.other) continue;
      const auto back = std::find_if(pairs_.begin(), pairs_.end(), [&](const Pair& q) {
        return q.rivals == p.rivals && q.truth == p.other && q.other == p.truth;
      });
      const double deviations = std::min(p.separation.expected_deviations(), back->separation.expected_deviations());
      found.push_back({rivals_[p.rivals].names[p.truth], rivals_[p.rivals].names[p.other], deviations});
    }
    return found;
  }

 private:
  /// Sum of the expected deviations over all pairs, each capped at its target.
  double total(const Seen* further) const {
    double sum = 0.0;
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      const effects::Separation& separation = pairs_[p].separation;
      const double deviations =
          further == nullptr ? separation.expected_deviations() : separation.expected_deviations_with((*further)[p]);
      sum += std::min(wanted_.enough, deviations / wanted_.deviations);
    }
    return sum;
  }

  /// Rounding hides changes below a quantum, also in the Jacobian. So the quantum is set to 0 unless the rivals differ
  /// in it.
  static std::vector<effects::NestedModel> without_rounding(const Rivals& rivals) {
    std::vector<effects::NestedModel> models = rivals.models;
    const auto quantum_rad = [](const effects::NestedModel& m) { return m.model.actuator.sensor.quantum_rad; };
    for (const effects::NestedModel& model : models) {
      if (quantum_rad(model) != quantum_rad(models.front())) return models;
    }
    for (effects::NestedModel& model : models) model.model.actuator.sensor.quantum_rad = 0.0;
    return models;
  }

  Seen look(const bench::Bench& bench, const bench::BenchRun& run, double step_s) const {
    Seen seen(pairs_.size());
    const calib::SingleJoint unseen(bench, run, step_s);
    const effects::NestedFit still({unseen}, 1);
    for (std::size_t g = 0; g < rivals_.size(); ++g) {
      std::vector<effects::NestedFit> played;
      std::vector<effects::RolloutJacobian> slopes;
      const std::vector<effects::NestedModel> models = without_rounding(rivals_[g]);
      for (const effects::NestedModel& model : models) {
        bench::BenchRun as = run;
        as.recording.q_rad = unseen.rollout(model.model);
        played.emplace_back(std::vector{calib::SingleJoint(bench, std::move(as), step_s)}, 1U);
        slopes.push_back(still.jacobian(model, still.residuals(model.model)));
      }
      for (std::size_t p = 0; p < pairs_.size(); ++p) {
        if (pairs_[p].rivals != g) continue;
        effects::NestedModel other = models[pairs_[p].other];
        played[pairs_[p].truth].linearise(other, &slopes[pairs_[p].other]);
        for (int time = 0; time < kTimes; ++time) {
          seen[p].insert(seen[p].end(), other.blocks.begin(), other.blocks.end());
        }
      }
    }
    return seen;
  }

  const std::vector<Rivals>& rivals_;
  SeparationWanted wanted_;
  std::vector<effects::ExcitationCandidate> candidates_;
  std::vector<Seen> seen_;
  std::vector<Pair> pairs_;
  std::vector<std::pair<std::string, std::string>> same_here_;
};

/// The first number that no requested trajectory in runs.csv uses.
std::size_t first_number(const bench::Bench& bench) {
  const auto column = bench.runs.find("trajectory");
  if (!column) return 0;
  for (std::size_t number = 0;; ++number) {
    const std::string name = fmt::format("asked{}", number);
    const auto& rows = bench.runs.rows;
    if (std::none_of(rows.begin(), rows.end(), [&](const auto& row) { return row[*column] == name; })) return number;
  }
}

NextRun next_run(const bench::Bench& bench, const effects::ExcitationCandidate& candidate, int times,
                 std::size_t number) {
  const bench::BenchRun& run = candidate.run;
  NextRun next;
  next.name = fmt::format("asked{}", number);
  next.shape = candidate.shape;
  next.times = times;
  next.kp = run.kp;
  next.kd = run.kd;
  next.load = run.load;
  next.t_s = run.recording.t_s;
  next.q_cmd_rad = run.recording.q_cmd_rad;
  for (const bench::BenchLoad& one : bench.loads) {
    if (one.load.inertia_kg_m2 != run.load.inertia_kg_m2 || one.load.gravity_Nm != run.load.gravity_Nm) continue;
    next.load_mass_kg = one.mass_kg;
    next.load_length_m = one.length_m;
  }
  return next;
}

std::string text_of(const NextExcitation& next, double wanted_deviations) {
  std::vector<std::string> runs;
  for (const NextRun& run : next.runs) {
    const std::string load = run.load_mass_kg > 0.0 ? fmt::format(", load {:.3g} kg", run.load_mass_kg) : "";
    runs.push_back(fmt::format("{} times {} at kp {:.4g}{}", run.times, run.shape, run.kp, load));
  }
  double least = std::numeric_limits<double>::infinity();
  for (const ExpectedPair& pair : next.pairs) least = std::min(least, pair.deviations);
  return fmt::format("{}; {} are then expected to part by {:.1f} deviations or more, and {:.0f} {}",
                     fmt::join(runs, "; "), fmt::join(next.tells_apart, ", "), least, wanted_deviations,
                     least < wanted_deviations ? "are needed: it may not be enough" : "are enough");
}

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

}  // namespace

SeparationWanted separation_wanted(const JointDiagnosisOptions& options, double noise_squares) {
  return {.deviations = options.apart_deviations,
          .noise_squares = noise_squares,
          .enough = options.enough_deviations,
          .most_runs = static_cast<std::size_t>(options.most_asked_runs),
          .most_recordings = static_cast<int>(options.most_asked_recordings)};
}

AskedFor next_excitation(const bench::Bench& bench, const std::vector<calib::SingleJoint>& runs,
                         const std::vector<Rivals>& rivals, const SeparationWanted& wanted, unsigned threads) {
  if (bench.law == bench::DriveLaw::kTorque || runs.empty() || rivals.empty()) return {};
  Campaign campaign(bench, runs, rivals, wanted, threads);
  const std::map<std::size_t, int> chosen = campaign.choose();
  AskedFor asked{std::nullopt, campaign.same_here()};
  if (chosen.empty()) return asked;
  NextExcitation next;
  next.pairs = campaign.expected();
  for (const ExpectedPair& pair : next.pairs) {
    add_once(next.tells_apart, pair.first);
    add_once(next.tells_apart, pair.second);
  }
  std::size_t number = first_number(bench);
  for (const auto& [c, times] : chosen) next.runs.push_back(next_run(bench, campaign.candidate(c), times, number++));
  next.text = text_of(next, wanted.deviations);
  asked.next = std::move(next);
  return asked;
}

void unite(const std::vector<std::pair<std::string, std::string>>& same_here, std::vector<Cause>& causes) {
  for (Cause& cause : causes) {
    for (const auto& [first, second] : same_here) {
      if (first == cause.effect && std::erase(cause.or_instead, second) > 0) cause.same_here.push_back(second);
    }
  }
}

}  // namespace pmg::diagnosis
