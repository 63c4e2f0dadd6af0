#include "model/clip_library_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

#include "files/config_error.hpp"
#include "model/clip_library_writer.hpp"
#include "model/robots.hpp"
#include "pmg/periodic_slopes.hpp"
#include "refusal.hpp"
#include "temporary_copy.hpp"

namespace pmg::model {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

using test::kBipedFolder;

void expect_same(const DynamicClip& a, const DynamicClip& b) {
  EXPECT_EQ(a.q, b.q);
  EXPECT_EQ(a.dq_dphi, b.dq_dphi);
  EXPECT_EQ(a.period_s, b.period_s);
  EXPECT_EQ(a.contact_center, b.contact_center);
  EXPECT_EQ(a.duty_factor, b.duty_factor);
  EXPECT_EQ(a.mean_velocity, b.mean_velocity);
  EXPECT_EQ(a.half_q, b.half_q);
  EXPECT_EQ(a.half_dq_dphi, b.half_dq_dphi);
}

TEST(ClipLibrary, IsReadAsWritten) {
  const RobotModel robot = load_robot(kBipedFolder);
  ClipLibrary library = load_clip_library(kBipedFolder + "/clips", robot);
  std::mt19937 random(5);  // random digits, which no short decimal has
  std::uniform_real_distribution<double> jitter(-1e-3, 1e-3);
  for (JointVector& q : library.positive[kVx]->q) q = q.unaryExpr([&](double x) { return x + jitter(random); });
  library.positive[kVx]->dq_dphi = periodic_spline_slopes(library.positive[kVx]->q);
  for (const JointVector& q : library.positive[kVx]->q)
    library.positive[kVx]->half_q.emplace_back(library.q_stand + 0.4 * (q - library.q_stand));
  library.positive[kVx]->half_dq_dphi = periodic_spline_slopes(library.positive[kVx]->half_q);
  library.positive[kVx]->period_s = 0.8 + jitter(random);
  library.positive[kVx]->mean_velocity = {0.4 + jitter(random), jitter(random), jitter(random)};

  const TemporaryCopy copy(kBipedFolder);
  const std::filesystem::path clips = copy.file("clips");
  write_dynamic_clip(clips, "forward", *library.positive[kVx], robot, "a \"quoted\" source");
  write_dynamic_clip(clips, "backward", *library.negative[kVx], robot, "made up");
  write_static_clip(clips, "squat", kHeight, library.posture[2], robot, "made up");
  const ClipLibrary again = load_clip_library(clips, robot);
  expect_same(*again.positive[kVx], *library.positive[kVx]);
  expect_same(*again.negative[kVx], *library.negative[kVx]);
  expect_same(*again.positive[kOmega], *library.positive[kOmega]);
  EXPECT_EQ(again.posture[2].command, library.posture[2].command);
  EXPECT_EQ(again.posture[2].q, library.posture[2].q);
}

TEST(ClipLibrary, HasItsRulesAsWritten) {
  const RobotModel robot = load_robot(kBipedFolder);
  const TemporaryCopy copy(kBipedFolder);
  ClipLibrary library = load_clip_library(copy.file("clips"), robot);
  EXPECT_FALSE(library.velocity_scale.has_value());
  library.blend = Blend::kPaper;
  library.velocity_scale = VelocityScale{{0.41, 0.3, 0.7}, {0.9, 1.0 / 3.0, 0.75}};
  write_rules(copy.file("clips"), library);
  const ClipLibrary again = load_clip_library(copy.file("clips"), robot);
  EXPECT_EQ(again.blend, Blend::kPaper);
  ASSERT_TRUE(again.velocity_scale.has_value());
  EXPECT_EQ(again.velocity_scale->negative, library.velocity_scale->negative);
  EXPECT_EQ(again.velocity_scale->positive, library.velocity_scale->positive);
}

/// The correction of other clips would be believed in silence.
TEST(UnfinishedLibrary, TakesAnInverseOfTheOldClipsAwayOnlyWhenTheNewOnesAreInPlace) {
  const TemporaryCopy copy(kBipedFolder);
  const std::filesystem::path clips = copy.file("clips"), inverse = clips / "inverse.csv";
  std::ofstream(inverse) << "old";
  { const UnfinishedLibrary given_up(clips); }
  EXPECT_TRUE(std::filesystem::exists(inverse));
  const UnfinishedLibrary finished(clips);
  std::filesystem::copy(clips / "forward.csv", finished.folder());
  finished.finish();
  EXPECT_FALSE(std::filesystem::exists(inverse));
}

/// A bend of other clips would be played in silence.
TEST(UnfinishedLibrary, TakesHalfGainFilesOfTheOldClipsAway) {
  const TemporaryCopy copy(kBipedFolder);
  const std::filesystem::path clips = copy.file("clips");
  std::ofstream(clips / "forward_half.csv") << "old";
  std::ofstream(clips / "turn_half.csv") << "old";
  const UnfinishedLibrary finished(clips);
  std::ofstream(finished.folder() / "turn_half.csv") << "new";
  finished.finish();
  EXPECT_FALSE(std::filesystem::exists(clips / "forward_half.csv"));
  EXPECT_EQ(copy.read("clips/turn_half.csv"), "new");
}

TEST(ClipLibrary, NamesItsHalfGainFilesAmongItsFiles) {
  const TemporaryCopy copy(kBipedFolder);
  const std::filesystem::path clips = copy.file("clips");
  const auto count = [&] {
    const auto files = clip_library_files(clips);
    return std::ranges::count(files, clips / "backward_half.csv");
  };
  EXPECT_EQ(count(), 0);
  std::filesystem::copy(clips / "backward.csv", clips / "backward_half.csv");
  EXPECT_EQ(count(), 1);
}

TEST(ClipLibrary, CarriesTheRobotsPostureLimitsAndMirror) {
  const RobotModel robot = load_robot(kBipedFolder);
  const ClipLibrary library = load_clip_library(kBipedFolder + "/clips", robot);
  EXPECT_EQ(library.q_stand, robot.q_stand());
  EXPECT_EQ(library.q_lower, robot.q_lower());
  EXPECT_EQ(library.q_upper, robot.q_upper());
  EXPECT_EQ(library.mirror.partner, robot.mirror.partner);
  EXPECT_TRUE(library.negative[kVx].has_value());
  EXPECT_FALSE(library.negative[kVy].has_value()) << "it is mirrored";
}

TEST(ClipLibrary, TakesColumnsInAnyOrder) {
  const RobotModel robot = load_robot(kBipedFolder);
  const TemporaryCopy copy(kBipedFolder);
  // Two columns exchanged together with their names change nothing.
  std::istringstream in(copy.read("clips/turn.csv"));
  std::string out;
  for (std::string line; std::getline(in, line);) {
    const std::size_t comma = line.find(','), next = line.find(',', comma + 1);
    out += line.substr(comma + 1, next - comma - 1) + "," + line.substr(0, comma) + line.substr(next) + "\r\n";
  }
  copy.write("clips/turn.csv", out);
  EXPECT_EQ(load_clip_library(copy.file("clips"), robot).positive[kOmega]->q,
            load_clip_library(kBipedFolder + "/clips", robot).positive[kOmega]->q);
}

TEST(ClipLibrary, SlopesAreThoseOfAPeriodicSpline) {
  const int n = 40;
  std::vector<JointVector> q;
  for (int k = 0; k < n; ++k) {
    const double a = 2.0 * std::numbers::pi * k / n;
    q.push_back((JointVector(2) << std::sin(a), std::cos(2.0 * a)).finished());
  }
  const std::vector<JointVector> slopes = periodic_spline_slopes(q);
  for (int k = 0; k < n; ++k) {
    const double a = 2.0 * std::numbers::pi * k / n, w = 2.0 * std::numbers::pi;
    // Error of a cubic spline's slope: h^4 f^(5) / 180, here 2e-3 for the second harmonic.
    EXPECT_NEAR(slopes[static_cast<std::size_t>(k)][0], w * std::cos(a), 1e-4);
    EXPECT_NEAR(slopes[static_cast<std::size_t>(k)][1], -2.0 * w * std::sin(2.0 * a), 2.5e-3);
  }
}

class RefusedClips : public ::testing::Test {
 protected:
  std::string refusal() const {
    return test::refusal_by<files::ConfigError>([&] { load_clip_library(copy_.file("clips"), robot_); });
  }
  void expect(const std::string& file, int line, const std::string& key, const std::string& what) const {
    const std::string text = refusal();
    EXPECT_THAT(text, StartsWith(fmt::format("{}:{}:", copy_.file("clips/" + file).string(), line)));
    EXPECT_THAT(text, HasSubstr(": " + key + ": "));
    EXPECT_THAT(text, HasSubstr(what));
  }
  void expect_changed(const std::string& file, const std::string& old_text, const std::string& new_text,
                      const std::string& key, const std::string& what) const {
    const int line = copy_.replace("clips/" + file, old_text, new_text);
    expect(file, line, key, what);
  }
  /// Puts a text into a CSV's cell; row 0 is the header.
  void set_cell(const std::string& file, std::size_t row, std::size_t column, const std::string& text) const {
    std::istringstream in(copy_.read("clips/" + file));
    std::string out;
    std::size_t r = 0;
    for (std::string line; std::getline(in, line); ++r) {
      std::size_t start = 0;
      for (std::size_t c = 0; r == row && c < column; ++c) start = line.find(',', start) + 1;
      if (r == row) line.replace(start, std::min(line.find(',', start), line.size()) - start, text);
      out += line + "\n";
    }
    copy_.write("clips/" + file, out);
  }

