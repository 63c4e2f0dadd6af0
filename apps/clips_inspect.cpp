#include "clips_inspect.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "json_output.hpp"
#include "mocap/activities.hpp"
#include "mocap/gait_cycle.hpp"
#include "mocap/gait_events.hpp"
#include "mocap_files/recording.hpp"
#include "option_checks.hpp"

namespace pmg::apps {
namespace {

using namespace pmg::mocap;

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// Everything that is said of a recording.
struct Inspection {
  Recording recording;
  BodyCourse course;
  std::vector<Step> steps;
  std::vector<Activity> activities;
  std::vector<GaitCycle> cycles;  ///< the best one of each walk that has one
};

Inspection inspected(const InspectOptions& options) {
  const NameTable names = read_name_table(options.names.empty() ? default_name_table() : options.names);
  Motion motion = read_motion(options.file, {options.skeleton, options.rest_pose});
  Inspection result;
  result.recording =
      make_recording(options.file.string(), std::move(motion), names, {options.rate_hz, options.unit_m, options.up});
  if (result.recording.rate_hz < GaitEventOptions().slowest_rate_hz)
    result.recording.notes.emplace_back("too few frames a second for steps: is the rate right? --rate sets it");
  result.course = course_of(result.recording);
  result.steps = find_steps(result.recording);
  result.activities = find_activities(result.recording, result.course, result.steps);
  for (const Activity& activity : result.activities) {
    if (activity.steps < 3) continue;
    const auto cycle = best_cycle(result.recording, result.steps, activity.from_s, activity.to_s);
    if (cycle) result.cycles.push_back(*cycle);
  }
  return result;
}

std::string times(const std::vector<double>& seconds) {
  std::vector<std::string> shown;
  for (const double t : seconds) shown.push_back(fmt::format("{:.3f}", t));
  return shown.empty() ? "none" : fmt::format("{} s", fmt::join(shown, ", "));
}

void print_activity(const Activity& a) {
  fmt::print("  {:7.2f} to {:7.2f} s  {:13}", a.from_s, a.to_s, name_of(a.kind));
  if (a.steps > 0) {
    fmt::print(" {:2} steps, vx {:5.2f}, vy {:5.2f} m/s, turns {:4.0f} deg ({:.0f} deg/s)", a.steps, a.vx_m_s, a.vy_m_s,
               a.yaw_rad * kDegrees, a.yaw_rate_rad_s() * kDegrees);
    if (a.steps_per_min > 0.0) fmt::print(", {:.0f} steps/min", a.steps_per_min);
  } else {
    fmt::print(" pelvis down {:.2f} m, trunk pitch {:.0f}, roll {:.0f} deg", a.pelvis_drop_m, a.pitch_rad * kDegrees,
               a.roll_rad * kDegrees);
  }
  fmt::print("\n");
}

void print_text(const Inspection& inspection) {
  const Recording& r = inspection.recording;
  fmt::print("{}: {}, {} {}, {} frames at {:.4g} Hz ({}), {:.2f} s\n", r.file, r.format, r.skeleton.size(),
             r.markers ? "markers" : "joints", r.frames, r.rate_hz, r.rate_from, r.duration_s());
  fmt::print("unit {:.5g} m ({}), up {}, legs {:.3f} m\n", r.unit_m, r.unit_from, r.up, r.leg_length_m);
  std::vector<std::string> missing;
  for (std::size_t b = 0; b < kKeyBodies; ++b) {
    if (!r.bodies[b].known()) missing.emplace_back(kKeyBodyNames[b]);
  }
  fmt::print("without {}\n", missing.empty() ? "nothing" : fmt::format("{}", fmt::join(missing, ", ")));
  for (const std::string& note : r.notes) fmt::print("note: {}\n", note);
  for (const Activity& activity : inspection.activities) print_activity(activity);
  const auto events = events_of(inspection.steps);
  for (std::size_t side = 0; side < 2; ++side) {
    const char* name = side == 0 ? "left" : "right";
    fmt::print("{} foot lands: {}\n{} foot leaves: {}\n", name, times(events[side].contact_s), name,
               times(events[side].off_s));
  }
  for (const GaitCycle& c : inspection.cycles) {
    fmt::print(
        "cycle {:.3f} to {:.3f} s from the {} foot's contact: pose error {:.1f} cm, duty factor {:.2f} left, {:.2f} "
        "right\n",
        c.from_s, c.to_s, c.side == Side::left ? "left" : "right", 100.0 * c.loop_error_m, c.contact[0].duty_factor,
        c.contact[1].duty_factor);
  }
}

nlohmann::json activity_json(const Activity& a) {
  return {{"kind", name_of(a.kind)},
          {"from_s", a.from_s},
          {"to_s", a.to_s},
          {"steps", a.steps},
          {"vx_m_s", a.vx_m_s},
          {"vy_m_s", a.vy_m_s},
          {"yaw_rad", a.yaw_rad},
          {"steps_per_min", a.steps_per_min},
          {"pelvis_drop_m", a.pelvis_drop_m},
          {"trunk_pitch_rad", a.pitch_rad},
          {"trunk_roll_rad", a.roll_rad}};
}

void print_machine(const Inspection& inspection) {
  const Recording& r = inspection.recording;
  nlohmann::json out = {{"file", r.file},
                        {"format", r.format},
                        {"markers", r.markers},
                        {"frames", r.frames},
                        {"rate_hz", r.rate_hz},
                        {"rate_from", r.rate_from},
                        {"duration_s", r.duration_s()},
                        {"unit_m", r.unit_m},
                        {"unit_from", r.unit_from},
                        {"up", r.up},
                        {"leg_length_m", r.leg_length_m},
                        {"notes", r.notes}};
  out["skeleton"] = nlohmann::json::array();
  for (const Point& point : r.skeleton) out["skeleton"].push_back({{"name", point.name}, {"parent", point.parent}});
  out["joints"] = r.joints;
  for (std::size_t b = 0; b < kKeyBodies; ++b) {
    out["bodies"][kKeyBodyNames[b]] = r.bodies[b].known() ? nlohmann::json(r.bodies[b].from) : nlohmann::json();
  }
  out["activities"] = nlohmann::json::array();
  for (const Activity& activity : inspection.activities) out["activities"].push_back(activity_json(activity));
  const auto events = events_of(inspection.steps);
  for (std::size_t side = 0; side < 2; ++side) {
    out["events"][side == 0 ? "left" : "right"] = {{"contact_s", events[side].contact_s},
                                                   {"off_s", events[side].off_s}};
  }
  out["cycles"] = nlohmann::json::array();
  for (const GaitCycle& c : inspection.cycles) {
    nlohmann::json cycle = {{"foot", c.side == Side::left ? "left" : "right"},
                            {"from_s", c.from_s},
                            {"to_s", c.to_s},
                            {"loop_error_m", c.loop_error_m}};
    for (std::size_t side = 0; side < 2; ++side) {
      cycle["contact"][side == 0 ? "left" : "right"] = {{"center", c.contact[side].center},
                                                        {"duty_factor", c.contact[side].duty_factor}};
    }
    out["cycles"].push_back(cycle);
  }
  print_json(out);
}

}  // namespace

CLI::App* add_inspect(CLI::App& app, InspectOptions& options) {
  CLI::App* command =
      app.add_subcommand("inspect", "Say what a recording of a person holds: BVH, AMC, TRC, C3D, AMASS npz, robot CSV");
  command->add_option("file", options.file, "the recording")->required();
  command->add_option("--names", options.names, "table of joint and marker names; config/mocap/names.yaml if left out");
  command->add_option("--skeleton", options.skeleton, "ASF file of an AMC file; the one beside it if left out");
  command->add_option("--rest-pose", options.rest_pose, "CSV of a body model's joints at rest: joint,x,y,z in metres");
  command->add_option("--rate", options.rate_hz, "frames a second, for files that don't say")
      ->check(in_range(0.1, 1e5));
  command->add_option("--unit", options.unit_m, "metres a unit, instead of the file's or the guessed one")
      ->check(positive());
  command->add_option("--up", options.up, "the file's axis that points up; guessed if left out")
      ->check(one_of({"+x", "-x", "+y", "-y", "+z", "-z"}));
  command->add_flag("--json", options.json, "for machines");
  return command;
}

int inspect(const InspectOptions& options) {
  const Inspection inspection = inspected(options);
  options.json ? print_machine(inspection) : print_text(inspection);
  return 0;
}

}  // namespace pmg::apps
