// The policy's file alone determines the controller's composition.
#include "control/control_setup.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "control/fixtures.hpp"
#include "generator_core/allocation_count.hpp"
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
    return result;
  }

  io::SimulationClock clock;
  LoadedControl loaded;
  model::RobotState state;
  std::unique_ptr<Tick> tick;
  DriveMessage drive;
  ModeRequest request;
  std::int64_t now_ns = 0;
};

TEST(ControlSetup, EveryVariantRunsAsItsFileSays) {
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
      const int yaw = test::z1().joint_index.at("left_hip_yaw");
      hip_swing_rad = std::max(hip_swing_rad, std::abs(result.reference.q[yaw] - test::z1().q_stand()[yaw]));
    }
    EXPECT_GT(ticks, 200) << to_string(variant);
    EXPECT_EQ(ticks_with_gco, variant == Variant::kPmg ? ticks : 0) << to_string(variant);
    EXPECT_NEAR(robot.tick->result().reference.command[kOmega], 0.4, 0.1) << to_string(variant);
    if (variant == Variant::kSingleGait) {
      EXPECT_LT(hip_swing_rad, 0.05) << "a forward walk turns no hip, whatever is asked";
    } else {
      EXPECT_GT(hip_swing_rad, 0.1) << to_string(variant);
    }
  }
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

}  // namespace
}  // namespace pmg::control
