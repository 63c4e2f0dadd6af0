// One cycle: the best one, its contacts, and ends that meet.
#include "mocap/gait_cycle.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <tuple>

#include "folders.hpp"
#include "mocap/activities.hpp"
#include "synthetic_gait.hpp"

namespace pmg::mocap {
namespace {

// The promise of a clip's seam.
constexpr double kSeam_rad = 0.02, kSeam_rad_s = 0.3;
// So fine that the differences of the samples beside the seam show its jump and not the curve's own bend.
constexpr SeamOptions kFine{.samples = 1000};

TEST(GaitCycle, IsOnePeriodWithBothFeetInTheirPhases) {
  const Recording recording = test::walk({});
  const auto cycle = best_cycle(recording, find_steps(recording), 0.0, 1e9);
  ASSERT_TRUE(cycle);
  EXPECT_NEAR(cycle->period_s(), 1.1, 0.005);
  EXPECT_LT(cycle->loop_error_m, 0.005);
  const auto own = static_cast<std::size_t>(cycle->side);
  const double apart = std::remainder(cycle->contact[own].center - cycle->contact[1 - own].center - 0.5, 1.0);
  EXPECT_NEAR(apart, 0.0, 0.01);
  for (const FootContact& contact : cycle->contact) EXPECT_NEAR(contact.duty_factor, 0.6, 0.05);
  EXPECT_NEAR(cycle->contact[own].center, cycle->contact[own].duty_factor / 2.0,
              1e-6);  // it begins with its own contact
}

TEST(GaitCycle, TheOneWithTheLeastPoseErrorIsTaken) {
  Recording recording = test::walk({});
  // The neck is off in all of the recording but in its third to fourth second.
  for (std::size_t f = 0; f < recording.frames; ++f) {
    const double t_s = static_cast<double>(f) / recording.rate_hz;
    if (t_s < 2.0 || t_s > 3.7)
      recording.bodies[static_cast<std::size_t>(KeyBody::neck)].position_m[f].y() += 0.1 * t_s;
  }
  const auto cycle = best_cycle(recording, find_steps(recording), 0.0, 1e9);
  ASSERT_TRUE(cycle);
  EXPECT_GE(cycle->from_s, 2.0);
  EXPECT_LE(cycle->to_s, 3.7);
}

TEST(GaitCycle, LiesBetweenTheTimes) {
  const Recording recording = test::walk({});
  const std::vector<Step> steps = find_steps(recording);
  for (const double from_s : {0.3, 1.3, 2.4}) {
    const auto cycle = best_cycle(recording, steps, from_s, from_s + 1.8);
    ASSERT_TRUE(cycle);
    EXPECT_GE(cycle->from_s, from_s);
    EXPECT_LE(cycle->to_s, from_s + 1.8);
  }
  EXPECT_FALSE(best_cycle(recording, steps, 1.0, 2.0));
}

/// A stiff body that turns about the vertical, with the steps of one cycle.
Recording turning_body() {
  Recording recording;
  recording.rate_hz = 100.0;
  recording.frames = 300;
  for (std::size_t f = 0; f < recording.frames; ++f) {
    const Eigen::AngleAxisd turn(0.02 * static_cast<double>(f), Eigen::Vector3d::UnitZ());
    for (const auto& [key, x, y] :
         {std::tuple{KeyBody::pelvis, 0.0, 0.0}, std::tuple{KeyBody::left_hip, 0.0, 0.1},
          std::tuple{KeyBody::right_hip, 0.0, -0.1}, std::tuple{KeyBody::left_toe, 0.3, 0.1}}) {
      recording.bodies[static_cast<std::size_t>(key)].position_m.emplace_back(turn * Eigen::Vector3d(x, y, 0.5));
    }
  }
  return recording;
}

TEST(GaitCycle, OfAPersonWhoTurnsComparesPosesInTheHeadingFrame) {
  const std::vector<Step> steps = {
      {Side::left, 0.6, 1.0, 1.0}, {Side::right, 1.1, 1.5, 1.0}, {Side::left, 1.6, 2.0, 1.0}};
  const auto cycle = best_cycle(turning_body(), steps, 0.0, 3.0);
  ASSERT_TRUE(cycle);
  EXPECT_NEAR(cycle->loop_error_m, 0.0, 1e-4);  // between frames the pose is interpolated
  EXPECT_NEAR(cycle->contact[0].duty_factor, 0.6, 1e-9);
  EXPECT_NEAR(cycle->contact[1].center, 0.8, 1e-9);
}

TEST(GaitCycle, HasOneSwingOfTheOtherFoot) {
  const std::vector<Step> two = {{Side::left, 0.6, 1.0, 1.0},
                                 {Side::right, 1.05, 1.2, 1.0},
                                 {Side::right, 1.3, 1.5, 1.0},
                                 {Side::left, 1.6, 2.0, 1.0}};
  EXPECT_FALSE(best_cycle(turning_body(), two, 0.0, 3.0));
}

TEST(GaitCycle, ClosesAnglesAndSpeedsAndKeepsTheMiddle) {
  HumanAngles angles;
  angles.rate_hz = 100.0;
  angles.names = {"drifting"};
  angles.angle_rad.resize(1);
  for (int f = 0; f <= 300; ++f) {
    const double t_s = f / 100.0;
    angles.angle_rad[0].push_back(0.5 * std::sin(5.7 * t_s) + 0.1 * t_s + 0.05 * t_s * t_s);
  }
  const GaitCycle cycle{Side::left, 0.7, 1.75, 0.0, {}};
  const ClosedCycle closed = close_cycle(angles, cycle);
  EXPECT_GT(closed.seam_before_rad, kSeam_rad);  // else there is nothing to close
  EXPECT_GT(closed.seam_before_rad_s, kSeam_rad_s);
  const SeamJump jump = seam_jump(closed.angle_rad, closed.period_s);
  EXPECT_LE(jump.angle_rad, 0.002);
  EXPECT_LE(jump.speed_rad_s, 0.05);
  const double middle_s = 0.7 + 0.525;
  EXPECT_NEAR(closed.angle_rad[0][50], 0.5 * std::sin(5.7 * middle_s) + 0.1 * middle_s + 0.05 * middle_s * middle_s,
              1e-4);
}

TEST(GaitCycle, AJumpAtTheSeamIsMeasured) {
  std::vector<double> curve;
  for (int k = 0; k < 100; ++k) curve.push_back(std::sin(2.0 * M_PI * k / 100.0) + 0.0005 * k);
  const SeamJump jump = seam_jump({curve}, 1.0);
  EXPECT_NEAR(jump.angle_rad, 0.05, 0.001);
  EXPECT_NEAR(jump.speed_rad_s, 0.0, 0.02);
}

TEST(GaitCycle, OfRealWalksCloses) {
  const std::filesystem::path data = std::filesystem::path(pmg::test::project_folder()) / "../shared/data/mocap";
  if (!std::filesystem::exists(data / "manifest.json")) GTEST_SKIP() << "no recordings at " << data;
  const NameTable names = read_name_table(default_name_table());
  for (nlohmann::json row : nlohmann::json::parse(std::ifstream(data / "manifest.json"))) {
    if (!row["one_cycle"].is_object() || !row["one_cycle"]["vx"].is_number()) continue;
    const std::filesystem::path file = data / row["file"].get<std::string>();
    SCOPED_TRACE(file.filename().string());
    const Recording recording = make_recording(file.string(), read_motion(file), names);
    const double from_s = row["range"][0].get<double>() / recording.rate_hz,
                 to_s = row["range"][1].get<double>() / recording.rate_hz;
    const auto cycle = best_cycle(recording, find_steps(recording), from_s, to_s);
    ASSERT_TRUE(cycle);
    const HumanAngles angles = human_angles(recording);
    ASSERT_GE(angles.names.size(), 10U);
    const ClosedCycle closed = close_cycle(angles, *cycle, kFine);
    const SeamJump jump = seam_jump(closed.angle_rad, closed.period_s);
    fmt::print(
        "{} {}: T {:.3f} s (manifest {:.3f}), pose {:.1f} cm ({:.1f}), duty {:.2f} {:.2f} ({:.2f}), seam {:.3f} rad "
        "{:.2f} rad/s -> {:.4f} {:.3f}, moved {:.3f} rad\n",
        file.filename().string(), row["primitive"].get<std::string>(), cycle->period_s(),
        row["one_cycle"]["T"].get<double>(), 100.0 * cycle->loop_error_m,
        100.0 * row["one_cycle"]["loop_err_m"].get<double>(), cycle->contact[0].duty_factor,
        cycle->contact[1].duty_factor, row["one_cycle"]["stance_pct"].get<double>() / 100.0, closed.seam_before_rad,
        closed.seam_before_rad_s, jump.angle_rad, jump.speed_rad_s, closed.moved_rad);
    EXPECT_LE(jump.angle_rad, kSeam_rad);
    EXPECT_LE(jump.speed_rad_s, kSeam_rad_s);
  }
}

}  // namespace
}  // namespace pmg::mocap
