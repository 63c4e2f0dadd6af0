// pmg_sil, used as by its users: exit codes, messages, and files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/running_program.hpp"
#include "folders.hpp"
#include "io/log_reader.hpp"
#include "policy/linear_policy.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kStand = "config/scenarios/stand.yaml";

class PmgSil : public testing::Test {
 protected:
  PmgSil() { fs::create_directories(folder_); }
  ~PmgSil() override { fs::remove_all(folder_); }

  test::Finished run(const std::string& arguments) { return test::run_in_shell("pmg_sil " + arguments, folder_); }
  std::string out_folder() const { return (folder_ / "run").string(); }
  fs::path scenario(const std::string& yaml) {
    const fs::path file = folder_ / "scenario.yaml";
    std::ofstream(file) << yaml;
    return file;
  }
  void expect_refused(const std::string& arguments, const std::string& message) {
    const test::Finished refused = run(arguments + " --out " + out_folder());
    EXPECT_EQ(refused.exit_code, 2) << refused.err;
    EXPECT_THAT(refused.err, HasSubstr(message));
    EXPECT_EQ(refused.out, "");
    EXPECT_FALSE(fs::exists(out_folder())) << "bad input writes nothing";
  }

  fs::path folder_ = fs::temp_directory_path() / ("pmg_sil_test_" + std::to_string(getpid()));
};

