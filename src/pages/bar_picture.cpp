#include "pages/bar_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

#include "pages/axis.hpp"
#include "pages/svg_parts.hpp"
#include "pages/text.hpp"

namespace pmg::pages {

namespace {

constexpr int kTicksHeight = 22, kGap = 7;
constexpr double kLeastNames = 90.0, kMostNames = 270.0;
constexpr int kRoomyBars = 12;  // few enough for a number at each
constexpr int kFewLabels = 5;
constexpr int kMargin = 6, kMarkRow = 13;  // above the bars, and for each row of marks' words

double value_of(const Bars::Set& set, std::size_t row) {
  return row < set.values.size() && can_be_shown(set.values[row]) ? set.values[row]
                                                                  : std::numeric_limits<double>::quiet_NaN();
}

/// The shown range. It includes zero, where bars begin.
Range bar_range(const Bars& bars) {
  Range range{0.0, 0.0};
  for (const Bars::Set& set : bars.sets) {
    for (const double value : set.values) range.include(value);
    for (const Interval& interval : set.intervals) range.include(interval.lower), range.include(interval.upper);
  }
  for (const Mark& mark : bars.marks) range.include(mark.x);
  return range.span() > 0.0 ? range : Range{0.0, 1.0};
}

class BarDrawing {
 public:
  explicit BarDrawing(const Bars& bars)
      : bars_(bars),
        range_(bar_range(bars)),
        numbered_(bars.sets.size() <= 1 || bars.sets.size() * bars.names.size() <= kRoomyBars),
        bar_(bars.sets.size() <= 1 ? 10
             : numbered_           ? 14
                                   : 7),
        row_(bar_ * static_cast<int>(std::max<std::size_t>(bars.sets.size(), 1)) + kGap) {
    double names = kLeastNames, widest = 0.0;
    for (const std::string& name : bars.names) names = std::max(names, text_width(name));
    for (const Bars::Set& set : bars.sets) {
      for (const double value : set.values) widest = std::max(widest, text_width(number(value)));
    }
    names_ = std::min(names, kMostNames) + 12.0;
    const double beside = numbered_ ? widest + 10.0 : 10.0;
    from_px_ = names_ + (range_.from < 0.0 ? beside : 0.0);
    to_px_ = kPictureWidth - std::max(beside, text_width(bars.unit) + 34.0);
    place_marks();
    top_ = kMargin + kMarkRow * mark_rows_;
    bottom_ = top_ + row_ * static_cast<int>(bars.names.size());
  }

  std::string svg() {
    const Legend names = legend();
    out_ = fmt::format(R"(<svg viewBox="0 0 {0} {1}" style="max-width:{0}px" role="img" aria-label="{2}">)",
                       kPictureWidth, bottom_ + kTicksHeight + names.height(), escape_markup(bars_.title));
    axis();
    for (std::size_t row = 0; row < bars_.names.size(); ++row) {
      name(row);
      for (std::size_t set = 0; set < bars_.sets.size(); ++set) bar(row, set);
    }
    if (range_.from < 0.0) add(R"(<path d="M{:.1f} {}V{}" stroke="{}"/>)", x(0.0), top_, bottom_, colour::kInk);
    for (const PlacedMark& mark : marks_) show(mark);
    out_ += numbers_;  // on top of the marks' lines
    return out_ + names.svg(bottom_ + kTicksHeight) + "</svg>";
  }

 private:
  double x(double value) const { return from_px_ + (value - range_.from) / range_.span() * (to_px_ - from_px_); }

  template <typename... T>
  void add(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<T>(values)...);
  }

  void axis() {
    for (const AxisTick& tick : axis_ticks(range_, kFewLabels)) {
      add(R"(<path class="grid" d="M{0:.1f} {1}V{2}"/><text class="tick" x="{0:.1f}" y="{3}">{4}</text>)",
          x(tick.value), top_, bottom_, bottom_ + 15, tick.label);
    }
    add(R"(<text x="{:.1f}" y="{}">{}</text>)", to_px_ + 20.0, bottom_ + 15, escape_markup(bars_.unit));
  }

  void name(std::size_t row) {
    const std::string shown = fitted(bars_.names[row], kMostNames);
    const std::string whole = shown == bars_.names[row] ? "" : "<title>" + escape_markup(bars_.names[row]) + "</title>";
    add(R"(<text class="name" x="{:.1f}" y="{}">{}{}</text>)", names_ - 8.0, row_top(row) + (row_ - kGap) / 2 + 4,
        escape_markup(shown), whole);
  }

