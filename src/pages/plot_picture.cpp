#include "pages/plot_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "pages/line_data.hpp"
#include "pages/svg_parts.hpp"
#include "pages/text.hpp"

namespace pmg::pages {

namespace {

constexpr int kWidth = 640, kLeft = 58, kRight = 14, kTop = 8, kAxis = 38, kLegend = 18;
constexpr std::size_t kColumns = 280;  // of a line: two points each are all that can be seen
constexpr double kMargin = 0.04;       // of the range of y, above and below
constexpr const char* kStyle =
    "text{font:12px sans-serif;fill:#1b1f24}.grid{stroke:#e6e9ed}.tick{text-anchor:middle}.name{text-anchor:end}";

/// One axis: from values to the picture's units.
struct Axis {
  double from, to, at_from, at_to;
  bool logarithmic;
  double in_range(double value) const { return logarithmic ? std::log10(value) : value; }
  bool shows(double value) const { return std::isfinite(value) && (!logarithmic || value > 0.0); }
  double operator()(double value) const { return at_from + (in_range(value) - from) / (to - from) * (at_to - at_from); }
};

Axis axis(bool logarithmic, double at_from, double at_to) {
  return {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), at_from, at_to,
          logarithmic};
}

void include(Axis& axis, double value) {
  if (!axis.shows(value)) return;
  axis.from = std::min(axis.from, axis.in_range(value));
  axis.to = std::max(axis.to, axis.in_range(value));
}

void widen(Axis& axis, double margin) {
  if (!(axis.from <= axis.to)) axis.from = 0.0, axis.to = 1.0;
  const double span = axis.to > axis.from ? axis.to - axis.from : std::max(1e-12, std::abs(axis.from));
  axis.from -= margin * span;
  axis.to += (axis.to > axis.from ? margin : 1.0) * span;
}

std::vector<double> ticks(const Axis& axis, int count) {
  std::vector<double> values;
  if (axis.logarithmic) {
    for (double decade = std::ceil(axis.from); decade <= axis.to; decade += 1.0) {
      values.push_back(std::pow(10.0, decade));
    }
    return values;
  }
  const double step = tick_step(axis.to - axis.from, count);
  for (double k = std::ceil(axis.from / step); k * step <= axis.to + 1e-9 * step; k += 1.0) values.push_back(k * step);
  return values;
}

void check(const PlotLine& line) {
  if (line.x.size() != line.y.size()) throw std::invalid_argument("a plot's line needs one y for each x");
  if (!line.intervals.empty() && line.intervals.size() != line.y.size()) {
    throw std::invalid_argument("a plot's line needs one interval for each y");
  }
}

/// Where the line has more points than can be seen: its extremes.
LineData seen(const PlotLine& line) {
  const bool sorted = std::ranges::is_sorted(line.x);
  if (sorted && line.intervals.empty()) {
    return decimate(line.x, {line.y}, kColumns, std::numeric_limits<double>::infinity());
  }
  return {{line.x.begin(), line.x.end()}, {{line.y.begin(), line.y.end()}}};
}

std::string path(const PlotLine& line, const LineData& data, const Axis& x, const Axis& y) {
  std::string d;
  bool drawing = false;
  double last_y = 0.0;
  for (std::size_t i = 0; i < data.x.size(); ++i) {
    if (!x.shows(data.x[i]) || !y.shows(data.y[0][i])) {
      drawing = false;
      continue;
    }
    const double px = x(data.x[i]), py = y(data.y[0][i]);
    if (drawing && line.stepped && std::abs(py - last_y) > 0.05) d += fmt::format("H{:.1f}", px);
    d += fmt::format("{}{:.1f} {:.1f}", drawing ? 'L' : 'M', px, py);
    drawing = true;
    last_y = py;
  }
  return d;
}

std::string content(const Plot& plot, int top) {
  const int bottom = top + kTop + plot.height_px;
  Axis x = axis(plot.logarithmic_x, kLeft, kWidth - kRight), y = axis(plot.logarithmic_y, bottom, top + kTop);
  std::vector<LineData> lines;
  for (const PlotLine& line : plot.lines) {
    check(line);
    lines.push_back(seen(line));
    for (const double value : lines.back().x) include(x, value);
    for (const double value : lines.back().y[0]) include(y, value);
    for (const Interval& interval : line.intervals) include(y, interval.lower), include(y, interval.upper);
  }
  if (plot.show_zero && !plot.logarithmic_y) include(y, 0.0);
  widen(x, 0.0);
  widen(y, kMargin);

  std::string out;
  const auto add = std::back_inserter(out);
  for (const double tick : ticks(y, std::max(6, plot.height_px / 30))) {
    fmt::format_to(add, R"(<path class="grid" d="M{} {:.1f}H{}"/><text class="name" x="{}" y="{:.1f}">{}</text>)",
                   kLeft, y(tick), kWidth - kRight, kLeft - 6, y(tick) + 4, number(tick));
  }
  for (const double tick : ticks(x, 8)) {
    fmt::format_to(add, R"(<path class="grid" d="M{0:.1f} {1}V{2}"/><text class="tick" x="{0:.1f}" y="{3}">{4}</text>)",
                   x(tick), top + kTop, bottom, bottom + 15, number(tick));
  }
  fmt::format_to(add, R"(<text class="tick" x="{}" y="{}">{}</text>)", (kLeft + kWidth - kRight) / 2, bottom + 31,
                 escape_html(plot.x_name));
  if (plot.show_zero && !plot.logarithmic_y && y.from < 0.0 && y.to > 0.0) {
    fmt::format_to(add, R"(<path d="M{} {:.1f}H{}" stroke="{}"/>)", kLeft, y(0.0), kWidth - kRight, colour::kGrey);
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const PlotLine& line = plot.lines[i];
    for (std::size_t k = 0; k < line.intervals.size(); ++k) {
      const auto [lower, upper] = line.intervals[k];
      if (!x.shows(line.x[k]) || !y.shows(lower) || !y.shows(upper)) continue;
      fmt::format_to(add, R"(<path d="M{:.1f} {:.1f}V{:.1f}" stroke="{}"/>)", x(line.x[k]), y(lower), y(upper),
                     line.colour);
    }
    if (line.points) {
      for (std::size_t k = 0; k < lines[i].x.size(); ++k) {
        if (!x.shows(lines[i].x[k]) || !y.shows(lines[i].y[0][k])) continue;
        fmt::format_to(add, R"(<circle cx="{:.1f}" cy="{:.1f}" r="2.2" fill="{}"/>)", x(lines[i].x[k]),
                       y(lines[i].y[0][k]), line.colour);
      }
      if (!line.joined) continue;
    }
    fmt::format_to(add, R"(<path d="{}" fill="none" stroke="{}" stroke-width="{}"{}/>)", path(line, lines[i], x, y),
                   line.colour, line.width_px, line.dashed ? R"( stroke-dasharray="5 4")" : "");
  }
  for (const Mark& mark : plot.marks) {
    fmt::format_to(
        add, R"(<path d="M{0:.1f} {1}V{2}" stroke="{3}" stroke-dasharray="4 3"/><text x="{4:.1f}" y="{5}">{6}</text>)",
        x(mark.x), top + kTop, bottom, colour::kInk, x(mark.x) + 4, top + kTop + 12, escape_html(mark.text));
  }
  double at = kLeft;
  for (const PlotLine& line : plot.lines) {
    if (line.name.empty()) continue;
    out += legend_entry(at, bottom + kAxis + 12, line.colour, line.name);
    at += 34.0 + 7.2 * static_cast<double>(line.name.size());
  }
  return out;
}

int height(const Plot& plot) {
  const bool named = std::ranges::any_of(plot.lines, [](const PlotLine& line) { return !line.name.empty(); });
  return kTop + plot.height_px + kAxis + (named ? kLegend : 0);
}

}  // namespace

std::string svg(const Plot& plot) {
  return fmt::format(R"(<svg viewBox="0 0 {} {}" style="max-width:{}px" role="img" aria-label="{}">)", kWidth,
                     height(plot), kWidth, escape_html(plot.title)) +
         content(plot, 0) + "</svg>";
}

std::string svg_file(const Plot& plot) { return svg_file(std::vector<Plot>{plot}); }

std::string svg_file(const std::vector<Plot>& plots) {
  constexpr int kTitle = 20;
  std::string body;
  int top = 0;
  for (const Plot& plot : plots) {
    body += fmt::format(R"(<text x="{}" y="{}" style="font-weight:bold">{}</text>)", kLeft, top + 15,
                        escape_html(plot.title));
    body += content(plot, top + kTitle);
    top += kTitle + height(plot) + 4;
  }
  return fmt::format(R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {1}" width="{0}" height="{1}">)"
                     R"(<style>{2}</style><rect width="{0}" height="{1}" fill="#fff"/>)",
                     kWidth, top, kStyle) +
         body + "</svg>\n";
}

}  // namespace pmg::pages
