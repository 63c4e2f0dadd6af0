#include "report/run_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <utility>

#include "control/mode.hpp"
#include "report/run_figures.hpp"
#include "report/sections.hpp"

namespace pmg::report {

namespace {

using pages::Lanes;

const char* mode_colour(const std::string& mode) {
  if (mode == to_string(control::Mode::kDamping)) return "#f3d9a6";
  if (mode == to_string(control::Mode::kStand)) return "#b9dcf2";
  if (mode == to_string(control::Mode::kWalk)) return "#a8dcc8";
  if (mode == to_string(control::Mode::kFault)) return "#f2a58c";
  return "#e3e7ec";
}

Lanes::Lane lane(const std::string& name, const std::vector<RunSeries::Stretch>& stretches, const char* colour) {
  Lanes::Lane row{.name = name, .stretches = {}};
  for (const RunSeries::Stretch& s : stretches) {
    row.stretches.push_back({s.from_s, s.to_s, s.text, colour != nullptr ? colour : mode_colour(s.text)});
  }
  return row;
}

/// Neighbours have different colours. A narrow stretch shows its number only.
Lanes::Lane step_lane(const std::string& name, const std::vector<RunSeries::Step>& steps) {
  Lanes::Lane row{.name = name, .stretches = {}};
  for (const RunSeries::Step& step : steps) {
    row.stretches.push_back({step.from_s, step.to_s, fmt::format("{} {}", step.number, step.text),
                             row.stretches.size() % 2 == 0 ? "#e9e4f2" : "#d8cfe8"});
  }
  return row;
}

/// The step's command, without channels that are zero.
std::string asked_text(const RunSeries::Step& step) {
  static constexpr std::array kNames = {"forward {:+.2f} m/s", "sideways {:+.2f} m/s", "turn {:+.2f} rad/s",
                                        "pitch {:+.2f} rad",   "roll {:+.2f} rad",     "height {:+.3f} m"};
  static_assert(kNames.size() == kChannels);
  std::string text;
  for (std::size_t channel = 0; channel < kChannels; ++channel) {
    if (step.asked[channel] == 0.0) continue;
    text += (text.empty() ? "" : ", ") + fmt::format(fmt::runtime(kNames[channel]), step.asked[channel]);
  }
  return text.empty() ? "nothing" : text;
}

void steps_table(pages::Page& page, const Runs& runs) {
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const RunSeries& run = runs[i];
    if (run.steps.empty()) continue;
    pages::Table table{
        .header = {"step", "from [s]", "to [s]", "what", "asked", "velocity error [m/s]", "yaw rate error [rad/s]",
                   "roll error [rad]", "pitch error [rad]", "height error [m]"},
        .rows = {}};
    for (const RunSeries::Step& step : run.steps) {
      std::vector<std::string> row = {std::to_string(step.number), fmt::format("{:.1f}", step.from_s),
                                      fmt::format("{:.1f}", step.to_s), step.text, asked_text(step)};
      const sil::TrackingSummary& t = step.tracking;
      for (const double error :
           {t.lin_vel_mae_m_s, t.yaw_vel_mae_rad_s, t.roll_mae_rad, t.pitch_mae_rad, t.height_mae_m})
        row.push_back(t.followed_s > 0.0 ? fmt::format("{:.3f}", error) : "-");
      table.rows.push_back(std::move(row));
    }
    page.folded(fmt::format("The {} steps of scenario {}{}, with the mean absolute error within each", run.steps.size(),
                            run.scenario, suffix(runs, i)),
                [&] { page.table(table); });
  }
}

/// The lane has room for the numbers of short steps only.
void name_steps(pages::Page& page, const Runs& runs) {
  std::vector<std::string> told;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::string names;
    for (const RunSeries::Step& step : runs[i].steps)
      names += fmt::format("{}{}\u00a0{}", names.empty() ? "" : ", ", step.number, step.text);
    if (names.empty() || std::ranges::find(told, names) != told.end()) continue;
    page.paragraph(fmt::format("Steps{}: {}.", suffix(runs, i), names));
    told.push_back(std::move(names));
  }
}

