// The policy's file alone determines the controller's composition.
#include "control/control_setup.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

#include "control/fixtures.hpp"
#include "files/config_error.hpp"
#include "generator_core/allocation_count.hpp"
#include "model/bundle.hpp"
#include "model/clip_library_file.hpp"
#include "policy/descriptor_file.hpp"
#include "policy/linear_policy.hpp"

namespace pmg::control {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::filesystem::path& clips_of_z1() {
  static const std::filesystem::path clips = test::z1().directory / "clips";
  return clips;
}

ControlSetup setup_with(const std::filesystem::path& policy) {
  return {.robot = test::z1().directory.string(), .clips = {}, .policy = policy.string()};
}

/// A robot that turns while it walks, on drives that follow at once.
class TurningRobot {
 public:
  explicit TurningRobot(const ControlSetup& setup)
      : loaded(load_control(setup)), state(test::standing_state(loaded.robot)), tick(make_tick(loaded, clock)) {
    drive.source = request.source = Source::make("test", 1);
    drive.lease_s = 0.5;
    drive.command[kOmega] = 0.4;
    request.mode = Mode::kWalk;
  }
  const TickResult& step() {
    now_ns += 10'000'000;
    state.stamp_ns = drive.stamp_ns = drive.received_ns = request.stamp_ns = request.received_ns = now_ns;
    state.bus_sample += 5;
    ++drive.sequence;
    ++request.sequence;
    const TickResult& result =
        tick->step({.state = state, .now_ns = now_ns, .drives = {&drive, 1}, .requests = {&request, 1}});
    if (result.command.kp.sum() > 0.0) state.q = result.command.q;
    feet.apply({0.5, 0.5}, state);
    return result;
  }

  io::SimulationClock clock;
  LoadedControl loaded;
  test::LoadedFeet feet{test::z1()};
  model::RobotState state;
  std::unique_ptr<Tick> tick;
  DriveMessage drive;
  ModeRequest request;
  std::int64_t now_ns = 0;
};

TEST(ControlSetup, EveryVariantRunsAsItsFileSays) {
  const int yaw = test::z1().joint_index.at("left_hip_yaw");
  double forward_rad = 0.0;  // a person's hips turn in walking straight ahead; at half speed half as far
  const ClipLibrary library = model::load_clip_library(clips_of_z1(), test::z1());
  for (const JointVector& q : library.positive[kVx]->q)
    forward_rad = std::max(forward_rad, std::abs(q[yaw] - test::z1().q_stand()[yaw]));
  for (const Variant variant : {Variant::kPmg, Variant::kWithoutGco, Variant::kSingleGait}) {
    const test::LinearPolicyFile file(clips_of_z1(), variant);
    const ControlSetup setup = setup_with(file.file());
    TurningRobot robot(setup);
    EXPECT_EQ(robot.loaded.variant, variant);
    EXPECT_EQ(control_json(robot.loaded)["variant"], to_string(variant));
    int ticks_with_gco = 0, ticks = 0;
    double hip_swing_rad = 0.0;
    for (int k = 0; k < 500; ++k) {
      const TickResult& result = robot.step();
      ASSERT_EQ(result.fault.code, faults::FaultCode::kNone) << faults::describe(result.fault, test::z1());
      if (result.mode != Mode::kWalk) continue;
      ++ticks;
      ticks_with_gco += result.optimised.status != gco::Status::kNotAsked;
      if (variant != Variant::kPmg) {
        ASSERT_EQ(result.optimised.command, result.reference.command);
      }
      hip_swing_rad = std::max(hip_swing_rad, std::abs(result.reference.q[yaw] - test::z1().q_stand()[yaw]));
    }
    EXPECT_GT(ticks, 200) << to_string(variant);
    EXPECT_EQ(ticks_with_gco, variant == Variant::kPmg ? ticks : 0) << to_string(variant);
    EXPECT_NEAR(user_command(robot.tick->result().reference)[kOmega], 0.4, 0.1) << to_string(variant);
    if (variant == Variant::kSingleGait) {
      EXPECT_LT(hip_swing_rad, 0.55 * forward_rad) << "it walks forward, whatever is asked";
    } else {
      EXPECT_GT(hip_swing_rad, forward_rad) << to_string(variant);
    }
  }
}

/// A robot of robot.yaml and URDF alone, and another project's policy beside them.
class ARobotWithoutClips : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* file : {"robot.yaml", "z1.urdf"})
      std::filesystem::copy(test::z1().directory / file, robot_.path() / file);
    std::filesystem::create_directories(robot_.path() / "policies");
    policy_.emplace(robot_.path() / "policies");
  }
  ControlSetup with(const std::string& policy, const std::filesystem::path& clips = {}) const {
    return {.robot = robot_.path().string(), .clips = clips, .policy = policy};
  }
  test::TemporaryFolder robot_;
  std::optional<test::DescriptorFile> policy_;
};

