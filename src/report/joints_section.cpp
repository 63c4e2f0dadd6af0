// The section about the joints' tracking: error bars, then the worst joints, then all.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "report/run_figures.hpp"
#include "report/sections.hpp"

namespace pmg::report {

namespace {

constexpr std::size_t kShown = 6;  // joints whose charts are not folded away

std::vector<double> widened(const std::vector<float>& values) { return {values.begin(), values.end()}; }

/// A joint's index in each run, by name: runs of different robots show their common joints together.
struct Joint {
  std::string name;
  std::vector<std::size_t> place;  // per run; kAbsent
  std::vector<JointTracking> tracking;
};
constexpr std::size_t kAbsent = std::numeric_limits<std::size_t>::max();

std::vector<Joint> gather(const Runs& runs) {
  std::vector<Joint> joints;
  std::map<std::string, std::size_t> known;
  for (std::size_t run = 0; run < runs.size(); ++run) {
    const std::vector<JointTracking>& tracking = runs[run].joint_tracking;
    for (std::size_t i = 0; i < tracking.size(); ++i) {
      const auto [entry, is_new] = known.try_emplace(runs[run].joint_names[i], joints.size());
      if (is_new) {
        joints.push_back({runs[run].joint_names[i], std::vector<std::size_t>(runs.size(), kAbsent),
                          std::vector<JointTracking>(runs.size())});
      }
      joints[entry->second].place[run] = i;
      joints[entry->second].tracking[run] = tracking[i];
    }
  }
  return joints;
}

double worst(const Joint& joint) {
  double error = 0.0;
  for (const JointTracking& tracking : joint.tracking) error = std::max(error, tracking.error_rms_rad);
  return error;
}

void charts(pages::Page& page, const Runs& runs, const Joint& joint) {
  const auto position = [&](std::size_t i) -> std::vector<RunLine> {
    if (joint.place[i] == kAbsent) return {};
    const auto& reference = runs[i].reference;
    const auto& state = runs[i].state;
    return {
        {.name = "reference",
         .x = reference.t_s,
         .y = followed(runs[i], reference.t_s, widened(reference.q_ref_rad[joint.place[i]])),
         .colour = palette(i).asked},
        {.name = "measured", .x = state.t_s, .y = widened(state.q_rad[joint.place[i]]), .colour = palette(i).measured}};
  };
  const auto torque = [&](std::size_t i) -> std::vector<RunLine> {
    if (joint.place[i] == kAbsent) return {};
    const auto& state = runs[i].state;
    return {{.name = "torque",
             .x = state.t_s,
             .y = widened(state.torque_Nm[joint.place[i]]),
             .colour = palette(i).measured}};
  };
  chart_of_runs(page, runs, joint.name + ", position [rad]", position, 180);
  chart_of_runs(page, runs, joint.name + ", torque [Nm]", torque, 180);
}

void bars(pages::Page& page, const Runs& runs, const std::vector<Joint>& joints) {
  pages::Bars errors{
      .title = "Tracking error, RMS while standing and walking [rad]", .unit = "rad", .names = {}, .sets = {}};
  pages::Bars torques{.title = "Largest torque [Nm]", .unit = "Nm", .names = {}, .sets = {}};
  for (const Joint& joint : joints) errors.names.push_back(joint.name);
  torques.names = errors.names;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    pages::Bars::Set error{runs[i].name + suffix(runs, i), {}, palette(i).measured};
    pages::Bars::Set torque = error;
    for (const Joint& joint : joints) {
      const bool here = joint.place[i] != kAbsent;
      error.values.push_back(here ? joint.tracking[i].error_rms_rad : std::nan(""));
      torque.values.push_back(here ? joint.tracking[i].torque_max_Nm : std::nan(""));
    }
    errors.sets.push_back(std::move(error));
    torques.sets.push_back(std::move(torque));
  }
  page.columns([&] {
    page.bars(errors);
    page.bars(torques);
  });
}

}  // namespace

void joints(pages::Page& page, const Runs& runs) {
  page.heading("Joints");
  std::vector<Joint> all = gather(runs);
  if (all.empty()) return page.paragraph("The log has no joints: neither STATE nor REFERENCE could be read.");
  bars(page, runs, all);
  std::vector<std::size_t> by_error(all.size());
  std::iota(by_error.begin(), by_error.end(), 0U);
  std::ranges::stable_sort(by_error, std::greater{}, [&](std::size_t i) { return worst(all[i]); });
  const std::size_t shown = std::min(kShown, all.size());
  page.paragraph("The joints that follow worst; the reference is drawn where the drives follow it.");
  page.columns([&] {
    for (std::size_t i = 0; i < shown; ++i) charts(page, runs, all[by_error[i]]);
  });
  if (shown == all.size()) return;
  std::sort(by_error.begin() + static_cast<std::ptrdiff_t>(shown), by_error.end());
  page.folded("All other joints", [&] {
    page.columns([&] {
      for (std::size_t i = shown; i < all.size(); ++i) charts(page, runs, all[by_error[i]]);
    });
  });
}

}  // namespace pmg::report
