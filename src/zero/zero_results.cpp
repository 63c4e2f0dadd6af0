#include "zero/zero_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace pmg::zero {

namespace {

using nlohmann::ordered_json;

const std::string& joint_name(const ZeroResults& results, std::size_t i) {
  return results.robot->joint_index.name(results.found.joints[i]);
}

double z_rad(const ZeroResults& results, std::size_t i) { return results.found.z_rad[static_cast<Eigen::Index>(i)]; }
double deviation_rad(const ZeroResults& results, std::size_t i) {
  return results.found.deviation_rad[static_cast<Eigen::Index>(i)];
}

ordered_json pose_json(const StillPose& pose, const ZeroPose& judged) {
  ordered_json json = {{"log", pose.log},
                       {"from_s", pose.from_s},
                       {"to_s", pose.to_s},
                       {"used", judged.used},
                       {"why_not", judged.used ? ordered_json(nullptr) : ordered_json(judged.why_not)},
                       {"misalignment_rad", judged.misalignment_rad},
                       {"height_miss_m", judged.height_miss_m}};
  for (const Foot foot : {kLeft, kRight}) {
    json[foot == kLeft ? "left_sole" : "right_sole"] = {{"force_N", judged.load[foot].force_N},
                                                        {"pressure_inside_m", judged.load[foot].inside_m}};
  }
  return json;
}

std::string verdict_text(const ZeroResults& results) {
  const auto without = std::ranges::count(results.found.known, Known::kNo);
  return fmt::format("Zero points of {} joints from {} poses; {} of {} joints can't be told",
                     std::ssize(results.found.known) - without, results.found.used(), unobserved_joints(results).size(),
                     results.robot->joints.size());
}

/// The largest standard deviation of a zero point that is known roughly [rad].
double worst_rough_rad(const ZeroCalibration& found) {
  double worst = 0.0;
  for (std::size_t i = 0; i < found.known.size(); ++i) {
    if (found.known[i] == Known::kRoughly) worst = std::max(worst, found.deviation_rad[static_cast<Eigen::Index>(i)]);
  }
  return worst;
}

/// "well", "roughly", "no": the word in zero.json.
const char* name(Known known) {
  constexpr const char* kNames[] = {"no", "roughly", "well"};
  return kNames[static_cast<int>(known)];
}

/// In a line or table row of a joint; "" where all is well.
const char* remark(Known known) {
  constexpr const char* kRemarks[] = {"can't be told", "known roughly", ""};
  return kRemarks[static_cast<int>(known)];
}

void show_offsets(pages::Page& page, const ZeroResults& results) {
  pages::Bars bars{.title = "zero point z, to be added to the reading; whiskers: two standard deviations [mrad]",
                   .unit = "mrad",
                   .names = {},
                   .sets = {{.name = "z", .values = {}, .colour = pages::colour::kBlue}}};
  pages::Table table{.header = {"joint", "z [rad]", "one standard deviation [rad]", "sensor.zero_offset_rad", ""},
                     .rows = {}};
  for (std::size_t i = 0; i < results.found.joints.size(); ++i) {
    const double z = z_rad(results, i), deviation = deviation_rad(results, i);
    bars.names.push_back(joint_name(results, i));
    bars.sets[0].values.push_back(1e3 * z);
    bars.sets[0].intervals.push_back({1e3 * (z - 2.0 * deviation), 1e3 * (z + 2.0 * deviation)});
    table.rows.push_back({joint_name(results, i), fmt::format("{:+.4f}", z), fmt::format("{:.4f}", deviation),
                          results.found.known[i] == Known::kNo ? "" : fmt::format("{:+.4f}", -z),
                          remark(results.found.known[i])});
  }
  page.bars(bars);
  page.table(table);
}

void show_observability(pages::Page& page, const ZeroResults& results) {
  page.paragraph(
      "A joint's zero point shows when turning the joint alone would tilt a sole or lift one over the other, in some "
      "pose "
      "in a way that no other joint's zero point and no tilt of the IMU could imitate.");
  std::string singular;
  for (const double value : results.found.singular_values) singular += fmt::format("{:.0f} ", value);
  page.paragraph("Singular values of the weighted, stacked Jacobian of all poses by the zero points [1/rad]: " +
                 singular);
  if (!results.found.blind.empty()) {
    pages::Table blind{
        .header = {"combination of zero points that the poses hardly see", "one standard deviation [rad]"}, .rows = {}};
    for (const BlindDirection& direction : results.found.blind)
      blind.rows.push_back({direction.text, fmt::format("{:.4f}", direction.deviation_rad)});
    page.table(blind);
  }
  page.folded("Joints whose zero point can't be told", [&] {
    pages::Table table{.header = {"joint", "why"}, .rows = {}};
    for (const UnobservedJoint& joint : unobserved_joints(results)) table.rows.push_back({joint.name, joint.why});
    page.table(table);
  });
}

/// A log's name stands in each row only where there are several.
void show_poses(pages::Page& page, const ZeroResults& results) {
  const std::vector<StillPose>& poses = *results.poses;
  const bool several = std::ranges::any_of(poses, [&](const StillPose& pose) { return pose.log != poses.front().log; });
  if (!several && !poses.empty()) page.paragraph("All in " + poses.front().log + ".");
  pages::Table table{.header = {"from [s]", "to [s]", "IMU misaligned by [mrad]", "soles uneven by [mm]",
                                "load left, right [N]", "pressure inside the edge [mm]", "used, or why not"},
                     .rows = {}};
  if (several) table.header.insert(table.header.begin(), "log");
  for (std::size_t k = 0; k < results.found.poses.size(); ++k) {
    const ZeroPose& judged = results.found.poses[k];
    std::vector<std::string> row = {
        fmt::format("{:.1f}", poses[k].from_s),
        fmt::format("{:.1f}", poses[k].to_s),
        fmt::format("{:.2f}", 1e3 * judged.misalignment_rad),
        fmt::format("{:.2f}", 1e3 * judged.height_miss_m),
        fmt::format("{:.0f}, {:.0f}", judged.load[kLeft].force_N, judged.load[kRight].force_N),
        fmt::format("{:.0f}, {:.0f}", 1e3 * judged.load[kLeft].inside_m, 1e3 * judged.load[kRight].inside_m),
        judged.used ? "used" : judged.why_not};
    if (several) row.insert(row.begin(), poses[k].log);
    table.rows.push_back(std::move(row));
  }
  page.table(table);
}

void show_convergence(pages::Page& page, const ZeroResults& results) {
  std::vector<double> iteration, step_mrad;
  for (const double step : results.found.steps_rad) {
    iteration.push_back(static_cast<double>(iteration.size() + 1));
    step_mrad.push_back(1e3 * step);
  }
  if (iteration.size() < 2) return;
  page.chart({.title = "largest update of a zero point [mrad]",
              .x_name = "iteration",
              .x_unit = "",
              .lines = {{.name = "update", .x = iteration, .y = step_mrad}},
              .height_px = 160});
}

}  // namespace