TEST_F(ARobotWithoutClips, RunsAVelocityPolicyByItsDescriptor) {
  const std::filesystem::path network = robot_.path() / "policies/foreign.onnx";
  for (const std::string& name : {std::string("foreign"), policy_->file().string(), network.string()}) {
    const LoadedControl loaded = load_control(with(name));
    EXPECT_EQ(loaded.variant, Variant::kVelocity) << name;
    EXPECT_TRUE(loaded.clips.empty()) << name;
    EXPECT_EQ(loaded.library.q_stand[loaded.robot.joint_index.at("right_knee")], 0.4) << "its own posture";
    const CommandLimits& limits = loaded.options.generator.limits;
    EXPECT_EQ(limits.upper[kVx], 0.6) << "the policy's";
    EXPECT_EQ(limits.lower[kOmega], loaded.robot.command_limits.lower[kOmega]) << "robot.yaml's";
    EXPECT_EQ(limits.lower[kHeight], 0.0) << "it knows no posture";
    EXPECT_EQ(limits.upper[kPitch], 0.0) << "it knows no posture";
    for (const char* file : {"policies/foreign.yaml", "policies/foreign.onnx"})
      EXPECT_TRUE(std::ranges::any_of(loaded.files, [&](const auto& entry) { return entry.first == file; })) << file;
  }
}

TEST_F(ARobotWithoutClips, IsRefusedClipsForAPolicyThatStepsByItself) {
  try {
    load_control(with("foreign", clips_of_z1()));
    FAIL() << "they would never be played";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("--clips"), HasSubstr("steps by itself")));
  }
}

TEST_F(ARobotWithoutClips, IsToldWhatMakesThemOrDoesWithout) {
  try {
    load_control(with("none"));
    FAIL() << "it has no reference to play";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr((robot_.path() / "clips").string()), HasSubstr("pmg_clips synth"),
                                    HasSubstr("scripts/import-policy")));
  }
}

TEST_F(ARobotWithoutClips, StandsByItsReferenceAndTellsItsPolicyTheVelocities) {
  TurningRobot robot(with("foreign"));
  int ticks = 0;
  for (int k = 0; k < 300; ++k) {
    const TickResult& result = robot.step();
    if (result.mode != Mode::kWalk) continue;
    ++ticks;
    ASSERT_EQ(result.reference.q, robot.loaded.library.q_stand);
    ASSERT_EQ(result.optimised.command, result.reference.command);
    ASSERT_EQ(result.optimised.status, gco::Status::kNotAsked);
  }
  EXPECT_GT(ticks, 50);
  EXPECT_NEAR(robot.tick->result().reference.command[kOmega], 0.4, 1e-9);
  EXPECT_GT(robot.tick->result().reference.gain, 0.0) << "or Walk would end as at rest";
}

/// The same half second unsent as for a policy of this project, and the same bound of its first step.
TEST_F(ARobotWithoutClips, RefusesAVelocityPolicyThatBeginsViolently) {
  policy_->exchange("action_scale_rad: [0.25, 0.25, 0.25, 0.25", "action_scale_rad: [0.25, 0.25, 0.25, 90");
  TurningRobot robot(with("foreign"));
  faults::Fault fault;
  for (int k = 0; k < 300 && fault.code == faults::FaultCode::kNone; ++k) {
    fault = robot.step().fault;
    ASSERT_NE(robot.tick->result().maker, TargetMaker::kPolicy) << "it never gets the drives";
  }
  EXPECT_EQ(fault.code, faults::FaultCode::kActionOutOfRange);
  EXPECT_EQ(fault.joint, robot.loaded.robot.joint_index.at("right_knee"));
}

