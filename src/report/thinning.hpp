// (a recording of any length) => as many samples as pictures show.
#pragma once

#include <cstddef>
#include <vector>

namespace pmg::report {

/// Lines over one t_s that grow sample by sample. Beyond kMost samples neighbours become pairs: the smallest and the
/// largest finite value of every line, in their order of time, so that no peak is lost. Fewer samples stay as they are.
class Thinning {
 public:
  static constexpr std::size_t kMost = 1 << 15;  ///< ten times what a chart shows, five minutes of ticks

  /// The lines, which outlive this object or are named anew; all as long as t_s.
  struct Lines {
    std::vector<double>* t_s;
    std::vector<std::vector<double>*> wide;
    std::vector<std::vector<float>*> narrow;
  };

  /// After each new sample. A pause of t_s beyond longest_pause_s is never inside a pair.
  void appended(const Lines& lines, double longest_pause_s);

  /// The longest time between neighbours that is no pause [s]; 0: nothing was thinned.
  double widest_pair_s() const { return widest_s_; }

 private:
  void end_pair(const Lines& lines);
  void pair_pairs(const Lines& lines, double longest_pause_s);

  std::size_t ticks_ = 2;   ///< for a pair
  std::size_t closed_ = 0;  ///< samples in pairs; behind them those of the next one
  double widest_s_ = 0.0;
};

/// Values of which a distribution is shown. Beyond kMost of them every second one is left out, again and again.
class Sampled {
 public:
  static constexpr std::size_t kMost = 1 << 16;

  void add(double value);  ///< what isn't finite doesn't count

  const std::vector<double>& values() const { return values_; }
  double each() const { return static_cast<double>(stride_); }  ///< values that one of values() stands for
  double largest() const { return largest_; }                   ///< of all

 private:
  std::vector<double> values_;
  std::size_t stride_ = 1, skipped_ = 0;
  double largest_ = 0.0;
};

/// When a condition that is looked at tick by tick holds.
class Intervals {
 public:
  struct Interval {
    double from_s, to_s;  ///< the first tick in which it holds, the first in which it no longer does
  };

  /// Times must not decrease. A pause beyond longest_pause_s ends an interval.
  void add(double t_s, bool holds, double longest_pause_s);

  const std::vector<Interval>& all() const { return all_; }

 private:
  std::vector<Interval> all_;
  bool open_ = false;
  double newest_s_ = 0.0;
};

}  // namespace pmg::report
