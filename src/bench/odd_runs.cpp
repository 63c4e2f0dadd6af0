#include "bench/odd_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>

#include "fitting/statistics.hpp"

namespace pmg::bench {

namespace {

using Indices = std::vector<std::size_t>;

double rms_rad(const RunPair& pair) { return std::sqrt(pair.mean_square_rad2); }

std::string thousandths(double value) { return fmt::format("{:.3g}e-3", 1e3 * value); }

/// (condition, longest link) => (groups of linked runs, the largest first).
std::vector<Indices> groups(const Condition& condition, double link_rad) {
  std::vector<Indices> found;
  for (const std::size_t run : condition.runs) found.push_back({run});
  for (const RunPair& pair : condition.pairs) {
    if (rms_rad(pair) > link_rad) continue;
    const auto of = [&](std::size_t run) {
      return std::find_if(found.begin(), found.end(), [&](const Indices& group) {
        return std::find(group.begin(), group.end(), run) != group.end();
      });
    };
    const auto one = of(pair.first), other = of(pair.second);
    if (one == other) continue;
    one->insert(one->end(), other->begin(), other->end());
    found.erase(other);
  }
  std::stable_sort(found.begin(), found.end(), [](const Indices& a, const Indices& b) { return a.size() > b.size(); });
  return found;
}

class OddRunSearch {
 public:
  OddRunSearch(const std::vector<const BenchRun*>& runs, const std::vector<Condition>& conditions,
               const OddRunOptions& options)
      : runs_(runs), conditions_(conditions), options_(options) {
    for (const Condition& condition : conditions) differences_rad_.push_back(usual_difference_rad(condition));
  }

  std::vector<OddRun> all() {
    for (std::size_t c = 0; c < conditions_.size(); ++c) {
      if (conditions_[c].runs.size() == 1)
        look_at_single(c);
      else
        look_at_repeats(c);
      name_copies(conditions_[c]);
    }
    std::stable_sort(found_.begin(), found_.end(), [](const OddRun& a, const OddRun& b) { return a.index < b.index; });
    return std::move(found_);
  }

 private:
  void name(std::size_t run, double deviation_rad, bool left_out, std::string why) {
    found_.push_back({run, runs_[run]->file, std::move(why), deviation_rad, left_out});
  }

  const BenchRun& run(std::size_t condition) const { return *runs_[conditions_[condition].runs.front()]; }

  /// The usual difference of repeats, by the other conditions; 0 where there are too few of them.
  double usual_elsewhere_rad(std::size_t c) const {
    using Like = std::function<bool(const BenchRun&, const BenchRun&)>;
    const Like likes[] = {[](const BenchRun&, const BenchRun&) { return true; },
                          [](const BenchRun& a, const BenchRun& b) { return a.trajectory == b.trajectory; },
                          [](const BenchRun& a, const BenchRun& b) { return a.kp == b.kp && a.kd == b.kd; },
                          [](const BenchRun& a, const BenchRun& b) {
                            return a.load.inertia_kg_m2 == b.load.inertia_kg_m2 &&
                                   a.load.gravity_Nm == b.load.gravity_Nm;
                          }};
    double most_rad = 0.0;
    for (const Like& like : likes) {
      std::vector<double> values_rad;
      for (std::size_t o = 0; o < conditions_.size(); ++o) {
        if (o != c && differences_rad_[o] > 0.0 && like(run(c), run(o))) values_rad.push_back(differences_rad_[o]);
      }
      if (static_cast<double>(values_rad.size()) < options_.fewest_conditions) continue;
      most_rad = std::max(most_rad, fitting::median(std::move(values_rad)));
    }
    return most_rad;
  }

  struct Apart {
    double rms_rad = 0.0;
    bool hunts = false;  ///< the difference is one of phases of an oscillation
  };
  /// (condition, two groups) => (how they differ, the median over pairs).
  Apart between(const Condition& condition, const Indices& one, const Indices& other) const {
    const auto in = [](const Indices& group, std::size_t run) {
      return std::find(group.begin(), group.end(), run) != group.end();
    };
    std::vector<double> differences, slow, fast;
    for (const RunPair& pair : condition.pairs) {
      const bool across =
          (in(one, pair.first) && in(other, pair.second)) || (in(other, pair.first) && in(one, pair.second));
      if (!across) continue;
      differences.push_back(rms_rad(pair));
      slow.push_back(pair.slow_share);
      fast.push_back(pair.fast_ratio);
    }
    return {fitting::median(differences),
            fitting::median(slow) < options_.slow_share && fitting::median(fast) > options_.fast_ratio};
  }

  static double widest_rad(const Condition& condition, const Indices& group) {
    double most = 0.0;
    for (const RunPair& pair : condition.pairs) {
      const auto in = [&](std::size_t run) { return std::find(group.begin(), group.end(), run) != group.end(); };
      if (in(pair.first) && in(pair.second)) most = std::max(most, rms_rad(pair));
    }
    return most;
  }