struct NamedEvent {
  RunSeries::Event event;
  std::string behind;  ///< of its run
};

void events_table(pages::Page& page, std::vector<NamedEvent> events) {
  if (events.empty()) return;
  std::ranges::stable_sort(events, {}, [](const NamedEvent& one) { return one.event.t_s; });
  pages::Table table{.header = {"time [s]", "what"}, .rows = {}};
  for (const NamedEvent& one : events)
    table.rows.push_back({fmt::format("{:.2f}{}", one.event.t_s, one.behind), one.event.text});
  page.table(table);
}

/// The part before the colon, because a mark has little room.
std::string short_fault(const std::string& text) { return text.substr(0, text.find(':')); }

}  // namespace

const Palette& palette(std::size_t run) {
  using namespace pages::colour;
  static constexpr std::array<Palette, kMostRuns> kPalettes = {{
      {.measured = kBlue, .asked = kInk, .admissible = kSky, .optimised = kPurple},
      {.measured = kVermillion, .asked = kGrey, .admissible = kOrange, .optimised = kGreen},
      {.measured = kGreen, .asked = kInk, .admissible = kSky, .optimised = kPurple},
      {.measured = kPurple, .asked = kGrey, .admissible = kOrange, .optimised = kGreen},
  }};
  return kPalettes.at(run);
}

std::string suffix(const Runs& runs, std::size_t run) {
  return runs.size() > 1 ? fmt::format(" {}", static_cast<char>('A' + run)) : "";
}

std::vector<pages::Band> fault_bands(const Runs& runs) {
  const std::string colour = "rgba(213,94,0,0.10)";
  std::vector<pages::Band> bands;
  for (const RunSeries& run : runs) {
    for (const RunSeries::Stretch& mode : run.modes) {
      if (mode.text == to_string(control::Mode::kFault)) bands.push_back({mode.from_s, mode.to_s, colour});
    }
  }
  return bands;
}

std::vector<double> followed(const RunSeries& run, std::span<const double> t_s, std::vector<double> values) {
  const std::vector<bool> held = holding(run, t_s);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!held[i]) values[i] = std::numeric_limits<double>::quiet_NaN();
  }
  return values;
}

void chart_of_runs(pages::Page& page, const Runs& runs, const std::string& title,
                   const std::function<std::vector<RunLine>(std::size_t)>& lines_of, int height_px) {
  std::vector<RunLine> drawn;
  double longest_gap_s = 0.0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    longest_gap_s = std::max(longest_gap_s, runs[i].longest_gap_s);
    for (RunLine& line : lines_of(i)) {
      if (line.x.empty()) continue;
      line.name += suffix(runs, i);
      if (line.x.size() != line.y.size())
        throw std::logic_error(title + ", " + line.name + ": thinned unlike its times");
      drawn.push_back(std::move(line));
    }
  }
  if (drawn.empty()) return;
  pages::Chart chart{
      .title = title, .lines = {}, .bands = fault_bands(runs), .height_px = height_px, .longest_gap = longest_gap_s};
  for (const RunLine& line : drawn) {
    chart.lines.push_back({.name = line.name,
                           .x = line.x,
                           .y = line.y,
                           .colour = line.colour,
                           .width_px = line.width_px,
                           .dashed = line.dashed,
                           .stepped = line.stepped,
                           .widens_from = line.widens_from,
                           .widens_to = line.widens_to});
  }
  page.chart(chart);
}

void verdicts(pages::Page& page, const Runs& runs) {
  work::Worth reading;
  for (const RunSeries& run : runs) reading.add(worth_of_reading(run));
  page.worth(reading);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const RunSeries& run = runs[i];
    const std::string letter = runs.size() > 1 ? fmt::format("{}  ", static_cast<char>('A' + i)) : "";
    page.verdict(worth_of(run), letter + verdict(run));
  }
}