TEST(ControlSetup, EveryTickOfAWalkWithAPolicyAllocatesAsOften) {
  if (test::allocation_count() < 0) GTEST_SKIP() << "allocations can't be counted in this build";
  const test::LinearPolicyFile file(clips_of_z1(), Variant::kPmg);
  TurningRobot robot(setup_with(file.file()));
  while (robot.step().mode != Mode::kStand || robot.tick->result().maker == TargetMaker::kReferenceUnjudged)
    ASSERT_LT(robot.now_ns, 1'000'000'000);
  long each = -1;
  for (int k = 0; k < 1000; ++k) {
    if (k == 400) robot.request.mode = Mode::kStand;
    if (k == 600) robot.request.mode = Mode::kWalk;
    const long before = test::allocation_count();
    const TickResult& result = robot.step();
    const long spent = test::allocation_count() - before;
    ASSERT_TRUE(result.mode == Mode::kStand || result.mode == Mode::kWalk) << "tick " << k;
    if (each < 0) each = spent;
    ASSERT_EQ(spent, each) << "tick " << k;
  }
  EXPECT_GT(each, 0) << "the count must see ONNX Runtime's";
}

TEST(ControlSetup, AnOlderControllersLogIsReplayedWithoutWhatItDidNotName) {
  const SitDownOptions own;
  TickOptions options;
  restore_options({{"sit_down", {{"duration_s", 0.9}, {"reference_s", 0.3}}}}, options);
  EXPECT_EQ(options.generator.turn_s, 0.0);
  EXPECT_EQ(options.rehearsal.duration_s, 0.0);
  EXPECT_EQ(options.velocity_trim.gain_per_s, 0.0);
  EXPECT_EQ(options.sit_down.balanced.crouch_s, 0.9);
  EXPECT_EQ(options.sit_down.brake_factor, 1.0);
  EXPECT_EQ(options.sit_down.unbalanced.reference_s, 0.3) << "one way down, whatever happened to the policy";
  EXPECT_EQ(options.sit_down.unbalanced.crouch_s, 0.9);
  EXPECT_EQ(options.sit_down.unbalanced.ahead_share, own.balanced.ahead_share);
  TickOptions older;
  restore_options({{"supervisor", {{"stale_command_s", 0.2}}}}, older);
  EXPECT_EQ(older.sit_down.balanced.crouch_s, 0.0);
}

TEST(ControlSetup, WithoutAPolicyNoVariantIsNamed) {
  const ControlSetup setup = setup_with("none");
  const LoadedControl loaded = load_control(setup);
  EXPECT_FALSE(control_json(loaded).contains("variant"));
}

TEST(ControlSetup, APolicyOfOtherClipsIsRefusedByName) {
  try {
    load_control(setup_with(test::kLinearPolicy));
    FAIL() << "it was trained on no clips at all";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr(test::kLinearPolicy.string()), HasSubstr("clip library"),
                                    HasSubstr(test::kNoClips), HasSubstr(model::clip_library_sha256(clips_of_z1()))));
  }
}

/// A robot with a second policy whose clips stand in the folder of its name: another person's style.
class ARobotOfTwoStyles : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(own_clips_);
    for (const auto& entry : std::filesystem::directory_iterator(clips_of_z1()))
      std::filesystem::copy(entry.path(), own_clips_ / entry.path().filename());
    std::ofstream(own_clips_ / "library.yaml")
        << "blend: gain\nvelocity_scale: {vx_m_s: [0.5, 0.9], vy_m_s: [0.35, 0.35], omega_rad_s: [0.8, 0.8]}\n";
    for (const char* file : {"robot.yaml", "z1.urdf"})
      std::filesystem::copy(test::z1().directory / file, robot_.path() / file);
    std::filesystem::copy(clips_of_z1(), robot_.path() / "clips");
    const test::LinearPolicyFile own(own_clips_, Variant::kPmg), common(clips_of_z1(), Variant::kPmg);
    std::filesystem::copy(own.file(), robot_.path() / "policies/person.onnx");
    std::filesystem::copy(common.file(), robot_.path() / "policies/pmg.onnx");
  }
  ControlSetup with(const std::string& policy, const std::filesystem::path& clips = {}) const {
    return {.robot = robot_.path().string(), .clips = clips, .policy = policy};
  }
  /// Every row of the own posture clips has this joint's angle less so much.
  void lower(const std::string& joint, double by_rad) const {
    for (const char* name : model::kPostureNames) {
      const std::filesystem::path file = own_clips_ / (std::string(name) + ".csv");
      std::ifstream before(file);
      std::string text, line, field;
      std::getline(before, line);
      text = line + '\n';
      const auto column = std::ranges::count(line.substr(0, line.find(joint)), ',');
      while (std::getline(before, line)) {
        std::istringstream fields(line);
        for (std::ptrdiff_t i = 0; std::getline(fields, field, ','); ++i)
          text += fmt::format("{}{:.17g}", i > 0 ? "," : "", std::stod(field) - (i == column ? by_rad : 0.0));
        text += '\n';
      }
      std::ofstream(file) << text;
    }
  }
  test::TemporaryFolder robot_;
  std::filesystem::path own_clips_ = robot_.path() / "policies/person/clips";
};