  void look_at_repeats(std::size_t c) {
    const Condition& condition = conditions_[c];
    const double elsewhere_rad = usual_elsewhere_rad(c);
    const double usual_rad = elsewhere_rad > 0.0 ? elsewhere_rad : differences_rad_[c];
    if (!(usual_rad > 0.0)) return;
    const std::vector<Indices> parts = groups(condition, options_.times_usual * usual_rad);
    if (parts.size() < 2) return;
    const Indices& largest = parts.front();
    const double agree_rad = std::max(usual_rad, widest_rad(condition, largest));
    if (2 * largest.size() > condition.runs.size()) {
      for (std::size_t p = 1; p < parts.size(); ++p) {
        for (const std::size_t odd : parts[p]) {
          const auto [away_rad, hunts] = between(condition, largest, {odd});
          const bool by_chance = hunts && agree_rad > options_.times_by_chance * usual_rad;
          if (by_chance || away_rad < options_.times_usual * agree_rad) continue;
          name(
              odd, away_rad, true,
              fmt::format("differs from {} other repeats of its condition by {} rms; they differ from each other by {} "
                          "at most",
                          largest.size(), thousandths(away_rad), thousandths(widest_rad(condition, largest))));
        }
      }
    } else if (parts.size() == 2) {
      look_at_halves(c, parts[0], parts[1], std::max(agree_rad, widest_rad(condition, parts[1])));
    }
  }

  /// Two groups of equal size: the other conditions decide.
  void look_at_halves(std::size_t c, const Indices& one, const Indices& other, double agree_rad) {
    const auto [away_rad, hunts] = between(conditions_[c], one, other);
    if (hunts || away_rad < options_.times_usual * agree_rad) return;  // the condition is merely noisy
    double nearer_one = 0.0, nearer_other = 0.0, all = 0.0;
    for (std::size_t o = 0; o < conditions_.size(); ++o) {
      if (o == c || !same_command(run(c).recording, run(o).recording)) continue;
      const double to_one = nearest_rad(one.front(), o), to_other = nearest_rad(other.front(), o);
      nearer_one += to_other > options_.times_nearer * to_one ? 1.0 : 0.0;
      nearer_other += to_one > options_.times_nearer * to_other ? 1.0 : 0.0;
      all += 1.0;
    }
    const double most = std::max(nearer_one, nearer_other);
    if (all >= options_.fewest_conditions && most >= options_.agreeing_share * all) {
      for (const std::size_t odd : nearer_one > nearer_other ? other : one) {
        name(odd, away_rad, true,
             fmt::format("differs by {} rms from as many other repeats of its condition; of {:.0f} conditions with the "
                         "same command {:.0f} are nearer to those",
                         thousandths(away_rad), all, most));
      }
      return;
    }
    for (const Indices* group : {&one, &other}) {
      for (const std::size_t odd : *group) {
        name(odd, away_rad, false,
             fmt::format("differs by {} rms from as many other repeats of its condition, {:.0f} times what repeats "
                         "usually do, and the other conditions don't say which of them is right",
                         thousandths(away_rad), away_rad / agree_rad));
      }
    }
  }

  double nearest_rad(std::size_t run, std::size_t condition) const {
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t other : conditions_[condition].runs) {
      const RunPair pair = compared(runs_, run, other);
      if (pair.samples > 0) least = std::min(least, rms_rad(pair));
    }
    return least;
  }

  /// Distance from a condition's first run to the second nearest other condition with the same command: the nearest may
  /// be odd in the same way. 0 where there are too few.
  double neighbours_rad(std::size_t c) {
    if (const auto known = neighbours_.find(c); known != neighbours_.end()) return known->second;
    std::vector<double> distances;
    for (std::size_t o = 0; o < conditions_.size(); ++o) {
      if (o != c && same_command(run(c).recording, run(o).recording))
        distances.push_back(nearest_rad(conditions_[c].runs.front(), o));
    }
    const bool enough = static_cast<double>(distances.size()) >= std::max(2, options_.fewest_conditions.value);
    return neighbours_[c] = enough ? fitting::value_at_rank(std::move(distances), 1) : 0.0;
  }

  void look_at_single(std::size_t c) {
    std::vector<double> others_rad;
    for (std::size_t o = 0; o < conditions_.size(); ++o) {
      if (o == c || !same_command(run(c).recording, run(o).recording)) continue;
      if (const double there_rad = neighbours_rad(o); there_rad > 0.0) others_rad.push_back(there_rad);
    }
    if (static_cast<double>(others_rad.size()) < options_.fewest_conditions) return;
    const double usual_rad = fitting::median(std::move(others_rad)), away_rad = neighbours_rad(c);
    if (away_rad < options_.times_neighbours * usual_rad) return;
    name(conditions_[c].runs.front(), away_rad, false,
         fmt::format("differs from all other runs with its command by {} rms or more; these differ from their nearest "
                     "by {}",
                     thousandths(away_rad), thousandths(usual_rad)));
  }

  void name_copies(const Condition& condition) {
    Indices copies;
    for (const RunPair& pair : condition.pairs) {
      if (!pair.identical || std::find(copies.begin(), copies.end(), pair.second) != copies.end()) continue;
      copies.push_back(pair.second);
      name(pair.second, 0.0, false,
           fmt::format("is a copy of {}: every reading agrees to the last bit, so it doesn't count as a repeat",
                       runs_[pair.first]->file));
    }
  }

  const std::vector<const BenchRun*>& runs_;
  const std::vector<Condition>& conditions_;
  const OddRunOptions& options_;
  std::vector<double> differences_rad_;
  std::map<std::size_t, double> neighbours_;  // neighbours_rad() of the conditions asked for
  std::vector<OddRun> found_;
};

}  // namespace

std::vector<OddRun> odd_runs(const std::vector<const BenchRun*>& runs, const std::vector<Condition>& conditions,
                             const OddRunOptions& options) {
  return OddRunSearch(runs, conditions, options).all();
}

}  // namespace pmg::bench
