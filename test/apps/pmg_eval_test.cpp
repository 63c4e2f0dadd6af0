// pmg_eval, used as by its users: exit codes, messages, and files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/running_program.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

class PmgEval : public testing::Test {
 protected:
  PmgEval() { fs::create_directories(folder_); }
  ~PmgEval() override { fs::remove_all(folder_); }

  test::Finished run(std::vector<std::string> arguments) {
    test::RunningProgram program("pmg_eval", std::move(arguments), folder_);
    return program.finish();
  }
  std::string out_folder(const std::string& name = "run") const { return (folder_ / name).string(); }
  std::string scenario(const std::string& seconds) {
    const fs::path file = folder_ / "scenario.yaml";
    std::ofstream(file) << "name: short\nsteps:\n  - {for_s: 0.4, text: stand, mode: stand}\n  - {for_s: " << seconds
                        << ", text: squat, mode: walk, command: {height_m: -0.05}}\n";
    return file.string();
  }
  void expect_refused(std::vector<std::string> arguments, const std::string& message) {
    arguments.insert(arguments.end(), {"--out", out_folder()});
    const test::Finished refused = run(arguments);
    EXPECT_EQ(refused.exit_code, 2) << refused.err;
    EXPECT_THAT(refused.err, HasSubstr(message));
    EXPECT_EQ(refused.out, "");
    EXPECT_FALSE(fs::exists(out_folder())) << "bad input writes nothing";
  }

  fs::path folder_ = fs::temp_directory_path() / ("pmg_eval_test_" + std::to_string(getpid()));
};

TEST_F(PmgEval, HelpHasAnExampleAndTheExitCodes) {
  const test::Finished help = run({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, HasSubstr("Examples:"));
  EXPECT_THAT(help.out, HasSubstr("Exit codes: 0"));
  for (const char* command : {"table1", "push", "robust", "gait", "steady", "jumps"})
    EXPECT_THAT(help.out, HasSubstr(command));
}

TEST_F(PmgEval, BadInputIsToldInOneLineAndWritesNothing) {
  expect_refused({"table1", "--policy", "no_such"}, "no_such");
  expect_refused({"table1", "--policy", "a=none", "--policy", "a=none"}, "there is a a already");
  expect_refused({"table1", "--policy", "=none"}, "expected NAME");
  expect_refused({"table1", "--policy", "none", "--scenario", "no/such.yaml"}, "no/such.yaml");
  expect_refused({"table1", "--policy", "none", "--variation", "no/such.yaml"}, "no/such.yaml");
  expect_refused({"table1", "--policy", "none", "--seeds", "0"}, "--seeds");
  expect_refused({"table1", "--policy", "none", "--nominal", "--variation", "a.yaml"}, "--nominal");
  expect_refused({"push", "--policy", "none", "--strengths", "10,strong"}, "--strengths");
  expect_refused({"robust", "--policy", "none", "--robot", "no_such"}, "no_such");
  expect_refused({"gait", "--policy", "none", "--norms", "no/such.csv"}, "no/such.csv");
  expect_refused({"steady", "--policy", "no_such"}, "no_such");
  expect_refused({"jumps", "--policy", "none", "--duration", "0"}, "--duration");
}

TEST_F(PmgEval, TheTableIsTheSameHoweverManyJobsAndHasAPage) {
  const auto table = [&](const std::string& jobs, const std::string& name) {
    return run({"table1", "--policy", "a=none", "--policy", "b=none", "--scenario", scenario("0.4"), "--seeds", "2",
                "--jobs", jobs, "--json", "--out", out_folder(name)});
  };
  const test::Finished one = table("1", "one"), three = table("3", "three");
  ASSERT_LE(one.exit_code, 1) << one.err;
  EXPECT_EQ(one.out, three.out);
  const json result = json::parse(one.out);
  EXPECT_EQ(result, json::parse(test::text_of(folder_ / "one/table1.json")));
  EXPECT_TRUE(result["complete"]);
  EXPECT_EQ(result["policies"].size(), 2U);
  EXPECT_EQ(result["policies"][0]["runs"].size(), 2U);
  EXPECT_EQ(result["policies"][0]["segments"][1]["text"], "squat");
  EXPECT_EQ(result["plants"].size(), 2U);
  EXPECT_EQ(result["differences"][0]["roll_rad"]["mean"], 0.0) << "the same policy under the same seeds";
  const std::string page = test::text_of(folder_ / "one/report.html");
  EXPECT_THAT(page, HasSubstr("</html>"));
  EXPECT_THAT(page, HasSubstr("yaw velocity error"));
}

TEST_F(PmgEval, PushesAreCountedByStrengthAndDirection) {
  const test::Finished push =
      run({"push", "--policy", "none", "--strengths", "0,400", "--trials", "1", "--json", "--out", out_folder()});
  ASSERT_EQ(push.exit_code, 0) << push.err;
  const json result = json::parse(push.out);
  EXPECT_EQ(result["strengths"][0]["survived"]["share"], 1.0) << "standing bears no push";
  EXPECT_EQ(result["strengths"][1]["survived"]["share"], 0.0) << "and not any";
  EXPECT_EQ(result["strengths"][1]["directions"].size(), 8U);
  EXPECT_TRUE(result["limit"]["reached"].is_null()) << "the judged strength was not tried";
  EXPECT_THAT(test::text_of(folder_ / "run/report.html"), HasSubstr("survived, all"));
}

TEST_F(PmgEval, JumpsAreReportedByRobot) {
  const test::Finished jumps = run(
      {"jumps", "--policy", "none", "--nominal", "--seeds", "2", "--duration", "5", "--json", "--out", out_folder()});
  ASSERT_EQ(jumps.exit_code, 1) << jumps.err;
  const json result = json::parse(jumps.out);
  EXPECT_EQ(result, json::parse(test::text_of(folder_ / "run/jumps.json")));
  EXPECT_EQ(result["runs"].size(), 2U);
  EXPECT_TRUE(result["variation"].is_null());
  EXPECT_THAT(test::text_of(folder_ / "run/report.html"), HasSubstr("MISSED: a robot fell or faulted"));
}

TEST_F(PmgEval, AnInterruptionKeepsWhatWasDone) {
  test::RunningProgram program("pmg_eval",
                               {"table1", "--policy", "none", "--scenario", scenario("10000"), "--seeds", "4", "--jobs",
                                "2", "--json", "--out", out_folder()},
                               folder_);
  ASSERT_TRUE(program.until([&] { return fs::exists(out_folder()); })) << program.err();
  program.send(SIGINT);
  EXPECT_EQ(program.wait(), 130) << program.err();
  const json result = json::parse(program.out());
  EXPECT_FALSE(result["complete"]);
  EXPECT_EQ(result["worth"], "interrupted");
  EXPECT_THAT(test::text_of(folder_ / "run/report.html"),
              testing::AllOf(HasSubstr("INTERRUPTED: "), testing::Not(HasSubstr("class=\"verdict good\""))));
}

}  // namespace
}  // namespace pmg