TEST_F(PmgSil, HelpHasAnExampleAndTheExitCodes) {
  const test::Finished help = run("--help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, HasSubstr("Example:"));
  EXPECT_THAT(help.out, HasSubstr("Exit codes: 0"));
  EXPECT_THAT(help.out, HasSubstr("130"));
}

TEST_F(PmgSil, StandingSucceedsAndWritesItsThreeFiles) {
  const test::Finished stand = run(std::string("--scenario ") + kStand + " --out " + out_folder() + " --json");
  ASSERT_EQ(stand.exit_code, 0) << stand.out << stand.err;
  const auto summary = nlohmann::json::parse(stand.out);
  EXPECT_EQ(summary, nlohmann::json::parse(test::text_of(fs::path(out_folder()) / "summary.json")));
  EXPECT_EQ(summary["fell"], false);
  EXPECT_EQ(summary["robot"], "z1");
  EXPECT_EQ(summary["policy"], "pmg") << "robot.yaml names it";
  EXPECT_TRUE(summary["faults"].empty());
  EXPECT_NEAR(summary["duration_s"].get<double>(), 5.0, 1e-9);
  EXPECT_GT(summary["realtime_factor"].get<double>(), 0.0);
  for (const char* key : {"lin_vel_mae_m_s", "yaw_vel_mae_rad_s", "roll_mae_rad", "pitch_mae_rad", "height_mae_m"}) {
    EXPECT_TRUE(summary["tracking"][key].is_number()) << key;
  }
  for (const char* key :
       {"before_mean_m_s", "single_support_max_m_s", "double_support_mean_m_s", "double_support_p95_m_s"}) {
    EXPECT_TRUE(summary["reference_slip"][key].is_number()) << key;
  }
  for (const char* key : {"tick", "generator", "gco", "policy"}) {
    EXPECT_TRUE(summary["timing_us"][key]["p99"].is_number()) << key;
  }
  EXPECT_THAT(test::text_of(fs::path(out_folder()) / "timing.csv"), HasSubstr("time_s,tick_us"));
  io::LogReader log(fs::path(out_folder()) / "log.lcm");
  std::int64_t last_ns = 0;
  int events = 0;
  while (log.next()) {
    EXPECT_GE(log.stamp_ns(), 0);
    last_ns = std::max(last_ns, log.stamp_ns());
    ++events;
  }
  EXPECT_GT(events, 500 * 5);
  EXPECT_LE(last_ns, 5'000'000'000) << "simulation time, not the wall's";
}

TEST_F(PmgSil, TwoRunsOfOneSeedWriteTheSameLog) {
  const fs::path file =
      scenario("name: walk\nsteps:\n  - {for_s: 2.0, text: walk, mode: walk, command: {vx_m_s: 0.5}}\n");
  for (const char* name : {"a", "b"}) {
    const test::Finished walk =
        run("--policy none --gantry --seed 5 --scenario " + file.string() + " --out " + (folder_ / name).string());
    ASSERT_EQ(walk.exit_code, 0) << walk.out << walk.err;
  }
  ASSERT_GT(fs::file_size(folder_ / "a/log.lcm"), 100'000u);
  EXPECT_TRUE(test::text_of(folder_ / "a/log.lcm") == test::text_of(folder_ / "b/log.lcm"));
}

TEST_F(PmgSil, ThePolicyOfZ1WalksOnTheGround) {
  const fs::path file = scenario(
      "name: walk\nsteps:\n  - {for_s: 2.0, text: stand, mode: stand}\n"
      "  - {for_s: 6.0, text: walk, mode: walk, command: {vx_m_s: 0.5}}\n  - {for_s: 2.0, text: stand, mode: stand}\n");
  const test::Finished walk = run("--policy pmg --scenario " + file.string() + " --out " + out_folder() + " --json");
  ASSERT_EQ(walk.exit_code, 0) << walk.out << walk.err;
  const auto summary = nlohmann::json::parse(walk.out);
  EXPECT_EQ(summary["fell"], false);
  EXPECT_EQ(summary["hoisted_s"], 0.0);
  // A robot that stands still all the time has 0.3 m/s.
  EXPECT_LT(summary["tracking"]["lin_vel_mae_m_s"], 0.1);
}

TEST_F(PmgSil, ABaselineRunsLikeAnyPolicyAndIsAnnounced) {
  const test::LinearPolicyFile policy(pmg::test::project_folder() + "/config/robots/z1/clips", Variant::kSingleGait);
  const fs::path file =
      scenario("name: walk\nsteps:\n  - {for_s: 2.0, text: turn, mode: walk, command: {omega_rad_s: 0.5}}\n");
  const std::string arguments = "--gantry --policy " + policy.file().string() + " --scenario " + file.string();
  const test::Finished walk = run(arguments + " --json --out " + out_folder());
  ASSERT_EQ(walk.exit_code, 0) << walk.out << walk.err;
  EXPECT_THAT(walk.err, HasSubstr("baseline single_gait"));
  const auto summary = nlohmann::json::parse(walk.out);
  EXPECT_EQ(summary["variant"], "single_gait");
  EXPECT_GT(summary["timing_us"]["tick"]["p99"], summary["timing_us"]["policy"]["p50"]);
  const test::Finished shown = run(arguments + " --print-config");
  EXPECT_EQ(nlohmann::json::parse(shown.out)["variant"], "single_gait");
}

TEST_F(PmgSil, APolicyOfOtherClipsIsRefused) {
  expect_refused("--policy " + test::kLinearPolicy.string() + " --scenario " + kStand, "clip library is 0000");
}

TEST_F(PmgSil, AFallExitsWithOne) {
  const fs::path file = scenario("name: limp\nsteps:\n  - {for_s: 4.0, text: drives off, mode: passive}\n");
  const test::Finished limp = run("--scenario " + file.string() + " --out " + out_folder() + " --json");
  EXPECT_EQ(limp.exit_code, 1);
  EXPECT_EQ(nlohmann::json::parse(limp.out)["fell"], true);
}

TEST_F(PmgSil, BadInputExitsWithTwoAndSaysWhat) {
  expect_refused("", "--scenario is missing");
  expect_refused("--scenario absent.yaml", "absent.yaml");
  expect_refused("--robot nobody --scenario " + std::string(kStand), "nobody");
  expect_refused("--policy runner --scenario " + std::string(kStand), "--policy runner");
  expect_refused("--clips " + (folder_ / "empty").string() + " --scenario " + kStand, "empty");
  expect_refused("--scenario " + scenario("name: x\nsteps:\n  - {for_s: 1, text: a, speed: 2}\n").string(),
                 "scenario.yaml:3:");
  expect_refused("--blend both --scenario " + std::string(kStand), "--blend");
  expect_refused("--seed many --scenario " + std::string(kStand), "--seed");
  expect_refused("--frobnicate --scenario " + std::string(kStand), "--frobnicate");
  const test::Finished no_out = run(std::string("--scenario ") + kStand);
  EXPECT_EQ(no_out.exit_code, 2);
  EXPECT_THAT(no_out.err, HasSubstr("--out is missing"));
}

TEST_F(PmgSil, AnOutputFolderThatCannotBeMadeIsRefused) {
  std::ofstream(folder_ / "file") << "in the way";
  const test::Finished refused = run(std::string("--scenario ") + kStand + " --out " + (folder_ / "file/run").string());
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("file"));
}

TEST_F(PmgSil, ConfigInForceIsPrinted) {
  const test::Finished printed = run(std::string("--print-config --seed 3 --blend paper --scenario ") + kStand);
  ASSERT_EQ(printed.exit_code, 0) << printed.err;
  const auto config = nlohmann::json::parse(printed.out);
  EXPECT_EQ(config["seed"], 3);
  EXPECT_EQ(config["blend"], "paper");
  EXPECT_EQ(config["control_period_s"], 0.01);
  EXPECT_GT(config["command"]["upper"]["vx_m_s"], 0.0);
}

TEST_F(PmgSil, MjcfIsExported) {
  const fs::path file = folder_ / "z1.xml";
  const test::Finished exported = run("--export-mjcf " + file.string());
  EXPECT_EQ(exported.exit_code, 0) << exported.err;
  EXPECT_THAT(test::text_of(file), HasSubstr("<mujoco"));
}

TEST_F(PmgSil, RealTimeIsMeasuredAsLockstepIs) {
  const fs::path file = scenario(
      "name: walk\nsteps:\n  - {for_s: 1.0, text: up, mode: stand}\n"
      "  - {for_s: 1.5, text: walk, mode: walk, command: {vx_m_s: 0.4}}\n");
  const test::Finished walk =
      run("--realtime --policy none --gantry --json --scenario " + file.string() + " --out " + out_folder());
  const auto summary = nlohmann::json::parse(walk.out);
  EXPECT_EQ(walk.exit_code, 0) << summary["faults"].dump();
  // Executed ticks; a shared host may have cost some.
  EXPECT_GT(summary["duration_s"].get<double>(), 1.5);
  EXPECT_LT(summary["duration_s"].get<double>(), 2.6);
  EXPECT_GT(summary["reference_slip"]["before_mean_m_s"].get<double>(), 0.0) << "it walked";
  EXPECT_GT(summary["timing_us"]["gco"]["p99"].get<double>(), 0.0);
  EXPECT_GT(summary["punctuality"]["bus"]["wake_us"]["p99"].get<double>(), 0.0);
  EXPECT_EQ(summary["punctuality"]["dropped_records"], 0);
  EXPECT_EQ(summary["punctuality"]["realtime"].get<bool>(), summary["punctuality"]["refused"].empty());
  int states = 0, timings = 0, truths = 0;
  io::LogReader log(fs::path(out_folder()) / "log.lcm");
  while (log.next()) {
    states += log.channel() == "STATE" ? 1 : 0;
    timings += log.channel() == "TIMING" ? 1 : 0;
    truths += log.channel() == "GROUND_TRUTH" ? 1 : 0;
  }
  EXPECT_EQ(states, summary["punctuality"]["control"]["cycles"].get<int>());
  EXPECT_EQ(timings, states);
  EXPECT_EQ(truths, states);
  const test::Finished film = run("--realtime --video --scenario " + file.string() + " --out " + out_folder());
  EXPECT_EQ(film.exit_code, 2);
  EXPECT_THAT(film.err, HasSubstr("--video"));
}

TEST_F(PmgSil, InterruptKeepsWhatWasDone) {
  // Ten minutes of standing, long enough to be interrupted on any machine; the signal follows the log's first bytes.
  const fs::path file = scenario("name: long\nsteps:\n  - {for_s: 600.0, text: stand, mode: stand}\n");
  const fs::path log = fs::path(out_folder()) / "log.lcm";
  test::RunningProgram sil("pmg_sil", {"--scenario", file.string(), "--out", out_folder()}, folder_);
  std::error_code ignored;
  ASSERT_TRUE(sil.until([&] { return fs::exists(log) && fs::file_size(log, ignored) > 0; })) << sil.err();
  sil.send(SIGINT);
  EXPECT_EQ(sil.wait(), 130);
  const auto summary = nlohmann::json::parse(test::text_of(fs::path(out_folder()) / "summary.json"));
  EXPECT_EQ(summary["interrupted"], true);
  EXPECT_LT(summary["duration_s"], 600.0);
  io::LogReader reader(log);
  int events = 0;
  while (reader.next()) ++events;
  EXPECT_GT(events, 10);
}

}  // namespace
}  // namespace pmg
