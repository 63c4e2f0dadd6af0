// How the joints followed: error bars first, then the worst joints, then all.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "logs/report_sections.hpp"
#include "logs/run_figures.hpp"

namespace pmg::logs::report {

namespace {

constexpr std::size_t kShown = 6;  // joints whose charts are not folded away

std::vector<double> widened(const std::vector<float>& values) { return {values.begin(), values.end()}; }

/// A joint's place in each run, by its name: runs of different robots share what they share.
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
    const std::vector<JointTracking> tracking = joint_tracking(runs[run]);
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
  std::vector<std::vector<double>> kept;  // what the lines refer to
  kept.reserve(3 * runs.size());
  std::vector<pages::Line> positions, torques;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (joint.place[i] == kAbsent) continue;
    const RunSeries& run = runs[i];
    const std::string behind = suffix(runs, i);
    const std::vector<double>& reference =
        kept.emplace_back(followed(run, run.reference.t_s, widened(run.reference.q_ref_rad[joint.place[i]])));
    positions.push_back(
        {.name = "reference" + behind, .x = run.reference.t_s, .y = reference, .colour = palette(i).asked});
    const std::vector<double>& q = kept.emplace_back(widened(run.state.q_rad[joint.place[i]]));
    positions.push_back({.name = "measured" + behind, .x = run.state.t_s, .y = q, .colour = palette(i).measured});
    const std::vector<double>& torque = kept.emplace_back(widened(run.state.torque_Nm[joint.place[i]]));
    torques.push_back({.name = "torque" + behind, .x = run.state.t_s, .y = torque, .colour = palette(i).measured});
  }
  add_chart(page, runs, joint.name + ", position [rad]", std::move(positions), 180);
  add_chart(page, runs, joint.name + ", torque [Nm]", std::move(torques), 180);
}

void bars(pages::Page& page, const Runs& runs, const std::vector<Joint>& joints) {
  pages::Bars errors{
      .title = "Tracking error, RMS while standing and walking [rad]", .unit = "rad", .names = {}, .sets = {}};
  pages::Bars torques{.title = "Largest torque [Nm]", .unit = "Nm", .names = {}, .sets = {}};
  for (const Joint& joint : joints) errors.names.push_back(joint.name);
  torques.names = errors.names;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    pages::Bars::Set error{runs[i].name + suffix(runs, i), {}, palette(i).measured}, torque = error;
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

}  // namespace pmg::logs::report
