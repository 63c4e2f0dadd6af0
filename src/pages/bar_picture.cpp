#include "pages/bar_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "pages/histogram.hpp"
#include "pages/svg_parts.hpp"
#include "pages/text.hpp"

namespace pmg::pages {

namespace {

double largest_shown(const Bars& bars) {
  double largest = 0.0;
  const auto show = [&largest](double value) { largest = std::isfinite(value) ? std::max(largest, value) : largest; };
  for (const Bars::Set& set : bars.sets) {
    for (const double value : set.values) show(value);
    for (const Interval& interval : set.intervals) show(interval.upper);
  }
  for (const Mark& mark : bars.marks) show(mark.x);
  return largest;
}

/// A whisker through the middle of a bar; x in pixels.
std::string whisker(double from, double to, double y) {
  return fmt::format(
      R"(<path d="M{0:.1f} {2:.1f}H{1:.1f}M{0:.1f} {3:.1f}V{4:.1f}M{1:.1f} {3:.1f}V{4:.1f}" stroke="{5}" )"
      R"(stroke-width="1.2" fill="none"/>)",
      from, to, y, y - 3, y + 3, colour::kInk);
}

}  // namespace

std::string svg(const Bars& bars) {
  constexpr int kWidth = 640, kLeft = 190, kRight = 70, kAxis = 22;
  constexpr int kRoomyBars = 12;  // few enough for a number at each
  const int per_row = static_cast<int>(bars.sets.size());
  const bool numbered = per_row == 1 || per_row * static_cast<int>(bars.names.size()) <= kRoomyBars;
  const int bar = per_row == 1 ? 10 : numbered ? 14 : 7, row = per_row * bar + 7;
  const int legend = per_row > 1 ? 20 * per_row : 0;
  const int top_margin = bars.marks.empty() ? 6 : 18;
  const int height = top_margin + row * static_cast<int>(bars.names.size()) + kAxis + legend;
  const double largest = largest_shown(bars);
  const double full = largest > 0.0 ? largest : 1.0;
  const double scale = (kWidth - kLeft - kRight) / full;
  const int bottom = height - kAxis - legend;

  std::string out = fmt::format(R"(<svg viewBox="0 0 {} {}" style="max-width:{}px" role="img" aria-label="{}">)",
                                kWidth, height, kWidth, escape_html(bars.title));
  const auto add = std::back_inserter(out);
  const double step = tick_step(full, 5);
  for (double tick = 0.0; tick <= full * 1.0001; tick += step) {
    const double x = kLeft + tick * scale;
    fmt::format_to(add, R"(<path class="grid" d="M{:.1f} {}V{}"/><text class="tick" x="{:.1f}" y="{}">{}</text>)", x,
                   top_margin, bottom, x, bottom + 15, number(tick));
  }
  fmt::format_to(add, R"(<text x="{}" y="{}">{}</text>)", kWidth - kRight + 12, bottom + 15, escape_html(bars.unit));
  for (std::size_t i = 0; i < bars.names.size(); ++i) {
    const int y = top_margin + row * static_cast<int>(i) + 3;
    fmt::format_to(add, R"(<text class="name" x="{}" y="{}">{}</text>)", kLeft - 8, y + (row - 7) / 2 + 4,
                   escape_html(bars.names[i]));
    for (std::size_t set = 0; set < bars.sets.size(); ++set) {
      const double value = i < bars.sets[set].values.size() ? bars.sets[set].values[i] : std::nan("");
      if (!std::isfinite(value)) continue;
      const double length = std::max(0.0, value) * scale;
      const int top = y + static_cast<int>(set) * bar;
      fmt::format_to(add, R"(<rect x="{}" y="{}" width="{:.1f}" height="{}" fill="{}"/>)", kLeft, top, length, bar - 1,
                     bars.sets[set].colour);
      double end = kLeft + length;
      if (i < bars.sets[set].intervals.size()) {
        const auto [lower, upper] = bars.sets[set].intervals[i];
        if (std::isfinite(lower) && std::isfinite(upper)) {
          out += whisker(kLeft + std::max(0.0, lower) * scale, kLeft + std::max(0.0, upper) * scale,
                         top + 0.5 * (bar - 1));
          end = std::max(end, kLeft + upper * scale);
        }
      }
      if (numbered) fmt::format_to(add, R"(<text x="{:.1f}" y="{}">{}</text>)", end + 5, top + bar - 2, number(value));
    }
  }
  for (const Mark& mark : bars.marks) {
    const double x = kLeft + mark.x * scale;
    fmt::format_to(add,
                   R"(<path d="M{0:.1f} {1}V{2}" stroke="{3}" stroke-width="1.5" stroke-dasharray="4 3"/>)"
                   R"(<text class="tick" x="{0:.1f}" y="{4}">{5}</text>)",
                   x, top_margin, bottom, colour::kInk, top_margin - 5, escape_html(mark.text));
  }
  for (std::size_t set = 0; legend > 0 && set < bars.sets.size(); ++set) {
    out += legend_entry(kLeft, height - legend + 20 * static_cast<double>(set) + 16, bars.sets[set].colour,
                        bars.sets[set].name);
  }
  return out + "</svg>";
}

std::string svg(const Histogram& histogram) {
  constexpr int kWidth = 640, kPlot = 180, kLeft = 52, kRight = 16, kTop = 8, kAxis = 24, kBins = 60;
  const int height = kTop + kPlot + kAxis + 20 * static_cast<int>(histogram.sets.size());
  // The few values far beyond all others are told in words: they would press those into one bin.
  double from = 0.0, to = 0.0;
  for (const Histogram::Set& set : histogram.sets) {
    to = std::max(to, std::min(percentile(set.values, 0.999), 4.0 * percentile(set.values, 0.99)));
    from = std::min(from, percentile(set.values, 0.001));
  }
  if (!(to > from)) to = from + 1.0;
  std::vector<Bins> bins;
  double highest = 1.0;
  for (const Histogram::Set& set : histogram.sets) {
    bins.push_back(count(set.values, from, to, kBins));
    for (const std::int64_t n : bins.back().counts) highest = std::max(highest, static_cast<double>(n));
  }
  const double decades = std::max(1.0, std::ceil(std::log10(highest)));
  // Counts on a logarithmic axis, half a decade for a single one: rare long times are what one looks for.
  const auto y = [&](double n) {
    return n < 1.0 ? kTop + kPlot : kTop + kPlot * (1.0 - (std::log10(n) + 0.5) / (decades + 0.5));
  };
  const double scale = (kWidth - kLeft - kRight) / (to - from);

  std::string out = fmt::format(R"(<svg viewBox="0 0 {} {}" style="max-width:{}px" role="img" aria-label="{}">)",
                                kWidth, height, kWidth, escape_html(histogram.title));
  const auto add = std::back_inserter(out);
  for (int decade = 0; decade <= static_cast<int>(decades); ++decade) {
    const double at = y(std::pow(10.0, decade));
    fmt::format_to(add, R"(<path class="grid" d="M{} {:.1f}H{}"/><text class="name" x="{}" y="{:.1f}">{}</text>)",
                   kLeft, at, kWidth - kRight, kLeft - 6, at + 4, number(std::pow(10.0, decade)));
  }
  const double step = tick_step(to - from, 6);
  for (double tick = std::ceil(from / step) * step; tick <= to; tick += step) {
    fmt::format_to(add, R"(<text class="tick" x="{:.1f}" y="{}">{} {}</text>)", kLeft + (tick - from) * scale,
                   kTop + kPlot + 16, number(tick), escape_html(histogram.unit));
  }
  for (std::size_t set = 0; set < bins.size(); ++set) {
    const Bins& b = bins[set];
    std::string path = fmt::format("M{} {}", kLeft, kTop + kPlot);
    for (std::size_t i = 0; i < b.counts.size(); ++i) {
      fmt::format_to(std::back_inserter(path), "V{:.1f}H{:.1f}", y(static_cast<double>(b.counts[i])),
                     kLeft + static_cast<double>(i + 1) * b.width * scale);
    }
    fmt::format_to(add, R"(<path d="{}V{}Z" fill="{}" fill-opacity="0.45" stroke="{}"/>)", path, kTop + kPlot,
                   histogram.sets[set].colour, histogram.sets[set].colour);
    const std::span<const double> values = histogram.sets[set].values;
    const std::string beyond = b.above > 0 ? fmt::format(", {} beyond", b.above) : "";
    out += legend_entry(
        kLeft, kTop + kPlot + kAxis + 20.0 * static_cast<double>(set) + 14, histogram.sets[set].colour,
        fmt::format("{}: {} values, p50 {}, p99 {} {}{}", histogram.sets[set].name, b.total(),
                    number(percentile(values, 0.5)), number(percentile(values, 0.99)), histogram.unit, beyond));
  }
  return out + "</svg>";
}

}  // namespace pmg::pages
