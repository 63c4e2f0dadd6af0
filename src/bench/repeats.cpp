#include "bench/repeats.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "fitting/statistics.hpp"

namespace pmg::bench {

namespace {

constexpr double kSameCommand = 1e-3;  // share of the command's range: files round
constexpr double kSlow_s = 0.5;        // longer than a period of a drive that hunts, shorter than most faults

using Design = std::tuple<std::string, double, double, double, double>;

Design design(const BenchRun& run) {
  return {run.trajectory, run.kp, run.kd, run.load.inertia_kg_m2, run.load.gravity_Nm};
}

/// A signal's squares, and those of its half-second means.
class SlowAndFast {
 public:
  void add(double t_s, double value) {
    if (piece_samples_ > 0.0 && t_s >= piece_end_s_) end_piece();
    if (piece_samples_ == 0.0) piece_end_s_ = t_s + kSlow_s;
    piece_sum_ += value;
    piece_samples_ += 1.0;
    squares_ += value * value;
  }
  void end_piece() {
    if (piece_samples_ > 0.0) slow_squares_ += piece_sum_ * piece_sum_ / piece_samples_;
    piece_sum_ = piece_samples_ = 0.0;
  }
  double squares() const { return squares_; }
  double slow_share() const { return squares_ > 0.0 ? slow_squares_ / squares_ : 0.0; }
  double fast_squares() const { return std::max(0.0, squares_ - slow_squares_); }

 private:
  double piece_end_s_ = 0.0, piece_sum_ = 0.0, piece_samples_ = 0.0, slow_squares_ = 0.0, squares_ = 0.0;
};

bool of_one_condition(const Condition& condition, const std::vector<const BenchRun*>& runs, const BenchRun& run) {
  const bool other_repeats = std::all_of(condition.runs.begin(), condition.runs.end(),
                                         [&](std::size_t i) { return runs[i]->repeat != run.repeat; });
  return other_repeats && same_command(runs[condition.runs.front()]->recording, run.recording);
}

}  // namespace

bool same_command(const Recording& a, const Recording& b) {
  const std::size_t count = std::min(a.q_cmd_rad.size(), b.q_cmd_rad.size());
  const auto [low, high] = std::minmax_element(a.q_cmd_rad.begin(), a.q_cmd_rad.end());
  const double most_rad = kSameCommand * (*high - *low);
  std::size_t apart = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const auto near = [&](std::size_t other) { return std::abs(a.q_cmd_rad[k] - b.q_cmd_rad[other]) <= most_rad; };
    if (!near(k) && !(k > 0 && near(k - 1)) && !(k + 1 < count && near(k + 1))) ++apart;
  }
  return 3 * apart < count;  // a different command differs nearly everywhere
}

RunPair compared(const std::vector<const BenchRun*>& runs, std::size_t first, std::size_t second) {
  const Recording &a = runs[first]->recording, &b = runs[second]->recording;
  RunPair pair{.first = first, .second = second};
  pair.identical = a.q_rad == b.q_rad;
  SlowAndFast difference, here, there;
  double absolutes_rad = 0.0;
  std::size_t later = 1;
  for (std::size_t k = 0; k < a.t_s.size(); ++k) {
    const double t_s = a.t_s[k] - a.t_s.front() + b.t_s.front();
    while (later + 1 < b.t_s.size() && b.t_s[later] < t_s) ++later;
    if (t_s > b.t_s.back() || !a.valid[k] || !b.valid[later] || !b.valid[later - 1]) continue;
    const double share = std::clamp((t_s - b.t_s[later - 1]) / (b.t_s[later] - b.t_s[later - 1]), 0.0, 1.0);
    const double there_rad = b.q_rad[later - 1] + share * (b.q_rad[later] - b.q_rad[later - 1]);
    difference.add(t_s, a.q_rad[k] - there_rad);
    here.add(t_s, a.q_rad[k]);
    there.add(t_s, there_rad);
    absolutes_rad += std::abs(a.q_rad[k] - there_rad);
    ++pair.samples;
  }
  if (pair.samples == 0) return pair;
  for (SlowAndFast* signal : {&difference, &here, &there}) signal->end_piece();
  pair.mean_absolute_rad = absolutes_rad / static_cast<double>(pair.samples);
  pair.mean_square_rad2 = difference.squares() / static_cast<double>(pair.samples);
  pair.slow_share = difference.slow_share();
  const auto [less, more] = std::minmax({here.fast_squares(), there.fast_squares()});  // values, not references
  pair.fast_ratio = more > 0.0 ? std::sqrt(less / more) : 1.0;
  return pair;
}

double usual_difference_rad(const Condition& condition) {
  std::vector<double> differences;
  for (const RunPair& pair : condition.pairs) {
    if (!pair.identical) differences.push_back(std::sqrt(pair.mean_square_rad2));
  }
  if (differences.empty()) return 0.0;
  const std::size_t half = condition.runs.size() / 2 + 1;
  return fitting::value_at_rank(differences, std::min(half * (half - 1) / 2, differences.size()) - 1);
}

std::vector<Condition> conditions(const std::vector<const BenchRun*>& runs) {
  std::map<Design, std::vector<Condition>> designs;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::vector<Condition>& of_design = designs[design(*runs[i])];
    const auto mine = std::find_if(of_design.begin(), of_design.end(),
                                   [&](const Condition& one) { return of_one_condition(one, runs, *runs[i]); });
    if (mine == of_design.end())
      of_design.push_back({{i}, {}});
    else
      mine->runs.push_back(i);
  }
  std::vector<Condition> found;
  for (auto& [key, of_design] : designs) {
    for (Condition& condition : of_design) {
      for (std::size_t a = 0; a < condition.runs.size(); ++a) {
        for (std::size_t b = a + 1; b < condition.runs.size(); ++b) {
          const RunPair pair = compared(runs, condition.runs[a], condition.runs[b]);
          if (pair.samples > 0) condition.pairs.push_back(pair);
        }
      }
      found.push_back(std::move(condition));
    }
  }
  return found;
}

}  // namespace pmg::bench
