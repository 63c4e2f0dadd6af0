#include "pages/plot_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "pages/axis.hpp"
#include "pages/line_data.hpp"
#include "pages/svg_parts.hpp"
#include "pages/text.hpp"

namespace pmg::pages {

namespace {

constexpr int kNarrowestLeft = 58, kRightEdge = 14;
constexpr std::size_t kColumns = 280;  // of a line: a reader can see at most two points in each
constexpr double kRangeMargin = 0.04;  // of the range of y, above and below
constexpr int kLabelsAlongX = 6;       // along x: far enough apart for long ones
constexpr const char* kStyle =
    "text{font:12px sans-serif;fill:#1b1f24}.grid{stroke:#e6e9ed}.tick{text-anchor:middle}.name{text-anchor:end}";

/// One axis: from values to the picture's units.
struct Axis {
  bool logarithmic = false;
  Range range = Range::empty();  ///< of values, or of their common logarithms
  double at_from = 0.0, at_to = 1.0;

  double in_range(double value) const { return logarithmic ? std::log10(value) : value; }
  bool shows(double value) const { return can_be_shown(value) && (!logarithmic || value > 0.0); }
  void include(double value) {
    if (shows(value)) range.include(in_range(value));
  }
  double operator()(double value) const {
    return at_from + (in_range(value) - range.from) / range.span() * (at_to - at_from);
  }
  std::vector<AxisTick> ticks(int count) const {
    return logarithmic ? logarithmic_ticks(range, count) : axis_ticks(range, count);
  }
};

void check(const PlotLine& line) {
  if (line.x.size() != line.y.size()) throw std::invalid_argument("a plot's line needs one y for each x");
  if (!line.intervals.empty() && line.intervals.size() != line.y.size()) {
    throw std::invalid_argument("a plot's line needs one interval for each y");
  }
}

/// The extremes of each column, for a line with more points than a reader can see.
LineData seen(const PlotLine& line) {
  const bool sorted = std::ranges::is_sorted(line.x);
  if (sorted && line.intervals.empty()) {
    return decimate(line.x, {line.y}, kColumns, std::numeric_limits<double>::infinity());
  }
  return {{line.x.begin(), line.x.end()}, {{line.y.begin(), line.y.end()}}};
}

class PlotDrawing {
 public:
  PlotDrawing(const Plot& plot, int top) : plot_(plot), top_(top + kTop), bottom_(top_ + plot.height_px) {
    x_.logarithmic = plot.logarithmic_x;
    y_.logarithmic = plot.logarithmic_y;
    for (const PlotLine& line : plot.lines) {
      check(line);
      lines_.push_back(seen(line));
      for (std::size_t k = 0; k < lines_.back().x.size(); ++k) include(lines_.back().x[k], lines_.back().y[0][k]);
      for (const Interval& interval : line.intervals) y_.include(interval.lower), y_.include(interval.upper);
    }
    for (const Mark& mark : plot.marks) x_.include(mark.x);
    for (const Band& band : plot.bands) x_.include(band.from), x_.include(band.to);
    if (plot.show_zero && !plot.logarithmic_y) y_.include(0.0);
    x_.range = shown_range(x_.range, 0.0);
    y_.range = shown_range(y_.range, kRangeMargin);
    y_ticks_ = y_.ticks(std::max(4, plot.height_px / 30));
    double widest = 0.0;
    for (const AxisTick& tick : y_ticks_) widest = std::max(widest, text_width(tick.label));
    left_ = std::max(kNarrowestLeft, static_cast<int>(std::ceil(widest)) + 10);
    x_.at_from = left_;
    x_.at_to = kPictureWidth - kRightEdge;
    y_.at_from = bottom_;
    y_.at_to = top_;
  }

  std::string svg() {
    for (const Band& band : plot_.bands) show(band);
    axes();
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      intervals(plot_.lines[i]);
      if (plot_.lines[i].joined) line(plot_.lines[i], lines_[i]);
      dots(plot_.lines[i], lines_[i]);
    }
    for (const Mark& mark : plot_.marks) show(mark);
    return out_ + legend().svg(bottom_ + kAxisHeight);
  }

  int end() const { return bottom_ + kAxisHeight + legend().height(); }  ///< where the next picture may begin

 private:
  void include(double x, double y) {
    x_.include(x);
    if (x_.shows(x)) y_.include(y);
  }

  template <typename... T>
  void add(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<T>(values)...);
  }

  void axes() {
    for (const AxisTick& tick : y_ticks_) {
      const double at = y_(tick.value);
      add(R"(<path class="grid" d="M{} {:.1f}H{}"/><text class="name" x="{}" y="{:.1f}">{}</text>)", left_, at,
          kPictureWidth - kRightEdge, left_ - 6, at + 4, tick.label);
    }
    for (const AxisTick& tick : x_.ticks(kLabelsAlongX)) {
      add(R"(<path class="grid" d="M{0:.1f} {1}V{2}"/><text class="tick" x="{0:.1f}" y="{3}">{4}</text>)",
          x_(tick.value), top_, bottom_, bottom_ + 15, tick.label);
    }
    add(R"(<text class="tick" x="{}" y="{}">{}</text>)", (left_ + kPictureWidth - kRightEdge) / 2, bottom_ + 31,
        escape_markup(plot_.x_name));
    if (plot_.show_zero && !y_.logarithmic) {
      add(R"(<path d="M{} {:.1f}H{}" stroke="{}"/>)", left_, y_(0.0), kPictureWidth - kRightEdge, colour::kGrey);
    }
  }

