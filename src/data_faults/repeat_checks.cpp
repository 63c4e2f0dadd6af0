#include "data_faults/repeat_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "bench/repeats.hpp"
#include "data_faults/shift_checks.hpp"
#include "data_faults/trajectory_checks.hpp"
#include "fitting/statistics.hpp"

namespace pmg::data_faults {

namespace {

using Indices = std::vector<std::size_t>;

constexpr std::size_t kFewestRepeats = 2;  // one that differs doesn't say which of the two is wrong

double rms_rad(const bench::RunPair& pair) { return std::sqrt(pair.mean_square_rad2); }

/// Median difference of a condition's pairs, one run left out.
double scatter_rad(const bench::Condition& condition, std::size_t without) {
  std::vector<double> differences;
  for (const bench::RunPair& pair : condition.pairs) {
    if (pair.first != without && pair.second != without && !pair.identical) differences.push_back(rms_rad(pair));
  }
  return differences.empty() ? std::numeric_limits<double>::infinity() : fitting::median(differences);
}

/// A run that is far from its repeats.
struct OddRepeat {
  std::size_t run = 0, condition = 0;
  Indices repeats;
  double away_rad = 0.0, scatter_rad = 0.0;  ///< median difference from them; theirs from each other
  bool explained = false;
};

class RepeatSearch {
 public:
  explicit RepeatSearch(const Examined& e) : e_(e) {
    for (const bench::BenchRun& run : e.runs()) pointers_.push_back(&run);
    conditions_ = bench::conditions(pointers_);
    find_odd();
  }

  std::vector<DataFault> faults() {
    std::vector<DataFault> found;
    for (OddRepeat& odd : odd_) {
      if (std::optional<DataFault> shift = shift_of(odd)) {
        odd.explained = true;
        found.push_back(*std::move(shift));
      }
    }
    for (std::size_t a = 0; a < odd_.size(); ++a) {
      for (std::size_t b = a + 1; b < odd_.size(); ++b) {
        OddRepeat &one = odd_[a], &other = odd_[b];
        if (one.explained || other.explained || !belongs(one, other.condition) || !belongs(other, one.condition))
          continue;
        one.explained = other.explained = true;
        found.push_back(swapped_runs(e_.runs()[one.run], e_.runs()[other.run],
                                     {agreement_text(one, other), agreement_text(other, one)}));
      }
    }
    return found;
  }

 private:
  void find_odd() {
    const DataFaultOptions& o = e_.options();
    std::vector<double> scatters;
    for (const bench::Condition& condition : conditions_) {
      if (condition.runs.size() > kFewestRepeats) scatters.push_back(bench::usual_difference_rad(condition));
    }
    if (scatters.empty()) return;
    const double usual_rad = fitting::median(scatters);
    for (std::size_t c = 0; c < conditions_.size(); ++c) {
      const bench::Condition& condition = conditions_[c];
      for (const std::size_t run : condition.runs) {
        OddRepeat odd{.run = run, .condition = c, .repeats = condition.runs};
        std::erase(odd.repeats, run);
        if (odd.repeats.size() < kFewestRepeats) continue;
        odd.scatter_rad = std::max(usual_rad, scatter_rad(condition, run));
        odd.away_rad = apart_rad(run, odd.repeats);
        if (odd.away_rad > o.clear_gain * odd.scatter_rad) odd_.push_back(std::move(odd));
      }
    }
  }

  /// Median difference of a run's readings, moved by lag_s, from those of others.
  double apart_rad(std::size_t run, const Indices& others, double lag_s = 0.0) const {
    bench::BenchRun moved = e_.runs()[run];
    bench::Recording& r = moved.recording;
    if (lag_s != 0.0) {
      r.q_rad = bench::shifted(r.t_s, r.q_rad, lag_s);
      for (std::size_t k = 0; k < r.t_s.size(); ++k) {
        if (r.t_s[k] + lag_s < r.t_s.front() || r.t_s[k] + lag_s > r.t_s.back()) r.valid[k] = false;
      }
    }
    std::vector<double> differences;
    for (const std::size_t other : others)
      differences.push_back(rms_rad(bench::compared({&moved, pointers_[other]}, 0, 1)));
    return fitting::median(differences);
  }