sim::ActuatorsByJoint with_zero_offsets(sim::ActuatorsByJoint actuators, const ZeroResults& results) {
  for (std::size_t i = 0; i < results.found.joints.size(); ++i) {
    if (results.found.known[i] != Known::kNo)
      actuators[joint_name(results, i)].sensor.zero_offset_rad = -z_rad(results, i);
  }
  return actuators;
}

std::vector<UnobservedJoint> unobserved_joints(const ZeroResults& results) {
  std::vector<UnobservedJoint> unobserved;
  for (int joint = 0; joint < results.robot->joint_index.size(); ++joint) {
    const auto place = std::ranges::find(results.found.joints, joint);
    const std::string& name = results.robot->joint_index.name(joint);
    if (place == results.found.joints.end()) {
      unobserved.push_back({name, "not between the soles and the IMU"});
      continue;
    }
    const auto i = static_cast<std::size_t>(place - results.found.joints.begin());
    if (results.found.known[i] == Known::kNo) {
      unobserved.push_back({name, fmt::format("these poses leave it uncertain by {:.4f} rad (one standard deviation)",
                                              deviation_rad(results, i))});
    }
  }
  return unobserved;
}

work::Worth worth_of(const ZeroResults& results) {
  const ZeroCalibration& found = results.found;
  work::Worth worth;
  worth.add_if(results.interrupted, work::Grade::kInterrupted,
               fmt::format("after {} iterations", found.steps_rad.size()));
  worth.add_if(!results.interrupted && !found.converged, work::Grade::kMissed,
               fmt::format("not converged in {} iterations", found.steps_rad.size()));
  worth.add_if(!(found.weighted_rms <= kMostWeightedRms), work::Grade::kOffItsData,
               fmt::format("the poses disagree by {:.2g} times what was expected", found.weighted_rms));
  const auto without = std::ranges::count(found.known, Known::kNo);
  worth.add_if(without > 0, work::Grade::kPartial,
               fmt::format("{} of {} joints between the soles and the IMU can't be told", without, found.known.size()));
  const auto roughly = std::ranges::count(found.known, Known::kRoughly);
  worth.add_if(roughly > 0, work::Grade::kPartial,
               fmt::format("{} of {} joints between the soles and the IMU are known roughly: one standard deviation "
                           "is up to {:.1f} mrad, asked {:.1f}; a second calibration with these zero points knows more",
                           roughly, found.known.size(), 1e3 * worst_rough_rad(found), 1e3 * results.options.well_rad));
  return worth;
}

