#include "pages/svg_parts.hpp"

#include <fmt/format.h>

#include <cmath>

#include "pages/text.hpp"

namespace pmg::pages {

double tick_step(double span, int count) {
  const double rough = span / count, decade = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= rough) return factor * decade;
  }
  return 10.0 * decade;
}

std::string legend_entry(double x, double y, const std::string& colour, const std::string& text) {
  return fmt::format(R"(<rect x="{}" y="{}" width="11" height="11" fill="{}"/><text x="{}" y="{}">{}</text>)", x,
                     y - 10, colour, x + 16, y, escape_html(text));
}

}  // namespace pmg::pages