TEST_F(ARobotOfTwoStyles, AFilesNameInPlaceOfAPolicysIsUnderstood) {
  for (const char* name : {"persn", "person.onnx"}) {
    try {
      load_control(with(name));
      ADD_FAILURE() << name;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("did you mean person?"), std::string::npos) << error.what();
    }
  }
}

TEST_F(ARobotOfTwoStyles, RunsAPolicyOnTheClipsBesideIt) {
  const LoadedControl person = load_control(with("person")),
                      by_file = load_control(with((robot_.path() / "policies/person.onnx").string()));
  for (const LoadedControl* loaded : {&person, &by_file}) {
    EXPECT_EQ(loaded->clips, own_clips_);
    ASSERT_TRUE(loaded->library.velocity_scale.has_value());
    EXPECT_EQ(loaded->library.velocity_scale->positive[kVx], 0.9);
  }
  EXPECT_EQ(control_json(person)["clips"], own_clips_.string());
  // Both policies without a name of their own: robot.yaml's, and none.
  for (const char* name : {"", "none"}) EXPECT_EQ(load_control(with(name)).clips, robot_.path() / "clips") << name;
  EXPECT_NE(person.bundle, load_control(with("pmg")).bundle);
}

TEST_F(ARobotOfTwoStyles, StandsAsThePolicysOwnClipsStand) {
  constexpr double kLower_rad = 0.02;  // of both knees, at every command of the posture clips
  lower("left_knee", kLower_rad);
  lower("right_knee", kLower_rad);
  const LoadedControl common = load_control(with("pmg"));
  const model::RobotModel robot = load_robot(with("person"));
  JointVector expected = common.robot.q_stand();
  for (const char* knee : {"left_knee", "right_knee"}) expected[robot.joint_index.at(knee)] -= kLower_rad;
  EXPECT_LT((robot.q_stand() - expected).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(robot.q_sit_down()[robot.joint_index.at("left_knee")], robot.q_stand()[robot.joint_index.at("left_knee")]);
  EXPECT_GT(std::abs(robot.standing_height_m - common.robot.standing_height_m), 1e-5);
  // The policy beside them was trained on other clips, and says so; another's clips named by hand don't move the robot.
  EXPECT_THROW(load_control(with("person")), std::invalid_argument);
  EXPECT_EQ(load_robot(with("person", robot_.path() / "clips")).q_stand(), common.robot.q_stand());
  const LoadedControl none = load_control({.robot = robot_.path().string(), .clips = {}, .policy = "none"});
  EXPECT_EQ(none.robot.q_stand(), common.robot.q_stand());
}

TEST_F(ARobotOfTwoStyles, RefusesOwnClipsThatStandOnOneBentLeg) {
  lower("left_knee", 0.02);
  try {
    load_robot(with("person"));
    FAIL();
  } catch (const files::ConfigError& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("bend.csv"), HasSubstr("left_knee"), HasSubstr("mirror image of right_knee")));
  }
}

TEST_F(ARobotOfTwoStyles, RefusesAPolicyOnTheOthersClips) {
  for (const auto& [policy, clips] : {std::pair("person", robot_.path() / "clips"), std::pair("pmg", own_clips_)}) {
    try {
      load_control(with(policy, clips));
      FAIL() << policy;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr(std::string(policy) + ".onnx"), HasSubstr("other clips")));
    }
  }
}

}  // namespace
}  // namespace pmg::control
