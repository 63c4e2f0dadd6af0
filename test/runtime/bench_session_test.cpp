// A bench made of a robot: what is refused before the robot moves, and what is written of what was recorded.
#include "runtime/bench_session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bench/bench.hpp"
#include "control/fixtures.hpp"
#include "refusal.hpp"

namespace pmg::runtime {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class BenchSessionTest : public testing::Test {
 protected:
  BenchSessionTest() { write(100.0, 40.0); }
  ~BenchSessionTest() override { fs::remove_all(folder_); }

  /// One run of 0.6 s.
  void write(double rate_hz, double kp) {
    fs::remove_all(folder_);
    bench::Excitation excitation;
    excitation.rate_hz = rate_hz;
    excitation.trajectories = {{"steps", std::vector<double>(60, -0.3)}};
    excitation.trajectories[0].q_cmd_rad[30] = -0.35;
    excitation.rows = {{"run0.csv", "steps", 0, {kp, 1.0}}};
    bench::write_excitation(folder_ / "excitation", excitation, "steps");
  }
  BenchSession session(const std::string& joint = "left_elbow") const {
    return BenchSession(robot_, joint, folder_ / "excitation", folder_ / "bench", options_);
  }
  std::string refusal(const std::string& joint = "left_elbow") const {
    return test::refusal_by<std::exception>([&] { session(joint); });
  }

  const model::RobotModel& robot_ = test::z1();
  control::TickOptions options_ = control::tick_options(test::z1());
  fs::path folder_ = fs::temp_directory_path() / ("pmg_bench_session_test_" + std::to_string(getpid()));
};

TEST_F(BenchSessionTest, APolicyIsRefusedAndNoneIsTheDefault) {
  control::ControlSetup setup;
  expect_no_policy(setup);
  EXPECT_EQ(setup.policy, "none");
  setup.policy = "pmg";
  EXPECT_THROW(expect_no_policy(setup), std::invalid_argument);
}

TEST_F(BenchSessionTest, WhatTheRobotCannotDoIsRefusedBeforeItMoves) {
  EXPECT_EQ(refusal(), "taken");
  EXPECT_THAT(refusal("left_elbo"), HasSubstr("did you mean left_elbow?"));
  options_.guard.max_kp_Nm_per_rad = 30.0;
  EXPECT_THAT(refusal(), HasSubstr("kp up to 30 Nm/rad")) << "of the guard in force";
  options_.guard = {};
  write(50.0, 40.0);
  EXPECT_THAT(refusal(), HasSubstr("expected 100, one a control tick"));
  write(100.0, 40.0);
  fs::create_directories(folder_ / "bench");
  std::ofstream(folder_ / "bench/bench.yaml") << "rig: robot\n";
  EXPECT_THAT(refusal(), HasSubstr("holds a bench already"));
}

TEST_F(BenchSessionTest, WritesTheCompleteRunsWithTheLoadOfTheHangingJoint) {
  const BenchSession session = this->session();
  ExcitationRecorder recorder = session.recorder();
  EXPECT_EQ(session.write(recorder), "0 of 1 runs of left_elbow recorded");
  EXPECT_FALSE(fs::exists(folder_ / "bench")) << "nothing is complete";
  control::TickRecord record;
  record.state = test::standing_state(robot_);
  record.result.command.q = robot_.q_stand();
  for (int sample = 0; sample < 60; ++sample) {
    record.result.excitation = {.run = 0, .sample = sample};
    record.state.stamp_ns += 10'000'000;
    record.result.command.q[session.plan().joint] = session.plan().runs[0].q_cmd_rad[static_cast<std::size_t>(sample)];
    recorder.add(record);
  }
  EXPECT_TRUE(session.whole(recorder));
  EXPECT_EQ(session.write(recorder), "1 of 1 runs of left_elbow recorded");
  const bench::Bench written = bench::read_bench(folder_ / "bench");
  EXPECT_EQ(written.joint, "left_elbow");
  const model::HangingLoad load = model::hanging_load(robot_, "left_elbow");
  EXPECT_EQ(written.loads.at(0).load.inertia_kg_m2, load.inertia_kg_m2);
  EXPECT_EQ(written.read_runs(bench::RowFilter("")).at(0).recording.q_cmd_rad, session.plan().runs[0].q_cmd_rad);
  EXPECT_GT(session.duration_s(), 0.6);
}

}  // namespace
}  // namespace pmg::runtime
