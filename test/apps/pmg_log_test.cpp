// pmg_log, used as by its users: exit codes, messages, and files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "folders.hpp"
#include "logs/log_surgery.hpp"
#include "pmg_msgs/motor_command_t.hpp"
#include "running_program.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class PmgLog : public testing::Test {
 protected:
  PmgLog() { fs::create_directories(folder_); }
  ~PmgLog() override { fs::remove_all(folder_); }

  test::Finished run(const std::string& arguments) const { return test::run_in_shell("pmg_log " + arguments, folder_); }
  void expect_refused(const std::string& arguments, const std::string& message) const {
    const test::Finished refused = run(arguments);
    EXPECT_EQ(refused.exit_code, 2) << arguments;
    EXPECT_THAT(refused.err, HasSubstr(message)) << arguments;
    EXPECT_EQ(refused.out, "") << arguments;
  }

  fs::path folder_ = fs::temp_directory_path() / ("pmg_log_app_test_" + std::to_string(getpid()));
};

TEST_F(PmgLog, HelpHasExamplesAndTheExitCodes) {
  for (const char* command : {"--help", "info --help", "export --help", "replay --help"}) {
    const test::Finished help = run(command);
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.out, HasSubstr("Examples:")) << command;
    EXPECT_THAT(help.out, HasSubstr("Exit codes: 0")) << command;
  }
}

TEST_F(PmgLog, InfoTellsPeopleAndMachines) {
  const test::Finished text = run(std::string("info ") + test::kCommittedLog);
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("biped-7"));
  const test::Finished answer = run(std::string("info --json ") + test::kCommittedLog);
  EXPECT_EQ(nlohmann::json::parse(answer.out)["runs"][0]["robot"], "biped-7");
}

TEST_F(PmgLog, ExportWritesCsvAndMcap) {
  const fs::path csv = folder_ / "csv", mcap = folder_ / "log.mcap";
  const test::Finished done =
      run(std::string("export ") + test::kCommittedLog + " --csv " + csv.string() + " --mcap " + mcap.string());
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_TRUE(fs::exists(csv / "STATE.csv"));
  EXPECT_EQ(test::text_of(mcap).substr(1, 5), "MCAP0");
  EXPECT_THAT(done.out, HasSubstr(mcap.string()));
}

TEST_F(PmgLog, ReplaySaysInItsExitCodeWhetherItIsTheSame) {
  const fs::path spoilt = folder_ / "spoilt.lcm";
  std::int64_t ticks = 0;
  test::copy_log(test::kCommittedLog, spoilt, [&ticks](test::LogEvent& event) {
    if (event.channel != "MOTOR_COMMAND" || ++ticks != 100) return true;
    auto command = event.as<pmg_msgs::motor_command_t>();
    command.q_rad[0] += 0.001;
    event.set(command);
    return true;
  });
  const test::Finished different = run("replay " + spoilt.string());
  EXPECT_EQ(different.exit_code, 1) << different.err;
  EXPECT_THAT(different.out, HasSubstr("(tick 99) MOTOR_COMMAND q_rad."));
  EXPECT_EQ(run("replay --tolerance 0.0005 " + spoilt.string()).exit_code, 1);
  EXPECT_EQ(run("replay --tolerance 0.002 " + spoilt.string()).exit_code, 0);
  const auto answer = nlohmann::json::parse(run("replay --json " + spoilt.string()).out);
  EXPECT_EQ(answer["equal"], false);
  EXPECT_EQ(answer["first_difference"]["tick"], 99);
  EXPECT_NEAR(answer["largest_differences"]["MOTOR_COMMAND q_rad"].get<double>(), 0.001, 1e-12);

  const test::Finished same = run(std::string("replay --tolerance 1e-9 ") + test::kCommittedLog);
  EXPECT_EQ(same.exit_code, 0) << same.out << same.err;
}

TEST_F(PmgLog, BadInputIsOneClearLine) {
  expect_refused("info " + (folder_ / "absent.lcm").string(), "absent.lcm");
  expect_refused("info " + folder_.string(), "no log in this folder");
  const fs::path empty = folder_ / "empty.lcm";
  std::ofstream(empty).close();
  expect_refused("replay " + empty.string(), "no tick to replay");
  expect_refused(std::string("export ") + test::kCommittedLog, "--csv or --mcap");
  expect_refused(std::string("export ") + test::kCommittedLog + " --mcap /dev/full", "/dev/full");
  expect_refused(std::string("replay --robot z1 ") + test::kCommittedLog, "other joints");
  expect_refused(std::string("replay --tolerance -1 ") + test::kCommittedLog, "--tolerance");
}

TEST_F(PmgLog, OnceInARunOfTheSimulationReplaysBitForBit) {
  const fs::path out = folder_ / "run";
  const std::string simulate = pmg::test::program_folder() +
                               "/pmg_sil --robot config/robots/z1 --scenario config/scenarios/stand.yaml --out " +
                               out.string() + " >" + (folder_ / "sil").string() + " 2>&1";
  ASSERT_EQ(std::system(simulate.c_str()), 0) << test::text_of(folder_ / "sil");
  const test::Finished same = run("replay " + out.string());
  EXPECT_EQ(same.exit_code, 0) << same.out << same.err;
  EXPECT_THAT(same.out, HasSubstr("the same, bit for bit"));
}

TEST_F(PmgLog, ABenchReplaysWithItsExcitationAndIsRefusedWithout) {
  const fs::path excitation = folder_ / "excitation", moved = folder_ / "moved", out = folder_ / "bench";
  const std::string bin = pmg::test::program_folder() + "/", quiet = " >" + (folder_ / "said").string() + " 2>&1";
  const std::string make = bin + "pmg_calibrate_motor --make-excitation --robot z1 --joint head_pitch --seconds 4 " +
                           "--repeats 1 --gains 40,1 --out " + excitation.string() + quiet;
  ASSERT_EQ(std::system(make.c_str()), 0) << test::text_of(folder_ / "said");
  const std::string play = bin + "pmg_sil --robot z1 --bench head_pitch --excitation " + excitation.string() +
                           " --out " + out.string() + quiet;
  ASSERT_EQ(std::system(play.c_str()), 0) << test::text_of(folder_ / "said");

  const test::Finished same = run("replay " + out.string());
  EXPECT_EQ(same.exit_code, 0) << same.out << same.err;
  EXPECT_THAT(same.out, HasSubstr("the same, bit for bit"));
  fs::rename(excitation, moved);
  expect_refused("replay " + out.string(), "expected its place now in --excitation");
  EXPECT_EQ(run("replay --excitation " + moved.string() + " " + out.string()).exit_code, 0);
  std::ofstream(moved / "commands/steps.csv", std::ios::app) << "4.00,0.0\n";
  const test::Finished another = run("replay --excitation " + moved.string() + " " + out.string());
  EXPECT_EQ(another.exit_code, 1) << "a sample more";
  EXPECT_THAT(another.out, HasSubstr("the excitation of head_pitch is not the one that the log was made with"));
}

}  // namespace
}  // namespace pmg