  void intervals(const PlotLine& line) {
    for (std::size_t k = 0; k < line.intervals.size(); ++k) {
      const auto [lower, upper] = line.intervals[k];
      if (!x_.shows(line.x[k]) || !y_.shows(lower) || !y_.shows(upper)) continue;
      add(R"(<path d="M{:.1f} {:.1f}V{:.1f}" stroke="{}"/>)", x_(line.x[k]), y_(lower), y_(upper), line.colour);
    }
  }

  bool shown(const LineData& data, std::size_t k) const {
    return k < data.x.size() && x_.shows(data.x[k]) && y_.shows(data.y[0][k]);
  }

  /// Dots: at each point if the line has `points`, else only at single points between gaps, which no line would show.
  void dots(const PlotLine& line, const LineData& data) {
    for (std::size_t k = 0; k < data.x.size(); ++k) {
      const bool alone = (k == 0 || !shown(data, k - 1)) && !shown(data, k + 1);
      if (!shown(data, k) || !(line.points || alone)) continue;
      add(R"(<circle cx="{:.1f}" cy="{:.1f}" r="2.2" fill="{}"/>)", x_(data.x[k]), y_(data.y[0][k]), line.colour);
    }
  }

  void line(const PlotLine& line, const LineData& data) {
    std::string d;
    bool drawing = false;
    double last_y = 0.0;
    for (std::size_t k = 0; k < data.x.size(); ++k) {
      if (!shown(data, k)) {
        drawing = false;
        continue;
      }
      const double px = x_(data.x[k]), py = y_(data.y[0][k]);
      if (drawing && line.stepped && std::abs(py - last_y) > 0.05) d += fmt::format("H{:.1f}", px);
      d += fmt::format("{}{:.1f} {:.1f}", drawing ? 'L' : 'M', px, py);
      drawing = true;
      last_y = py;
    }
    add(R"(<path class="line" d="{}" fill="none" stroke="{}" stroke-width="{}"{}/>)", d, line.colour, line.width_px,
        line.dashed ? R"( stroke-dasharray="5 4")" : "");
  }

  void show(const Mark& mark) {
    if (!x_.shows(mark.x)) return;
    const double at = x_(mark.x);
    const bool to_the_left = at + 4 + text_width(mark.text) > kPictureWidth;
    add(R"(<path d="M{0:.1f} {1}V{2}" stroke="{3}" stroke-dasharray="4 3"/>)", at, top_, bottom_, colour::kInk);
    add(R"(<text{} x="{:.1f}" y="{}">{}</text>)", to_the_left ? R"( class="name")" : "", at + (to_the_left ? -4 : 4),
        top_ + 12, escape_markup(mark.text));
  }

  void show(const Band& band) {
    if (!x_.shows(band.from) || !x_.shows(band.to)) return;
    const double from = x_(band.from), width = std::max(1.0, x_(band.to) - from);
    add(R"(<rect class="band" x="{:.1f}" y="{}" width="{:.1f}" height="{}" fill="{}"/>)", from, top_, width,
        bottom_ - top_, escape_markup(band.colour));
  }

  Legend legend() const {
    Legend legend(left_, kPictureWidth);
    for (const PlotLine& line : plot_.lines) {
      if (!line.name.empty()) legend.add(line.colour, line.name, line.dashed);
    }
    std::vector<std::string> shaded;
    for (const Band& band : plot_.bands) {
      if (band.name.empty() || std::ranges::find(shaded, band.name) != shaded.end()) continue;
      legend.add(band.colour, band.name);
      shaded.push_back(band.name);
    }
    return legend;
  }

  const Plot& plot_;
  int top_, bottom_, left_ = kNarrowestLeft;
  Axis x_, y_;
  std::vector<AxisTick> y_ticks_;
  std::vector<LineData> lines_;
  std::string out_;
};

}  // namespace

std::string svg(const Plot& plot) {
  PlotDrawing drawing(plot, 0);
  return fmt::format(R"(<svg viewBox="0 0 {0} {1}" style="max-width:{0}px" role="img" aria-label="{2}">)",
                     kPictureWidth, drawing.end(), escape_markup(plot.title)) +
         drawing.svg() + "</svg>";
}

std::string svg_file(const Plot& plot) { return svg_file(std::vector<Plot>{plot}); }

std::string svg_file(const std::vector<Plot>& plots) {
  constexpr int kTitle = 20;
  std::string body;
  int top = 0;
  for (const Plot& plot : plots) {
    body += fmt::format(R"(<text x="{}" y="{}" style="font-weight:bold">{}</text>)", kNarrowestLeft, top + 15,
                        escape_markup(plot.title));
    PlotDrawing drawing(plot, top + kTitle);
    body += drawing.svg();
    top = drawing.end() + 4;
  }
  return fmt::format(R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {1}" width="{0}" height="{1}">)"
                     R"(<style>{2}</style><rect width="{0}" height="{1}" fill="#fff"/>)",
                     kPictureWidth, top, kStyle) +
         body + "</svg>\n";
}

}  // namespace pmg::pages
