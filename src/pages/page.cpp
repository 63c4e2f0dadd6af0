#include "pages/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "pages/assets.hpp"
#include "pages/bar_picture.hpp"
#include "pages/figure_picture.hpp"
#include "pages/histogram_picture.hpp"
#include "pages/line_data.hpp"
#include "pages/plot_picture.hpp"
#include "pages/text.hpp"

namespace pmg::pages {

namespace {

using nlohmann::ordered_json;

constexpr std::size_t kChartColumns =
    1500;  // points of a line: more than a laptop's chart has pixels, so that zooming shows more
constexpr double kResolution = 5000.0;  // steps over a line's range: finer than a pixel
constexpr std::string_view kDoctype = "<!doctype html>";

std::string dump(const ordered_json& json) { return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace); }

ordered_json marks_json(const std::vector<Mark>& marks) {
  ordered_json json = ordered_json::array();
  for (const Mark& mark : marks) json.push_back({mark.x, mark.text});
  return json;
}

std::string axis_name(const std::string& named, const std::string& x_name, const std::string& x_unit) {
  return named.empty() ? fmt::format("{} [{}]", x_name, x_unit) : named;
}

bool same_x(const Line& a, const Line& b) { return a.x.data() == b.x.data() && a.x.size() == b.x.size(); }

/// Sorts the lines so that lines over the same x are neighbours; they share one track.
std::vector<std::vector<const Line*>> tracks(const std::vector<Line>& lines) {
  std::vector<std::vector<const Line*>> groups;
  for (const Line& line : lines) {
    const auto group = std::ranges::find_if(groups, [&](const auto& g) { return same_x(*g.front(), line); });
    if (group != groups.end()) {
      group->push_back(&line);
    } else if (!line.x.empty()) {
      groups.push_back({&line});
    }
  }
  return groups;
}

std::string tracks_json(const std::vector<std::vector<const Line*>>& groups, double longest_gap) {
  std::string text = "[";
  for (const auto& group : groups) {
    std::vector<std::span<const double>> ys;
    for (const Line* line : group) ys.push_back(line->y);
    const LineData data = decimate(group.front()->x, ys, kChartColumns, longest_gap);
    text += text.size() > 1 ? ",{\"x\":" : "{\"x\":";
    text += delta_json(data.x, 20.0 * kChartColumns) + ",\"y\":[";
    for (std::size_t i = 0; i < data.y.size(); ++i) {
      if (i > 0) text += ',';
      text += delta_json(data.y[i], kResolution);
    }
    text += "]}";
  }
  return text + "]";
}

std::string chart_element(const std::string& spec, int height_px) {
  return fmt::format(R"(<div class="chart" style="min-height:{}px"><script type="application/json">{}</script></div>)",
                     height_px, escape_script(spec));
}

/// Green says that it holds, and nothing else does.
const char* colour_class(work::Grade grade) {
  switch (grade) {
    case work::Grade::kHolds:
      return "good";
    case work::Grade::kOpen:
      return "neutral";
    case work::Grade::kPartial:
    case work::Grade::kInterrupted:
      return "unfinished";
    case work::Grade::kMissed:
    case work::Grade::kNoBetter:
    case work::Grade::kOffItsData:
      break;
  }
  return "bad";
}

}  // namespace

Page::Page(std::string title) : title_(std::move(title)) {}

void Page::worth(const work::Worth& worth) {
  worth_.add(worth);
  if (!worth.reservations().empty()) highlighted(worth.grade(), worth.sentence());
}

void Page::verdict(const work::Worth& worth, const std::string& text) {
  const std::string before = worth.sentence();
  highlighted(std::max(worth.grade(), worth_.grade()), before.empty() ? text : before + ". " + text);
}

void Page::note(const std::string& text) {
  body_ += "<div class=\"verdict neutral\">" + escape_markup(text) + "</div>\n";
}

void Page::highlighted(work::Grade grade, const std::string& text) {
  body_ += fmt::format("<div class=\"verdict {}\">{}</div>\n", colour_class(grade), escape_markup(text));
}

void Page::heading(const std::string& text) {
  ++headings_;
  body_ += fmt::format("<h2 id=\"s{}\">{}</h2>\n", headings_, escape_markup(text));
  contents_ += fmt::format("<a href=\"#s{}\">{}</a> ", headings_, escape_markup(text));
}

void Page::paragraph(const std::string& text) { body_ += "<p>" + escape_markup(text) + "</p>\n"; }

void Page::table(const Table& table) {
  body_ += "<div class=\"scroll\"><table class=\"data\"><tr>";
  for (const std::string& cell : table.header) body_ += "<th>" + escape_markup(cell) + "</th>";
  body_ += "</tr>\n";
  for (const auto& row : table.rows) {
    body_ += "<tr>";
    for (const std::string& cell : row) body_ += "<td>" + escape_markup(cell) + "</td>";
    body_ += "</tr>\n";
  }
  body_ += "</table></div>\n";
}

void Page::judgements(const std::vector<Judgement>& judgements) {
  body_ +=
      "<div class=\"scroll\"><table "
      "class=\"data\"><tr><th>quantity</th><th>measured</th><th>asked</th><th></th></tr>\n";
  for (const Judgement& one : judgements) {
    body_ += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td class=\"word {}\">{}</td></tr>\n",
                         escape_markup(one.what), escape_markup(one.measured), escape_markup(one.limit),
                         colour_class(one.grade), escape_markup(one.word.empty() ? name(one.grade) : one.word));
  }
  body_ += "</table></div>\n";
}