  void bar(std::size_t row, std::size_t set) {
    const double value = value_of(bars_.sets[set], row);
    if (std::isnan(value)) return;
    const int top = row_top(row) + static_cast<int>(set) * bar_;
    double low = std::min(x(0.0), x(value)), high = std::max(x(0.0), x(value));
    add(R"(<rect class="bar" x="{:.1f}" y="{}" width="{:.1f}" height="{}" fill="{}"/>)", low, top, high - low, bar_ - 1,
        escape_markup(bars_.sets[set].colour));
    if (row < bars_.sets[set].intervals.size()) {
      const auto [lower, upper] = bars_.sets[set].intervals[row];
      if (can_be_shown(lower) && can_be_shown(upper)) {
        whisker(x(lower), x(upper), top + 0.5 * (bar_ - 1));
        low = std::min(low, x(lower));
        high = std::max(high, x(upper));
      }
    }
    if (!numbered_) return;
    const bool negative = value < 0.0;
    fmt::format_to(
        std::back_inserter(numbers_),
        R"(<text class="{}" x="{:.1f}" y="{}" paint-order="stroke" stroke="white" stroke-width="3">{}</text>)",
        negative ? "name value" : "value", negative ? low - 5.0 : high + 5.0, top + bar_ - 2, number(value));
  }

  /// Through the middle of a bar; x in the picture's units.
  void whisker(double from, double to, double y) {
    add(R"(<path class="whisker" d="M{0:.1f} {2:.1f}H{1:.1f}M{0:.1f} {3:.1f}V{4:.1f}M{1:.1f} {3:.1f}V{4:.1f}" )"
        R"(stroke="{5}" stroke-width="1.2" fill="none"/>)",
        from, to, y, y - 3, y + 3, colour::kInk);
  }

  struct PlacedMark {
    const Mark* mark;
    double words_px;  ///< middle of its words
    int row;          ///< of its words, from above
  };

  /// Words stand above their lines, in as many rows as are needed to avoid overlap.
  void place_marks() {
    std::vector<const Mark*> in_order;
    for (const Mark& mark : bars_.marks) {
      if (can_be_shown(mark.x)) in_order.push_back(&mark);
    }
    std::ranges::stable_sort(in_order, {}, [](const Mark* mark) { return mark->x; });
    std::vector<double> row_ends_px;
    for (const Mark* mark : in_order) {
      const double half = 0.5 * text_width(mark->text);
      const double middle = std::clamp(x(mark->x), half, kPictureWidth - half);
      const auto free = std::ranges::find_if(row_ends_px, [&](double end) { return end + 6.0 < middle - half; });
      const auto row = static_cast<int>(free - row_ends_px.begin());
      if (free == row_ends_px.end()) row_ends_px.push_back(0.0);
      row_ends_px[static_cast<std::size_t>(row)] = middle + half;
      marks_.push_back({mark, middle, row});
    }
    mark_rows_ = static_cast<int>(row_ends_px.size());
  }

  void show(const PlacedMark& placed) {
    const int words_y = kMargin + kMarkRow * (placed.row + 1) - 3;
    add(R"(<path d="M{0:.1f} {1}V{2}" stroke="{3}" stroke-width="1.5" stroke-dasharray="4 3"/>)"
        R"(<text class="mark" x="{4:.1f}" y="{5}" paint-order="stroke" stroke="white" stroke-width="3">{6}</text>)",
        x(placed.mark->x), words_y + 2, bottom_, colour::kInk, placed.words_px, words_y,
        escape_markup(placed.mark->text));
  }

  Legend legend() const {
    Legend legend(names_, kPictureWidth);
    for (const Bars::Set& set : bars_.sets) {
      if (bars_.sets.size() > 1) legend.add(set.colour, set.name);
    }
    return legend;
  }

  int row_top(std::size_t row) const { return top_ + row_ * static_cast<int>(row) + 3; }

  const Bars& bars_;
  const Range range_;
  const bool numbered_;
  const int bar_, row_;
  int top_ = 0, bottom_ = 0, mark_rows_ = 0;
  double names_ = 0.0, from_px_ = 0.0, to_px_ = 0.0;
  std::vector<PlacedMark> marks_;
  std::string out_, numbers_;
};

}  // namespace

std::string svg(const Bars& bars) { return BarDrawing(bars).svg(); }

}  // namespace pmg::pages