  double nearest_lag_s(std::size_t run, const Indices& others) const {
    double best_s = 0.0, least_rad = std::numeric_limits<double>::infinity();
    const auto look = [&](double around_s, double step_s, double reach_s) {
      const long steps = std::lround(reach_s / step_s);
      for (long k = -steps; k <= steps; ++k) {
        const double lag_s = around_s + static_cast<double>(k) * step_s, rad = apart_rad(run, others, lag_s);
        if (rad < least_rad) least_rad = rad, best_s = lag_s;
      }
    };
    const double step_s = std::max(0.004, e_.sample_s());
    look(0.0, step_s, e_.options().longest_shift_s);
    look(best_s, step_s / 8.0, step_s);
    return best_s;
  }

  /// Slower motion, of a cold joint say, is later by another time wherever it is faster: a shift leaves what repeats
  /// usually differ by.
  std::optional<DataFault> shift_of(const OddRepeat& odd) const {
    const DataFaultOptions& o = e_.options();
    const double lag_s = nearest_lag_s(odd.run, odd.repeats), after_rad = apart_rad(odd.run, odd.repeats, lag_s);
    // Hosts begin to send and to read up to two samples apart.
    const double least_s = std::max<double>(o.shift_samples * e_.sample_s(), o.least_shift_s);
    const bool sure = std::abs(lag_s) >= least_s && odd.away_rad > o.shift_gain * after_rad &&
                      after_rad < o.usual_error * odd.scatter_rad;
    if (!sure) return std::nullopt;
    return shifted_readings(
        e_, odd.run, lag_s,
        {fmt::format("its {} repeats differ from each other by {:.3g} {} rms; this run from them "
                     "by {:.3g} {}, and by {:.3g} {} moved",
                     odd.repeats.size(), odd.scatter_rad, unit(), odd.away_rad, unit(), after_rad, unit())});
  }

  /// The runs of a condition that agree.
  Indices agreeing(std::size_t condition) const {
    Indices found = conditions_[condition].runs;
    std::erase_if(found, [&](std::size_t run) {
      return std::ranges::any_of(odd_, [&](const OddRepeat& odd) { return odd.run == run; });
    });
    return found;
  }

  bool belongs(const OddRepeat& odd, std::size_t condition) const {
    const DataFaultOptions& o = e_.options();
    const Indices there = agreeing(condition);
    if (condition == odd.condition || there.size() < kFewestRepeats ||
        !bench::same_command(e_.runs()[odd.run].recording, e_.runs()[there.front()].recording))
      return false;
    const double there_rad = apart_rad(odd.run, there);
    return odd.away_rad > o.clear_gain * there_rad &&
           there_rad < o.usual_error * std::max(odd.scatter_rad, scatter_of(condition));
  }

  double scatter_of(std::size_t condition) const {
    const auto odd = std::ranges::find_if(odd_, [&](const OddRepeat& one) { return one.condition == condition; });
    return odd != odd_.end() ? odd->scatter_rad : 0.0;
  }

  std::string agreement_text(const OddRepeat& odd, const OddRepeat& partner) const {
    return fmt::format("{} differs by {:.3g} {} rms from its repeats, and by {:.3g} {} from those of {}",
                       e_.runs()[odd.run].file, odd.away_rad, unit(), apart_rad(odd.run, agreeing(partner.condition)),
                       unit(), e_.runs()[partner.run].file);
  }

  const char* unit() const { return e_.linear() ? "m" : "rad"; }

  const Examined& e_;
  std::vector<const bench::BenchRun*> pointers_;
  std::vector<bench::Condition> conditions_;
  std::vector<OddRepeat> odd_;
};

}  // namespace

std::vector<DataFault> repeat_faults(const Examined& examined) { return RepeatSearch(examined).faults(); }

}  // namespace pmg::data_faults
