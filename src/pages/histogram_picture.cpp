#include "pages/histogram_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "pages/axis.hpp"
#include "pages/histogram.hpp"
#include "pages/svg_parts.hpp"
#include "pages/text.hpp"

namespace pmg::pages {

namespace {

constexpr int kPlot = 180, kLeft = 58, kRight = 16, kBins = 60, kMostLabels = 6;
constexpr int kBottom = kTop + kPlot;

/// The range of a set without outliers. Outliers are the outermost thousandth, and values more than four times as far
/// from the median as the outermost hundredth.
Range bulk(std::span<const double> all) {
  constexpr double kFar = 4.0;
  std::vector<double> values;
  std::ranges::copy_if(all, std::back_inserter(values), can_be_shown);
  if (values.empty()) return Range::empty();
  const double middle = percentile(values, 0.5), low = percentile(values, 0.01), high = percentile(values, 0.99);
  Range range{percentile(values, 0.001), percentile(values, 0.999)};
  if (low < middle) range.from = std::max(range.from, middle - kFar * (middle - low));
  if (high > middle) range.to = std::min(range.to, middle + kFar * (high - middle));
  return range;
}

/// The range of all sets. It includes zero if zero is near.
Range histogram_range(const Histogram& histogram) {
  Range range = Range::empty();
  for (const Histogram::Set& set : histogram.sets) {
    const Range found = bulk(set.values);
    range.include(found.from);
    range.include(found.to);
  }
  if (!range.is_empty() && range.from > 0.0 && range.from <= range.span()) range.from = 0.0;
  if (!range.is_empty() && range.to < 0.0 && -range.to <= range.span()) range.to = 0.0;
  return shown_range(range, 0.0);
}

std::string summary(const Histogram::Set& set, const Bins& bins, const std::string& unit) {
  const std::int64_t finite = bins.total() - bins.not_finite;
  std::string text = finite > 0
                         ? fmt::format("{}: {} values, p50 {}, p99 {} {}", set.name, finite,
                                       number(percentile(set.values, 0.5)), number(percentile(set.values, 0.99)), unit)
                         : fmt::format("{}: no values", set.name);
  if (bins.below > 0) text += fmt::format(", {} below", bins.below);
  if (bins.above > 0) text += fmt::format(", {} beyond", bins.above);
  if (set.each > 1.0) text += fmt::format("; from one in {:.0f}, the largest of all {}", set.each, number(set.largest));
  if (bins.not_finite > 0) text += fmt::format(", {} not finite", bins.not_finite);
  return text;
}

}  // namespace

std::string svg(const Histogram& histogram) {
  const Range range = histogram_range(histogram);
  std::vector<Bins> bins;
  double highest = 1.0;
  Legend legend(kLeft, kPictureWidth);
  for (const Histogram::Set& set : histogram.sets) {
    bins.push_back(count(set.values, range.from, range.to, kBins));
    bins.back().multiply(set.each);
    for (const std::int64_t n : bins.back().counts) highest = std::max(highest, static_cast<double>(n));
    legend.add(set.colour, summary(set, bins.back(), histogram.unit));
  }
  const double decades = std::max(1.0, std::ceil(std::log10(highest)));
  // Counts on a logarithmic axis, half a decade for a count of one, because readers look for rare long times.
  const auto y = [&](double n) {
    return n < 1.0 ? kBottom : kTop + kPlot * (1.0 - (std::log10(n) + 0.5) / (decades + 0.5));
  };
  const auto x = [&](double value) {
    return kLeft + (value - range.from) / range.span() * (kPictureWidth - kLeft - kRight);
  };

  std::string out = fmt::format(R"(<svg viewBox="0 0 {0} {1}" style="max-width:{0}px" role="img" aria-label="{2}">)",
                                kPictureWidth, kBottom + kAxisHeight + legend.height(), escape_markup(histogram.title));
  const auto add = std::back_inserter(out);
  for (int decade = 0; decade <= static_cast<int>(decades); ++decade) {
    const double at = y(std::pow(10.0, decade));
    fmt::format_to(add, R"(<path class="grid" d="M{} {:.1f}H{}"/><text class="name" x="{}" y="{:.1f}">{}</text>)",
                   kLeft, at, kPictureWidth - kRight, kLeft - 6, at + 4, number(std::pow(10.0, decade)));
  }
  for (const AxisTick& tick : axis_ticks(range, kMostLabels)) {
    fmt::format_to(add, R"(<path class="grid" d="M{0:.1f} {1}V{2}"/><text class="tick" x="{0:.1f}" y="{3}">{4}</text>)",
                   x(tick.value), kTop, kBottom, kBottom + 16, tick.label);
  }
  fmt::format_to(add, R"(<text class="tick" x="{}" y="{}">{}</text>)", (kLeft + kPictureWidth - kRight) / 2,
                 kBottom + 31, escape_markup(histogram.unit));
  for (std::size_t set = 0; set < bins.size(); ++set) {
    const Bins& b = bins[set];
    std::string path = fmt::format("M{} {}", kLeft, kBottom);
    for (std::size_t i = 0; i < b.counts.size(); ++i) {
      fmt::format_to(std::back_inserter(path), "V{:.1f}H{:.1f}", y(static_cast<double>(b.counts[i])),
                     x(range.from + static_cast<double>(i + 1) * b.width));
    }
    fmt::format_to(add, R"(<path class="bins" d="{}V{}Z" fill="{}" fill-opacity="0.45" stroke="{}"/>)", path, kBottom,
                   histogram.sets[set].colour, histogram.sets[set].colour);
  }
  return out + legend.svg(kBottom + kAxisHeight) + "</svg>";
}

}  // namespace pmg::pages