void Page::chart(const Chart& chart) {
  const auto groups = tracks(chart.lines);
  const std::string axis = axis_name(chart.axis, chart.x_name, chart.x_unit);
  ordered_json lines = ordered_json::array();
  for (const auto& group : groups) {
    for (const double x : group.front()->x) show_x(axis, x);
    for (const Line* line : group) {
      lines.push_back({{"name", line->name},
                       {"colour", line->colour},
                       {"width", line->width_px},
                       {"dashed", line->dashed},
                       {"stepped", line->stepped}});
      if (std::isfinite(line->widens_from) && std::isfinite(line->widens_to))
        lines.back()["widens"] = {line->widens_from, line->widens_to};
    }
  }
  ordered_json bands = ordered_json::array();
  for (const Mark& mark : chart.marks) show_x(axis, mark.x);
  for (const Band& band : chart.bands) bands.push_back({band.from, band.to, band.colour});
  const ordered_json spec = {
      {"axis", axis},   {"x_name", chart.x_name}, {"x_unit", chart.x_unit},          {"height", chart.height_px},
      {"lines", lines}, {"bands", bands},         {"marks", marks_json(chart.marks)}};
  std::string text = dump(spec);
  text.pop_back();  // removes the closing brace; the tracks follow as separate text
  text += ",\"tracks\":" + tracks_json(groups, chart.longest_gap) + "}";
  needs_script_ = true;
  picture(chart.title, chart_element(text, chart.height_px));
}

void Page::lanes(const Lanes& lanes) {
  const std::string axis = axis_name("", lanes.x_name, lanes.x_unit);
  ordered_json rows = ordered_json::array();
  for (const Lanes::Lane& lane : lanes.lanes) {
    ordered_json stretches = ordered_json::array();
    for (const Lanes::Stretch& s : lane.stretches) {
      for (const double x : {s.from, s.to}) show_x(axis, x);
      stretches.push_back({s.from, s.to, s.text, s.colour});
    }
    rows.push_back({{"name", lane.name}, {"stretches", stretches}});
  }
  const ordered_json spec = {{"axis", axis},
                             {"x_unit", lanes.x_unit},
                             {"lines", ordered_json::array()},
                             {"bands", ordered_json::array()},
                             {"marks", marks_json(lanes.marks)},
                             {"lanes", rows},
                             {"tracks", ordered_json::array()}};
  needs_script_ = true;
  picture(lanes.title, chart_element(dump(spec), 34 + 26 * static_cast<int>(lanes.lanes.size())));
}

void Page::bars(const Bars& bars) { picture(bars.title, svg(bars)); }
void Page::histogram(const Histogram& histogram) { picture(histogram.title, svg(histogram)); }
void Page::plot(const Plot& plot) { picture(plot.title, svg(plot)); }
void Page::figures(const Figures& figures) { picture(figures.title, svg(figures)); }
void Page::figures(const MovingFigures& figures) { picture(figures.title, svg(figures)); }

void Page::columns(const std::function<void()>& fill) {
  body_ += "<div class=\"columns\">\n";
  fill();
  body_ += "</div>\n";
}

void Page::folded(const std::string& summary, const std::function<void()>& fill) {
  body_ += "<details><summary>" + escape_markup(summary) + "</summary>\n";
  fill();
  body_ += "</details>\n";
}

void Page::picture(const std::string& title, const std::string& content) {
  body_ += "<div class=\"picture\"><h3>" + escape_markup(title) + "</h3>" + content + "</div>\n";
}

void Page::show_x(const std::string& axis, double x) {
  axes_.try_emplace(axis, Range::empty()).first->second.include(x);
}

std::string Page::html() const {
  ordered_json axes = ordered_json::object();
  for (const auto& [name, range] : axes_) {
    const Range shown = shown_range(range, 0.0);
    axes[name] = {shown.from, shown.to};
  }
  const std::string title = escape_markup(title_);
  std::string text =
      std::string(kDoctype) +
      "\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\">\n"
      // The page loads nothing, whatever its text holds.
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
      "script-src "
      "'unsafe-inline'\">\n<title>" +
      title + "</title>\n<style>" + kUplotStyle + "\n" + kPageStyle + "</style></head>\n";
  text += fmt::format("<body data-axes=\"{}\" data-worth=\"{}\">\n<h1>{}</h1>\n", escape_markup(dump(axes)),
                      name(worth_.grade()), title);
  if (headings_ > 1) text += "<nav>" + contents_ + "</nav>\n";
  if (needs_script_) {
    text += "<noscript><p>Charts to zoom into need JavaScript; tables and all other pictures don't.</p></noscript>\n";
  }
  text += body_;
  text += std::string("<script>") + kUplotScript + "\n" + kPageScript + "</script>\n</body></html>\n";
  return text;
}

void expect_page_or_none(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file) || std::filesystem::file_size(file) == 0) return;
  std::string begin(kDoctype.size(), '\0');
  std::ifstream(file, std::ios::binary).read(begin.data(), static_cast<std::streamsize>(begin.size()));
  if (begin != kDoctype) throw std::invalid_argument(file.string() + ": is there and is no page; expected a new file");
}

void Page::write(const std::filesystem::path& file) const {
  expect_page_or_none(file);
  std::ofstream out(file, std::ios::binary);
  out << html();
  if (out.flush()) return;
  const std::filesystem::path folder = file.parent_path();
  throw std::runtime_error(
      file.string() + ": can't be written" +
      (folder.empty() || std::filesystem::is_directory(folder) ? "" : ": there is no folder " + folder.string()));
}

}  // namespace pmg::pages