  RobotModel robot_ = load_robot(kBipedFolder);
  TemporaryCopy copy_{kBipedFolder};
};

TEST_F(RefusedClips, TheUnspoiledOnesAreNot) { EXPECT_EQ(refusal(), "taken"); }

TEST_F(RefusedClips, UnknownKey) {
  expect_changed("turn.yaml", "period_s:", "speed: 1\nperiod_s:", "speed", "is unknown");
}
TEST_F(RefusedClips, VelocityScaleThatIsNone) {
  const auto expect_scale = [&](const std::string& turn, const std::string& key, const std::string& what) {
    copy_.write("clips/library.yaml",
                "blend: gain\nvelocity_scale:\n  vx_m_s: [0.5, 0.8]\n  vy_m_s: [0.3, 0.3]\n" + turn);
    const std::string text = refusal();
    EXPECT_THAT(text, HasSubstr("library.yaml:"));
    EXPECT_THAT(text, HasSubstr(key));
    EXPECT_THAT(text, HasSubstr(what));
  };
  expect_scale("", "omega_rad_s", "is missing");
  expect_scale("  omega_rad_s: [0.0, 0.8]\n", "omega_rad_s", "above 0");
  expect_scale("  omega_rad_s: 0.8\n", "omega_rad_s", "expected");
  expect_scale("  omega_rad_s: [0.8, 0.8]\n  speed: 1\n", "speed", "is unknown");
}
TEST_F(RefusedClips, MissingKey) {
  copy_.replace("clips/turn.yaml", "period_s: 0.7\n", "");
  expect("turn.yaml", 1, "period_s", "is missing");
}
TEST_F(RefusedClips, WrongType) {
  expect_changed("turn.yaml", "period_s: 0.7", "period_s: [0.7]", "period_s", "is a list");
}
TEST_F(RefusedClips, NotANumber) {
  expect_changed("turn.yaml", "period_s: 0.7", "period_s: .inf", "period_s", "is '.inf'; expected a number above 0");
}
TEST_F(RefusedClips, ContactCenterOutsideTheCycle) {
  expect_changed("turn.yaml", "left: {center: 0.3", "left: {center: 1.0", "contact.left.center", "is '1.0'");
}
TEST_F(RefusedClips, DutyFactorOfZero) {
  expect_changed("turn.yaml", "duty_factor: 0.6", "duty_factor: 0", "contact.left.duty_factor", "is '0'");
}
TEST_F(RefusedClips, ContactCentersThatDoNotFit) {
  const int line = copy_.replace("clips/turn.yaml", "right: {center: 0.8", "right: {center: 0.96");
  const std::string text = refusal();
  EXPECT_THAT(text, HasSubstr("contact.")) << text;
  EXPECT_THAT(text, HasSubstr("expected at most 0.15 of a cycle"));
  EXPECT_THAT(text, HasSubstr(".yaml:")) << line;
}
TEST_F(RefusedClips, ContactCentersAreComparedAroundTheCycle) {
  for (const std::string name : {"forward", "backward", "lateral", "turn"}) {
    const std::string center = name == "turn" ? "0.95" : "0.05";
    const std::string opposite = name == "turn" ? "0.45" : "0.55";
    copy_.replace("clips/" + name + ".yaml", "left: {center: 0.3", "left: {center: " + center);
    copy_.replace("clips/" + name + ".yaml", "right: {center: 0.8", "right: {center: " + opposite);
  }
  EXPECT_EQ(refusal(), "taken");
}
TEST_F(RefusedClips, VelocityInTheWrongDirection) {
  expect_changed("backward.yaml", "vx_m_s: -0.3", "vx_m_s: 0.3", "mean_velocity.vx_m_s", "expected a number below 0");
}
TEST_F(RefusedClips, TenSecondsInTotal) {
  const int line = copy_.replace("clips/turn.yaml", "period_s: 0.7", "period_s: 7.7");
  expect("turn.yaml", line, "period_s", "expected less than 10 s in total");
}
TEST_F(RefusedClips, WrongKind) {
  expect_changed("turn.yaml", "kind: dynamic", "kind: static", "kind", "expected dynamic");
}
TEST_F(RefusedClips, WrongChannel) {
  expect_changed("bend.yaml", "channel: pitch_rad", "channel: roll_rad", "channel", "expected pitch_rad");
}
TEST_F(RefusedClips, MissingClip) {
  std::filesystem::remove(copy_.file("clips/turn.yaml"));
  EXPECT_THAT(refusal(), StartsWith(copy_.file("clips/turn.yaml").string() + ": cannot be read"));
}
TEST_F(RefusedClips, MissingSamples) {
  std::filesystem::remove(copy_.file("clips/turn.csv"));
  EXPECT_THAT(refusal(), StartsWith(copy_.file("clips/turn.csv").string() + ": cannot be read (No such file"));
}
TEST_F(RefusedClips, HalfAnOptionalClip) {
  std::filesystem::remove(copy_.file("clips/backward.csv"));
  EXPECT_THAT(refusal(), StartsWith(copy_.file("clips/backward.csv").string() + ": cannot be read"));
}
TEST_F(RefusedClips, HalfGainOfAnotherLength) {
  std::string text = copy_.read("clips/turn.csv");
  copy_.write("clips/turn_half.csv", text.substr(0, text.rfind('\n', text.size() - 2) + 1));
  EXPECT_THAT(refusal(), AllOf(StartsWith(copy_.file("clips/turn_half.csv").string()), HasSubstr("as turn.csv")));
}
TEST_F(RefusedClips, UnknownColumn) {
  expect_changed("turn.csv", "waist_pitch", "tail", "tail", "is an unknown column");
}
TEST_F(RefusedClips, MissingColumn) {
  std::istringstream in(copy_.read("clips/turn.csv"));
  std::string out;
  for (std::string line; std::getline(in, line);) out += line.substr(line.find(',') + 1) + "\n";
  copy_.write("clips/turn.csv", out);
  expect("turn.csv", 1, "waist_pitch", "is missing");
}
TEST_F(RefusedClips, RepeatedColumn) {
  expect_changed("turn.csv", "waist_pitch", "right_knee", "right_knee", "is there twice");
}
TEST_F(RefusedClips, StaticClipWithoutCommand) {
  expect_changed("bend.csv", "command,", "", "command", "is missing; expected a column for `command` and every joint");
}
TEST_F(RefusedClips, RowOfAnotherLength) {
  set_cell("turn.csv", 3, 0, "0,0");
  EXPECT_THAT(refusal(), StartsWith(copy_.file("clips/turn.csv").string() + ":4: has 12 columns; expected 11"));
}
TEST_F(RefusedClips, SampleThatIsNotFinite) {
  set_cell("turn.csv", 5, 1, "nan");
  expect("turn.csv", 6, "right_hip_yaw", "is 'nan'; expected a finite number");
}
TEST_F(RefusedClips, SampleThatIsNotANumber) {
  set_cell("turn.csv", 5, 1, "0.1rad");
  expect("turn.csv", 6, "right_hip_yaw", "is '0.1rad'; expected a finite number");
}
TEST_F(RefusedClips, SampleOutsideTheLimits) {
  set_cell("turn.csv", 7, 1, "0.71");
  expect("turn.csv", 8, "right_hip_yaw", "is 0.71 rad; expected -0.7 to 0.7");
}
TEST_F(RefusedClips, TooFewSamples) {
  std::string text = copy_.read("clips/turn.csv");
  std::size_t end = 0;
  for (int line = 0; line < 8; ++line) end = text.find('\n', end) + 1;
  copy_.write("clips/turn.csv", text.substr(0, end));
  EXPECT_THAT(refusal(), StartsWith(copy_.file("clips/turn.csv").string() + ": has 7 samples; expected 8 to 1024"));
}
TEST_F(RefusedClips, CommandsThatDoNotIncrease) {
  set_cell("bend.csv", 3, 0, "0.0");
  expect("bend.csv", 4, "command", "strictly increasing");
}
TEST_F(RefusedClips, CommandsWithoutZero) {
  set_cell("bend.csv", 1, 0, "0.1");
  set_cell("bend.csv", 2, 0, "0.2");
  EXPECT_THAT(refusal(), HasSubstr("bend.csv: command: goes from 0.1 to 0.4; expected 0 in its range"));
}
TEST_F(RefusedClips, PostureAtZeroThatIsNotTheStandingOne) {
  set_cell("bend.csv", 2, 1, "0.01");
  expect("bend.csv", 3, "waist_pitch", "is 0.01 rad at command 0; expected 0, the standing posture");
}
TEST_F(RefusedClips, DirectoryThatIsNone) {
  std::filesystem::remove_all(copy_.file("clips"));
  EXPECT_THAT(refusal(), HasSubstr("clips: isn't a directory"));
}

}  // namespace
}  // namespace pmg::model
