// What a person does, on made-up courses of the body, and on the recordings that are there.
#include "mocap/activities.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "folders.hpp"
#include "synthetic_gait.hpp"

namespace pmg::mocap {
namespace {

std::vector<Activity> activities_of(const Recording& recording) {
  return find_activities(recording, course_of(recording), find_steps(recording));
}

TEST(Activities, AWalkHasItsSpeedAndCadenceInEveryHeadingAndSize) {
  for (const double leg_m : {0.5, 0.85, 1.0}) {
    for (const double heading_rad : {0.0, 2.0, -3.0}) {
      test::Walker walker;
      walker.leg_m = leg_m;
      walker.heading_rad = heading_rad;
      walker.period_s = 1.1 * std::sqrt(leg_m / 0.85);
      const auto activities = activities_of(test::walk(walker));
      ASSERT_EQ(activities.size(), 1U);
      EXPECT_EQ(activities[0].kind, ActivityKind::kWalkForward);
      EXPECT_NEAR(activities[0].vx_m_s, test::walking_speed(walker), 1e-3);
      EXPECT_NEAR(activities[0].vy_m_s, 0.0, 1e-3);
      // The first and the last contact lie at the recording's ends, where the swing before is cut: 3 %.
      EXPECT_NEAR(activities[0].steps_per_min, 120.0 / walker.period_s, 0.03 * 120.0 / walker.period_s);
    }
  }
}

/// A person who turns, sinks, pitches and rolls as told, on feet that rest.
Recording standing(double drop_share, double pitch_rad, double roll_rad) {
  Recording recording;
  recording.rate_hz = 50.0;
  recording.frames = 300;
  recording.leg_length_m = 0.85;
  for (std::size_t f = 0; f < recording.frames; ++f) {
    const double t_s = static_cast<double>(f) / recording.rate_hz;
    const double share = std::pow(std::sin(std::numbers::pi * std::clamp((t_s - 2.0) / 2.0, 0.0, 1.0)), 2);
    const double z = 0.9 - drop_share * 0.85 * share;
    const auto put = [&](KeyBody key, double x, double y, double height) {
      recording.bodies[static_cast<std::size_t>(key)].position_m.emplace_back(x, y, height);
    };
    put(KeyBody::pelvis, 0.0, 0.0, z);
    const Eigen::Vector3d up(std::sin(pitch_rad * share), -std::sin(roll_rad * share),
                             std::cos((pitch_rad + roll_rad) * share));
    put(KeyBody::neck, 0.5 * up.x(), 0.5 * up.y(), z + 0.5 * up.z());
    for (const double side : {1.0, -1.0}) {
      const Side of = side > 0.0 ? Side::left : Side::right;
      put(of_side(KeyBody::left_hip, of), 0.0, 0.1 * side, z);
      put(of_side(KeyBody::left_ankle, of), 0.0, 0.1 * side, 0.08);
      put(of_side(KeyBody::left_toe, of), 0.15, 0.1 * side, 0.02);
    }
  }
  return recording;
}

bool has(const std::vector<Activity>& activities, ActivityKind kind) {
  return std::ranges::any_of(activities, [kind](const Activity& a) { return a.kind == kind; });
}

TEST(Activities, TellPosturesApart) {
  const auto squat = activities_of(standing(0.5, 0.0, 0.0)), bend = activities_of(standing(0.0, 0.9, 0.0));
  const auto right = activities_of(standing(0.0, 0.0, 0.4)), left = activities_of(standing(0.0, 0.0, -0.4));
  EXPECT_TRUE(has(squat, ActivityKind::kSquat));
  EXPECT_FALSE(has(squat, ActivityKind::kBend));
  EXPECT_TRUE(has(bend, ActivityKind::kBend));
  EXPECT_FALSE(has(bend, ActivityKind::kSquat));
  EXPECT_TRUE(has(right, ActivityKind::kLeanRight));
  EXPECT_FALSE(has(right, ActivityKind::kLeanLeft));
  EXPECT_TRUE(has(left, ActivityKind::kLeanLeft));
  const auto still = activities_of(standing(0.0, 0.0, 0.0));
  ASSERT_EQ(still.size(), 1U);
  EXPECT_EQ(still[0].kind, ActivityKind::kStand);
  EXPECT_NEAR(still[0].duration_s(), 6.0, 1e-9);
}

TEST(Activities, PosturesBeginAtTheirThresholds) {
  EXPECT_TRUE(has(activities_of(standing(0.30, 0.0, 0.0)), ActivityKind::kSquat));
  EXPECT_FALSE(has(activities_of(standing(0.20, 0.0, 0.0)), ActivityKind::kSquat));
  EXPECT_TRUE(has(activities_of(standing(0.0, 0.6, 0.0)), ActivityKind::kBend));
  EXPECT_FALSE(has(activities_of(standing(0.0, 0.4, 0.0)), ActivityKind::kBend));
  EXPECT_TRUE(has(activities_of(standing(0.0, 0.0, 0.25)), ActivityKind::kLeanRight));
  EXPECT_FALSE(has(activities_of(standing(0.0, 0.0, 0.17)), ActivityKind::kLeanRight));
}

/// Six steps, the third after this pause, of a body that goes forward and turns at constant rates.
std::vector<Activity> stepping(double forward_m_s, double turning_rad_s, double pause_s) {
  Recording recording;
  recording.rate_hz = 100.0;
  recording.leg_length_m = 0.85;
  recording.frames = 700;
  BodyCourse course;
  course.standing_height_m = 0.9;
  double heading_rad = 0.0;
  Eigen::Vector3d at(0.0, 0.0, 0.9);
  for (std::size_t f = 0; f < recording.frames; ++f) {
    course.pelvis_m.push_back(at);
    course.heading_rad.push_back(heading_rad);
    at += forward_m_s / 100.0 * Eigen::Vector3d(std::cos(heading_rad), std::sin(heading_rad), 0.0);
    heading_rad += turning_rad_s / 100.0;
  }
  std::vector<Step> steps;
  double lift_s = 1.0;
  for (int i = 0; i < 6; ++i) {
    steps.push_back({i % 2 == 0 ? Side::left : Side::right, lift_s, lift_s + 0.4, 1.0});
    lift_s += 0.4 + (i == 2 ? pause_s : 0.15);
  }
  std::vector<Activity> walks = find_activities(recording, course, steps);
  std::erase_if(walks, [](const Activity& a) { return a.kind == ActivityKind::kStand; });
  return walks;
}

TEST(Activities, OfSteppingBeginAtTheirThresholds) {
  const double unit_m_s = std::sqrt(9.81 * 0.85), cycle_s = 3.75 * std::sqrt(0.85 / 9.81);
  EXPECT_EQ(stepping(0.10 * unit_m_s, 0.0, 0.15).at(0).kind, ActivityKind::kWalkForward);
  EXPECT_EQ(stepping(-0.10 * unit_m_s, 0.0, 0.15).at(0).kind, ActivityKind::kWalkBackward);
  EXPECT_EQ(stepping(0.08 * unit_m_s, 0.0, 0.15).at(0).kind, ActivityKind::kStepInPlace);
  EXPECT_EQ(stepping(0.0, 0.30 / cycle_s, 0.15).at(0).kind, ActivityKind::kTurnLeft);
  EXPECT_EQ(stepping(0.0, -0.30 / cycle_s, 0.15).at(0).kind, ActivityKind::kTurnRight);
  EXPECT_EQ(stepping(0.0, 0.23 / cycle_s, 0.15).at(0).kind, ActivityKind::kStepInPlace);
  EXPECT_EQ(stepping(0.4 * unit_m_s, 0.30 / cycle_s, 0.15).at(0).kind, ActivityKind::kCircleLeft);
  EXPECT_EQ(stepping(1.0, 0.0, 0.55 * cycle_s).size(), 1U);
  EXPECT_EQ(stepping(1.0, 0.0, 0.70 * cycle_s).size(), 2U);
}

/// Activities that a row of the manifest may show as.
std::vector<std::string> expected_kinds(const std::string& primitive) {
  if (primitive == "walk_fwd") return {"walk_forward"};
  if (primitive == "walk_back") return {"walk_backward"};
  if (primitive == "squat_lift") return {"squat"};
  if (primitive == "bend_lift" || primitive == "bend_fwd" || primitive == "lean_over") return {"bend"};
  if (primitive == "lean_side") return {"lean_left", "lean_right"};
  if (primitive == "arms") return {"stand"};
  return {primitive};
}

TEST(Activities, OfRealRecordingsAreThoseOfTheManifest) {
  const std::filesystem::path data = std::filesystem::path(pmg::test::project_folder()) / "../shared/data/mocap";
  if (!std::filesystem::exists(data / "manifest.json")) GTEST_SKIP() << "no recordings at " << data;
  const NameTable names = read_name_table(default_name_table());
  for (nlohmann::json row : nlohmann::json::parse(std::ifstream(data / "manifest.json"))) {
    const std::filesystem::path file = data / row["file"].get<std::string>();
    const std::string primitive = row["primitive"];
    SCOPED_TRACE(file.filename().string() + " " + primitive);
    const Recording recording = make_recording(file.string(), read_motion(file), names);
    EXPECT_NEAR(recording.unit_m, file.extension() == ".trc" ? 0.001 : row["scale_to_m"].get<double>(), 1e-9);
    EXPECT_EQ(recording.up, "+y");
    const double from_s = row["range"][0].get<double>() / recording.rate_hz,
                 to_s = row["range"][1].get<double>() / recording.rate_hz;
    const auto activities = activities_of(recording);
    for (const std::string& kind : expected_kinds(primitive)) {
      const Activity* found = nullptr;  // the longest within the row's range
      double longest_s = 0.0;
      for (const Activity& a : activities) {
        const double within_s = std::min(a.to_s, to_s) - std::max(a.from_s, from_s);
        if (name_of(a.kind) != kind || within_s <= longest_s) continue;
        found = &a;
        longest_s = within_s;
      }
      ASSERT_NE(found, nullptr) << kind;
      const nlohmann::json& cycle = row["one_cycle"];
      if (!cycle.is_object() || !cycle.contains("vx") || !cycle["vx"].is_number() || primitive.starts_with("turn"))
        continue;
      // The manifest's own cycle is one of the walk's: speeds vary from cycle to cycle, most at starts and stops.
      fmt::print("{} {}: vx {:.2f} (manifest's cycle {:.2f}), vy {:.2f} ({:.2f})\n", file.filename().string(), kind,
                 found->vx_m_s, cycle["vx"].get<double>(), found->vy_m_s, cycle["vy"].get<double>());
      EXPECT_NEAR(found->vx_m_s, cycle["vx"].get<double>(), 0.12);
      EXPECT_NEAR(found->vy_m_s, cycle["vy"].get<double>(), 0.12);
    }
  }
}

}  // namespace
}  // namespace pmg::mocap