ordered_json zero_json(const ZeroResults& results) {
  const ZeroCalibration& found = results.found;
  const ZeroOptions& options = results.options;
  ordered_json json = {{"kind", "zero"},
                       {"robot", results.robot->name},
                       {"complete", !results.interrupted},
                       {"converged", found.converged},
                       {"iterations", found.steps_rad.size()},
                       {"poses_used", found.used()},
                       {"tau_rad", options.tau_rad},
                       {"alpha", options.alpha},
                       {"epsilon_rad", options.epsilon_rad},
                       {"M", options.M},
                       {"joints", ordered_json::object()},
                       {"not_observable", ordered_json::object()},
                       {"imu_tilt_rad", {found.imu_tilt_rad.x(), found.imu_tilt_rad.y()}},
                       {"weighted_rms", found.weighted_rms},
                       {"singular_values_per_rad", found.singular_values},
                       {"blind_directions", ordered_json::array()},
                       {"poses", ordered_json::array()}};
  add_to(json, worth_of(results));
  for (std::size_t i = 0; i < found.joints.size(); ++i) {
    json["joints"][joint_name(results, i)] = {{"z_rad", z_rad(results, i)},
                                              {"zero_offset_rad", -z_rad(results, i)},
                                              {"deviation_rad", deviation_rad(results, i)},
                                              {"known", name(found.known[i])}};
  }
  for (const UnobservedJoint& joint : unobserved_joints(results)) json["not_observable"][joint.name] = joint.why;
  for (const BlindDirection& blind : found.blind)
    json["blind_directions"].push_back({{"combination", blind.text}, {"deviation_rad", blind.deviation_rad}});
  for (std::size_t k = 0; k < found.poses.size(); ++k)
    json["poses"].push_back(pose_json((*results.poses)[k], found.poses[k]));
  return json;
}

pages::Page zero_report(const ZeroResults& results) {
  pages::Page page(fmt::format("{}: zero calibration", results.robot->name));
  page.worth(worth_of(results));
  page.verdict({}, verdict_text(results));
  page.heading("Zero points");
  show_offsets(page, results);
  page.heading("What the poses can tell");
  show_observability(page, results);
  page.heading("Poses");
  show_poses(page, results);
  page.heading("The iteration");
  show_convergence(page, results);
  page.paragraph(
      fmt::format("tau {} rad, alpha {}, epsilon {} rad over M = {} iterations. What is left in the poses is "
                  "{:.2f} of what was expected.",
                  results.options.tau_rad, results.options.alpha, results.options.epsilon_rad, results.options.M,
                  results.found.weighted_rms));
  return page;
}

std::vector<std::string> zero_text(const ZeroResults& results) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < results.found.joints.size(); ++i) {
    const std::string after = remark(results.found.known[i]);
    lines.push_back(fmt::format("{:24} z {:+.4f} +- {:.4f} rad{}", joint_name(results, i), z_rad(results, i),
                                deviation_rad(results, i), after.empty() ? "" : "   (" + after + ")"));
  }
  for (const BlindDirection& blind : results.found.blind)
    lines.push_back(fmt::format("hardly seen: {} (+- {:.4f} rad)", blind.text, blind.deviation_rad));
  if (const std::string worth = worth_of(results).sentence(); !worth.empty()) lines.push_back(worth);
  lines.push_back(verdict_text(results));
  return lines;
}

std::vector<std::string> zero_remarks(const ZeroResults& results) {
  std::vector<std::string> lines = {
      fmt::format("{}: zero points by pmg_calibrate_zero, {} poses, {}.", results.robot->name, results.found.used(),
                  results.found.converged ? "converged" : "not converged"),
      "zero_offset_rad is reading less truth; the firmware adds its negative."};
  if (const std::string worth = worth_of(results).sentence(); !worth.empty()) lines.insert(lines.begin(), worth);
  return lines;
}

}  // namespace pmg::zero
