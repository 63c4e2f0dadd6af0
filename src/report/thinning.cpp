#include "report/thinning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pmg::report {

namespace {

/// [from, to) of a line becomes two values at `out`: its smallest and its largest finite one in their order.
template <typename T>
void put_pair(std::vector<T>& line, std::size_t from, std::size_t to, std::size_t out) {
  std::size_t low = to, high = to;
  for (std::size_t i = from; i < to; ++i) {
    if (!std::isfinite(line[i])) continue;
    if (low == to || line[i] < line[low]) low = i;
    if (high == to || line[i] > line[high]) high = i;
  }
  if (low == to) low = high = from;  // none is finite
  const T first = line[std::min(low, high)], second = line[std::max(low, high)];
  line[out] = first;
  line[out + 1] = second;
}

void put_pair(const Thinning::Lines& lines, std::size_t from, std::size_t to, std::size_t out) {
  for (auto* line : lines.wide) put_pair(*line, from, to, out);
  for (auto* line : lines.narrow) put_pair(*line, from, to, out);
  const double first_s = (*lines.t_s)[from], second_s = (*lines.t_s)[to - 1];
  (*lines.t_s)[out] = first_s;
  (*lines.t_s)[out + 1] = second_s;
}

void cut(const Thinning::Lines& lines, std::size_t size) {
  for (auto* line : lines.wide) line->resize(size);
  for (auto* line : lines.narrow) line->resize(size);
  lines.t_s->resize(size);
}

}  // namespace

void Thinning::end_pair(const Lines& lines) {
  const std::size_t size = lines.t_s->size();
  if (size - closed_ > 2) {
    put_pair(lines, closed_, size, closed_);
    cut(lines, closed_ + 2);
  }
  closed_ = lines.t_s->size();
}

void Thinning::appended(const Lines& lines, double longest_pause_s) {
  std::vector<double>& t_s = *lines.t_s;
  if (ticks_ == 2 && t_s.size() < kMost) return;
  const std::size_t newest = t_s.size() - 1;
  if (ticks_ > 2 && newest > closed_ && t_s[newest] - t_s[newest - 1] > longest_pause_s) {
    // The pair ends before the pause: the newest sample is taken aside.
    std::vector<double> aside;
    for (auto* line : lines.wide) aside.push_back(line->back());
    for (auto* line : lines.narrow) aside.push_back(static_cast<double>(line->back()));
    const double newest_s = t_s.back();
    cut(lines, newest);
    end_pair(lines);
    std::size_t at = 0;
    for (auto* line : lines.wide) line->push_back(aside[at++]);
    for (auto* line : lines.narrow) line->push_back(static_cast<float>(aside[at++]));
    t_s.push_back(newest_s);
  }
  if (ticks_ > 2 && t_s.size() - closed_ >= ticks_) end_pair(lines);
  if (t_s.size() < kMost) return;
  pair_pairs(lines, std::max(longest_pause_s, 1.5 * widest_s_));
  // Pauses everywhere: a picture of so long a time does not show them.
  if (t_s.size() > kMost / 4 * 3) pair_pairs(lines, std::numeric_limits<double>::infinity());
  closed_ = t_s.size();
  ticks_ *= 2;
}

/// Two pairs become one unless a pause is between them.
void Thinning::pair_pairs(const Lines& lines, double longest_pause_s) {
  std::vector<double>& t_s = *lines.t_s;
  widest_s_ = 0.0;
  std::size_t out = 0;
  for (std::size_t from = 0, to = 0; from < t_s.size(); from = to) {
    to = from + 1;
    while (to < t_s.size() && to - from < 4 && t_s[to] - t_s[to - 1] <= longest_pause_s) ++to;
    if (to - from > 2) {
      put_pair(lines, from, to, out);
      widest_s_ = std::max(widest_s_, t_s[out + 1] - t_s[out]);
      out += 2;
      continue;
    }
    for (std::size_t i = from; i < to; ++i, ++out) {
      for (auto* line : lines.wide) (*line)[out] = (*line)[i];
      for (auto* line : lines.narrow) (*line)[out] = (*line)[i];
      t_s[out] = t_s[i];
    }
  }
  cut(lines, out);
}

void Sampled::add(double value) {
  if (!std::isfinite(value)) return;
  largest_ = values_.empty() ? value : std::max(largest_, value);
  if (++skipped_ < stride_) return;
  skipped_ = 0;
  values_.push_back(value);
  if (values_.size() < kMost) return;
  for (std::size_t i = 0; 2 * i < values_.size(); ++i) values_[i] = values_[2 * i];
  values_.resize(kMost / 2);
  stride_ *= 2;
}

void Intervals::add(double t_s, bool holds, double longest_pause_s) {
  if (t_s - newest_s_ > longest_pause_s) open_ = false;
  newest_s_ = t_s;
  if (open_) all_.back().to_s = t_s;
  if (holds && !open_) all_.push_back({t_s, t_s});
  open_ = holds;
}

}  // namespace pmg::report
