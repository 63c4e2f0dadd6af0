// The sections about commanded and measured motion: commands, contact, slip.
#include <fmt/format.h>

#include <array>
#include <optional>
#include <utility>

#include "operator/keyboard_text.hpp"
#include "report/run_figures.hpp"
#include "report/sections.hpp"

namespace pmg::report {

namespace {

constexpr std::array<const char*, 2> kFeet = {"left", "right"};
constexpr std::array kTitles = {"Forward velocity vx [m/s]",        "Sideways velocity vy [m/s]",
                                "Yaw rate omega [rad/s]",           "Torso pitch [rad], + forward",
                                "Torso roll [rad], + to the right", "Height [m], deviation from standing"};
static_assert(kTitles.size() == kChannels);

/// Of the range that the robot takes: a mistyped command that is far beyond it must not flatten what the robot did.
constexpr double kAskedShown = 1.5;

std::vector<pages::Lanes::Stretch> stretches(const Intervals& intervals, const char* colour) {
  std::vector<pages::Lanes::Stretch> found;
  for (const Intervals::Interval& one : intervals.all()) found.push_back({one.from_s, one.to_s, "", colour});
  return found;
}

}  // namespace

void commands(pages::Page& page, const Runs& runs) {
  page.heading("Commands");
  page.paragraph(
      "asked: the driving source's command. admissible: that command within the robot's limits and with limited rates; "
      "the "
      "reference realises it. optimised: the motion on the ground that this reference gives. measured: the simulated "
      "robot's "
      "motion on its own feet, velocities averaged over one gait period.");
  std::vector<std::optional<CommandLimits>> limits;
  for (const RunSeries& run : runs) limits.push_back(ops::command_limits(run.info));
  page.columns([&] {
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      chart_of_runs(page, runs, kTitles[channel], [&](std::size_t i) -> std::vector<RunLine> {
        const auto& reference = runs[i].reference;
        const auto& truth = runs[i].truth;
        const Palette& colours = palette(i);
        RunLine asked{
            .name = "asked", .x = reference.t_s, .y = reference.user[channel], .colour = colours.asked, .dashed = true};
        if (limits[i]) {
          asked.widens_from = kAskedShown * limits[i]->lower[channel];
          asked.widens_to = kAskedShown * limits[i]->upper[channel];
        }
        return {std::move(asked),
                {.name = "admissible",
                 .x = reference.t_s,
                 .y = followed(runs[i], reference.t_s, reference.command[channel]),
                 .colour = colours.admissible,
                 .width_px = 2.2},
                {.name = "optimised",
                 .x = reference.t_s,
                 .y = followed(runs[i], reference.t_s, reference.optimised[channel]),
                 .colour = colours.optimised},
                {.name = "measured", .x = truth.t_s, .y = truth.measured[channel], .colour = colours.measured}};
      });
    }
  });
}

void contact_and_slip(pages::Page& page, const Runs& runs) {
  page.heading("Contact and slip");
  pages::Lanes lanes{
      .title = "Feet on the ground: as the reference plans it (dark), as the simulation measures it (light)",
      .lanes = {}};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto& reference = runs[i].reference;
    const auto& truth = runs[i].truth;
    for (std::size_t foot = 0; foot < 2; ++foot) {
      const std::string name = kFeet[foot] + suffix(runs, i);
      if (!reference.t_s.empty()) lanes.lanes.push_back({name, stretches(reference.contact[foot], "#5b7fa6")});
      if (!truth.t_s.empty()) lanes.lanes.push_back({"", stretches(truth.loaded[foot], "#b7cde4")});
    }
  }
  if (!lanes.lanes.empty()) page.lanes(lanes);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (runs[i].reference.t_s.empty()) continue;
    const gco::SlipSummary& slip = runs[i].reference_slip;
    std::string text = fmt::format(
        "Slip is the horizontal speed of a stance sole's contact point. Of the reference while it steps{}: mean {:.4f} "
        "m/s "
        "if the base moved as commanded, {:.4f} m/s as optimised.",
        suffix(runs, i), slip.before_mean_m_s, slip.after_mean_m_s);
    if (runs[i].tracking.followed_s > 0.0) {
      text +=
          fmt::format(" Of the simulated robot's loaded feet: mean {:.4f} m/s.", runs[i].tracking.foot_slip_mean_m_s);
    }
    page.paragraph(text);
  }
  page.columns([&] {
    for (std::size_t foot = 0; foot < 2; ++foot) {
      const std::string title =
          fmt::format("Slip of the {} foot [m/s], before and after the ground-aware optimisation", kFeet[foot]);
      chart_of_runs(page, runs, title, [&](std::size_t i) -> std::vector<RunLine> {
        const auto& reference = runs[i].reference;
        const auto& truth = runs[i].truth;
        const Palette& colours = palette(i);
        return {{.name = "before",
                 .x = reference.t_s,
                 .y = followed(runs[i], reference.t_s, reference.slip_before_m_s[foot]),
                 .colour = colours.admissible},
                {.name = "after",
                 .x = reference.t_s,
                 .y = followed(runs[i], reference.t_s, reference.slip_after_m_s[foot]),
                 .colour = colours.optimised},
                {.name = "measured", .x = truth.t_s, .y = truth.foot_slip_m_s[foot], .colour = colours.measured}};
      });
    }
  });
}

}  // namespace pmg::report
