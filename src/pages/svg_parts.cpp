#include "pages/svg_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "pages/text.hpp"

namespace pmg::pages {

namespace {

constexpr double kCharacter = 6.9;  // of 12 px sans-serif fonts: Open Sans' and DejaVu Sans' mean is 6.5
constexpr double kSquare = 16.0, kBetween = 18.0;
constexpr int kRow = 18;

}  // namespace

double text_width(const std::string& text) {
  return kCharacter * static_cast<double>(std::ranges::count_if(text, begins_character));
}

std::string fitted(const std::string& text, double width) {
  if (text_width(text) <= width) return text;
  std::string shown;
  double used = 2.0 * kCharacter;  // the ellipsis
  for (const char byte : text) {
    if (begins_character(byte)) used += kCharacter;
    if (used > width) break;
    shown += byte;
  }
  while (!shown.empty() && shown.back() == ' ') shown.pop_back();
  return shown + "…";
}

void Legend::add(const std::string& colour, const std::string& text, bool dashed) {
  const double width = kSquare + text_width(text);
  int row = entries_.empty() ? 0 : entries_.back().row;
  if (at_ > left_ && at_ + width > right_) {
    ++row;
    at_ = left_;
  }
  entries_.push_back({at_, row, colour, text, dashed});
  at_ += width + kBetween;
}

int Legend::height() const { return entries_.empty() ? 0 : kRow * (entries_.back().row + 1); }

std::string Legend::svg(double top) const {
  std::string out;
  for (const Entry& entry : entries_) {
    const double y = top + kRow * entry.row + 14.0;
    const std::vector<double> parts = entry.dashed ? std::vector{0.0, 7.0} : std::vector{0.0};
    for (const double part : parts) {
      out += fmt::format(R"(<rect class="key" x="{:.1f}" y="{:.1f}" width="{}" height="11" fill="{}"/>)",
                         entry.x + part, y - 10.0, entry.dashed ? 4 : 11, escape_markup(entry.colour));
    }
    out += fmt::format(R"(<text class="entry" x="{:.1f}" y="{:.1f}">{}</text>)", entry.x + kSquare, y,
                       escape_markup(fitted(entry.text, right_ - entry.x - kSquare)));
  }
  return out;
}

}  // namespace pmg::pages
