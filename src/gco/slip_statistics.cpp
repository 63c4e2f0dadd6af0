#include "gco/slip_statistics.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::gco {

namespace {

constexpr double kBin_m_s = 1e-4;
constexpr std::size_t kBins = 20001;  // to 2 m/s, more than in any walk; faster slip counts as the largest seen

std::size_t bin_of(double slip_m_s) noexcept {
  return static_cast<std::size_t>(std::min(slip_m_s / kBin_m_s, static_cast<double>(kBins - 1)));
}

}  // namespace

SlipStatistics::SlipStatistics() : double_support_histogram_(kBins, 0) {}

void SlipStatistics::add(const Reference& reference, const Result& result) noexcept {
  const bool left = reference.contact[kLeft];
  const bool right = reference.contact[kRight];
  if (result.status == Status::kNotConverged) {
    ++extremes_.not_converged_ticks;
    return;
  }
  if (result.status == Status::kNotAsked || (!left && !right)) return;
  add_heights(left, right, result);
  if (reference.gain == 0.0) return;
  for (const Foot foot : {kLeft, kRight}) {
    if (!reference.contact[foot]) continue;
    before_sum_m_s_ += result.foot[foot].before_m_s;
    after_sum_m_s_ += result.foot[foot].after_m_s;
    ++stance_samples_;
  }
  if (!(left && right)) {
    ++extremes_.single_support_ticks;
    extremes_.single_support_max_m_s =
        std::max(extremes_.single_support_max_m_s, result.foot[left ? kLeft : kRight].after_m_s);
    return;
  }
  ++extremes_.double_support_ticks;
  for (const FootSlip& foot : result.foot) {
    double_support_sum_m_s_ += foot.after_m_s;
    double_support_max_m_s_ = std::max(double_support_max_m_s_, foot.after_m_s);
    ++double_support_histogram_[bin_of(foot.after_m_s)];
    ++double_support_samples_;
  }
}

void SlipStatistics::add_heights(bool left, bool right, const Result& result) noexcept {
  const double left_m = result.foot[kLeft].height_m;
  const double right_m = result.foot[kRight].height_m;
  const double lower_m = left && right ? std::min(left_m, right_m) : (left ? left_m : right_m);
  extremes_.lower_foot_height_max_m = std::max(extremes_.lower_foot_height_max_m, std::abs(lower_m));
  if (left && right) {
    extremes_.other_foot_height_max_m =
        std::max(extremes_.other_foot_height_max_m, std::abs(std::max(left_m, right_m)));
  }
}

SlipSummary SlipStatistics::summary() const noexcept {
  SlipSummary summary = extremes_;
  if (stance_samples_ > 0) {
    summary.before_mean_m_s = before_sum_m_s_ / static_cast<double>(stance_samples_);
    summary.after_mean_m_s = after_sum_m_s_ / static_cast<double>(stance_samples_);
  }
  if (double_support_samples_ > 0) {
    summary.double_support_mean_m_s = double_support_sum_m_s_ / static_cast<double>(double_support_samples_);
    summary.double_support_p95_m_s = p95_m_s();
  }
  return summary;
}

double SlipStatistics::p95_m_s() const noexcept {
  const auto rank = static_cast<std::int64_t>(std::ceil(0.95 * static_cast<double>(double_support_samples_)));
  std::int64_t seen = 0;
  for (std::size_t bin = 0; bin + 1 < kBins; ++bin) {
    seen += double_support_histogram_[bin];
    if (seen >= rank) return std::min(static_cast<double>(bin + 1) * kBin_m_s, double_support_max_m_s_);
  }
  return double_support_max_m_s_;
}

}  // namespace pmg::gco