void timeline(pages::Page& page, const Runs& runs) {
  page.heading("Timeline");
  Lanes lanes{.title =
                  "Modes, scenario steps, who drives, and what the gantry carries; drag to zoom all charts, double "
                  "click to go back",
              .lanes = {}};
  std::vector<NamedEvent> events;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const RunSeries& run = runs[i];
    const std::string behind = suffix(runs, i);
    lanes.lanes.push_back(lane("mode" + behind, run.modes, nullptr));
    if (!run.steps.empty()) lanes.lanes.push_back(step_lane("step" + behind, run.steps));
    if (!run.sources.empty()) lanes.lanes.push_back(lane("driver" + behind, run.sources, "#dfe6ee"));
    if (!run.hanging.empty()) lanes.lanes.push_back(lane("feet" + behind, run.hanging, "#f2dfa8"));
    if (!run.hoisted.empty()) lanes.lanes.push_back(lane("gantry" + behind, run.hoisted, "#efe3d3"));
    for (const RunSeries::Event& fault : run.faults)
      lanes.marks.push_back({fault.t_s, short_fault(fault.text) + behind});
    for (const auto* list : {&run.faults, &run.guard_trips, &run.stops}) {
      for (const RunSeries::Event& event : *list) events.push_back({event, behind});
    }
  }
  if (!lanes.marks.empty()) lanes.lanes.push_back({"faults", {}});  // room for the marks' words
  page.lanes(lanes);
  name_steps(page, runs);
  events_table(page, std::move(events));
  steps_table(page, runs);
}

void who_ran_what(pages::Page& page, const Runs& runs) {
  page.heading("Who ran what");
  pages::Table table{.header = {""}, .rows = {}};
  for (std::size_t i = 0; i < runs.size(); ++i) table.header.push_back(runs[i].name + suffix(runs, i));
  const auto row = [&](const char* name, auto value) {
    std::vector<std::string> cells = {name};
    for (const RunSeries& run : runs) cells.push_back(run.identified ? value(run.info) : "unknown");
    table.rows.push_back(std::move(cells));
  };
  using Info = pmg_msgs::robot_info_t;
  row("robot", [](const Info& info) { return info.robot; });
  row("model", [](const Info& info) { return info.model; });
  row("software", [](const Info& info) { return info.software; });
  row("policy", [](const Info& info) { return info.policy; });
  row("drives", [](const Info& info) { return info.backend; });
  row("bundle", [](const Info& info) { return info.bundle; });
  row("control rate [Hz]", [](const Info& info) { return fmt::format("{:g}", info.control_rate_hz); });
  row("real time refused", [](const Info& info) {
    return info.refused.empty() ? std::string("nothing") : fmt::format("{}", fmt::join(info.refused, "; "));
  });
  page.table(table);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Info& info = runs[i].info;
    if (info.bundle_count > 0) {
      page.folded("Files of the bundle" + suffix(runs, i), [&] {
        pages::Table files{.header = {"file", "SHA-256"}, .rows = {}};
        for (std::size_t k = 0; k < info.bundle_file.size(); ++k)
          files.rows.push_back({info.bundle_file[k], info.bundle_sha256[k]});
        page.table(files);
      });
    }
    if (!info.options.empty())
      page.folded("Configuration in force" + suffix(runs, i), [&] { page.paragraph(info.options); });
  }
}

pages::Page run_report(const std::vector<RunSeries>& runs) {
  if (runs.empty() || runs.size() > kMostRuns) {
    throw std::invalid_argument(fmt::format("a report shows 1 to {} runs, not {}", kMostRuns, runs.size()));
  }
  std::string title;
  for (const RunSeries& run : runs) title += (title.empty() ? "" : " and ") + run.name;
  pages::Page page("PMG report: " + title);
  verdicts(page, runs);
  timeline(page, runs);
  commands(page, runs);
  contact_and_slip(page, runs);
  joints(page, runs);
  limits_and_temperatures(page, runs);
  timing(page, runs);
  who_ran_what(page, runs);
  return page;
}

}  // namespace pmg::report
