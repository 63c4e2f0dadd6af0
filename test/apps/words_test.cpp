// Every program's answer to --help, --version and wrong command lines: one line with the program, the wrong word, and a
// proposal.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "apps/running_program.hpp"
#include "temporary_folder.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;
using testing::StartsWith;

class Words : public testing::Test {
 protected:
  Words() { fs::create_directories(folder_); }

  /// Arguments separated by blanks.
  test::Finished run(const std::string& line) const {
    std::istringstream words(line);
    std::string program, word;
    words >> program;
    std::vector<std::string> arguments;
    while (words >> word) arguments.push_back(word);
    test::RunningProgram running(program, arguments, folder_);
    return running.finish();
  }
  /// Expects a refusal with exactly this line, and nothing on stdout.
  void expect_line(const std::string& command, const std::string& line) const {
    const test::Finished refused = run(command);
    EXPECT_EQ(refused.exit_code, 2) << command;
    EXPECT_EQ(refused.err, line + "\n") << command;
    EXPECT_EQ(refused.out, "") << command;
  }

  const test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.file("words");
};

const std::vector<std::string> kPrograms = {"pmg_bus",
                                            "pmg_calibrate_motor",
                                            "pmg_calibrate_zero",
                                            "pmg_clips",
                                            "pmg_controller",
                                            "pmg_diagnose",
                                            "pmg_doctor",
                                            "pmg_eval",
                                            "pmg_gamepad",
                                            "pmg_key",
                                            "pmg_keyboard",
                                            "pmg_log",
                                            "pmg_report",
                                            "pmg_send",
                                            "pmg_sil",
                                            "pmg_watch",
                                            "pmg_web"};

TEST_F(Words, EveryProgramTellsItsVersionAndRevision) {
  for (const std::string& program : kPrograms) {
    const test::Finished version = run(program + " --version");
    EXPECT_EQ(version.exit_code, 0) << program;
    EXPECT_THAT(version.out, MatchesRegex(program + " [0-9]+\\.[0-9]+\\.[0-9]+(\\+[0-9a-f]+(-dirty)?)?\n"));
    EXPECT_EQ(version.err, "");
  }
}

TEST_F(Words, WhoRunsARobotTellsItsBundleToo) {
  const test::Finished none = run("pmg_sil --version --robot z1 --policy none"),
                       policy = run("pmg_sil --version --robot z1 --policy pmg");
  EXPECT_THAT(none.out, HasSubstr("\nbundle "));
  EXPECT_TRUE(std::regex_search(none.out, std::regex("bundle [0-9a-f]{64} "))) << none.out;
  EXPECT_NE(none.out, policy.out) << "the policy is a part of what runs";
  EXPECT_EQ(run("pmg_controller --robot z1 --policy none --version").out.substr(15), none.out.substr(8));
  expect_line("pmg_sil --version --robot z2", "pmg_sil: robot 'z2' is neither known nor a folder; did you mean z1?");
}

TEST_F(Words, EveryHelpHasAnExampleAndItsExitCodesAndNoRangeOfThreeHundredDigits) {
  for (const std::string& program : kPrograms) {
    const test::Finished help = run(program + " --help");
    EXPECT_EQ(help.exit_code, 0) << program;
    EXPECT_THAT(help.out, HasSubstr("Example")) << program;
    EXPECT_THAT(help.out, HasSubstr("Exit codes: 0")) << program;
    EXPECT_THAT(help.out, HasSubstr("--version")) << program;
    EXPECT_THAT(help.out, Not(HasSubstr("e+308"))) << program;
    EXPECT_THAT(help.out, Not(HasSubstr("e-308"))) << program;
  }
}

TEST_F(Words, AMistypedOptionIsNamedBesideTheOneThatWasMeant) {
  for (const std::string& program : kPrograms) {
    const test::Finished refused = run(program + " --versoin");
    EXPECT_EQ(refused.exit_code, 2) << program;
    EXPECT_EQ(refused.err, program + ": --versoin: unknown option; did you mean --version?\n");
  }
  expect_line("pmg_sil --polcy pmg", "pmg_sil: --polcy: unknown option; did you mean --policy?");
  expect_line("pmg_sil --scenario=x.yaml --Out=x --sede 3", "pmg_sil: --Out: unknown option; did you mean --out?");
  expect_line("pmg_calibrate_motor bench --ou x", "pmg_calibrate_motor: --ou: unknown option; did you mean --out?");
  expect_line("pmg_sil --frobnicate", "pmg_sil: --frobnicate: unknown option (pmg_sil --help lists all)");
  expect_line("pmg_eval push --trails 3 --out x", "pmg_eval push: --trails: unknown option; did you mean --trials?");
}

TEST_F(Words, AnOptionOfAnotherCommandIsSaidToBeOne) {
  expect_line("pmg_log info x --csv y", "pmg_log info: --csv: is an option of pmg_log export");
  expect_line("pmg_clips --out x synth", "pmg_clips synth: --out: belongs after synth");
}

TEST_F(Words, AMistypedCommandIsNamedBesideTheOneThatWasMeant) {
  expect_line("pmg_log inof out", "pmg_log: inof: unknown command; did you mean info?");
  expect_line("pmg_send wlak --vx 1", "pmg_send: wlak: unknown command; did you mean walk?");
  expect_line("pmg_send stpo", "pmg_send: stpo: unknown command; did you mean stop?");
  expect_line("pmg_clips fly",
              "pmg_clips: fly: unknown command; expected one of synth, show, invert, walk, inspect, build, report, "
              "preview");
  expect_line("pmg_clips",
              "pmg_clips: a command is missing; expected one of synth, show, invert, walk, inspect, build, report, "
              "preview (pmg_clips --help shows an example)");
}

TEST_F(Words, WhatIsMissingOrTooMuchIsSaid) {
  expect_line("pmg_clips synth",
              "pmg_clips synth: --out is missing: directory for the clips (pmg_clips synth --help shows an example)");
  expect_line("pmg_clips show again",
              "pmg_clips show: 'again' is one argument too many (pmg_clips show --help shows an example)");
  expect_line("pmg_send walk vx 0.3 --for 3", "pmg_send walk: 'vx' is one argument too many; did you mean --vx?");
  expect_line("pmg_sil --robot", "pmg_sil: --robot: its value is missing");
  expect_line("pmg_send walk --vx 0.2 --vy --for 2", "pmg_send walk: --vy: its value is missing; --for follows it");
  expect_line("pmg_send walk --vy --for=2", "pmg_send walk: --vy: its value is missing; --for=2 follows it");
  expect_line("pmg_send walk --vy --fro 2", "pmg_send walk: --vy: its value is missing; --fro follows it");
  expect_line("pmg_sil --policy none --scenario stand --out --json",
              "pmg_sil: --out: its value is missing; --json follows it");
  expect_line("pmg_calibrate_motor bench --also --fit x --out y",
              "pmg_calibrate_motor: --also: its value is missing; --fit follows it");
  expect_line("pmg_calibrate_zero log --tau -M 3 --out y",
              "pmg_calibrate_zero: --tau: its value is missing; -M follows it");
  expect_line("pmg_sil --seed 1 --seed 2", "pmg_sil: --seed: is given more than once; expected it once");
  expect_line("pmg_sil --video --realtime", "pmg_sil: --realtime can't be given together with --video");
  expect_line("pmg_sil --excitation x", "pmg_sil: --excitation needs --bench");
}

TEST_F(Words, ANegativeNumberIsAValue) {
  EXPECT_THAT(run("pmg_send walk --vx -0.2 --vy 0.1 --for x").err, HasSubstr("--for: 'x' isn't a number above 0"));
}

TEST_F(Words, NoProgramTakesAnOptionForAFile) {
  for (const std::string line :
       {"pmg_bus scan --robot --version", "pmg_clips show --clips --json", "pmg_controller --hal --gantry",
        "pmg_diagnose b --out --json", "pmg_doctor --log --json", "pmg_eval gait --out --json",
        "pmg_gamepad --robot --help", "pmg_key new anna --out --keys", "pmg_keyboard --robot --lcm-url",
        "pmg_log export log --csv --json", "pmg_report log --out --json", "pmg_watch --robot --json",
        "pmg_web --robot --help"}) {
    const test::Finished refused = run(line);
    EXPECT_EQ(refused.exit_code, 2) << line;
    EXPECT_THAT(refused.err, HasSubstr(": its value is missing; --")) << line;
    EXPECT_EQ(refused.out, "") << line;
  }
  EXPECT_FALSE(fs::exists("--json"));
}

TEST_F(Words, AValueThatIsNoneSaysWhatWasExpected) {
  for (const char* value : {"-1", "0", "nan", "inf", "1e999", "long", "1s"}) {
    expect_line(std::string("pmg_send walk --for ") + value,
                std::string("pmg_send walk: --for: '") + value + "' isn't a number above 0");
  }
  for (const char* value : {"nan", "inf", "fast"}) {
    expect_line(std::string("pmg_send walk --for 1 --vx ") + value,
                std::string("pmg_send walk: --vx: '") + value + "' isn't a finite number");
  }
  expect_line("pmg_send walk --for 1 --vx 0,3",
              "pmg_send walk: --vx: '0,3' isn't a finite number; decimals come behind a point");
  expect_line("pmg_controller --hal sil --duration nan", "pmg_controller: --duration: 'nan' isn't a number above 0");
  expect_line("pmg_eval gait --out x --jobs 0", "pmg_eval gait: --jobs: '0' isn't a number from 1 to 1024");
  expect_line("pmg_diagnose --step 1", "pmg_diagnose: --step: '1' isn't a number from 1e-05 to 0.01");
  expect_line("pmg_sil --seed many", "pmg_sil: --seed: 'many' isn't a whole number of at least 0");
  expect_line("pmg_sil --seed -1 --scenario stand --out x", "pmg_sil: --seed: '-1' isn't a whole number of at least 0");
  expect_line("pmg_web --port 99999", "pmg_web: --port: '99999' isn't a number from 0 to 65535");
  expect_line("pmg_sil --blend papre", "pmg_sil: --blend: 'papre' isn't known; did you mean paper?");
  expect_line("pmg_sil --blend both",
              "pmg_sil: --blend: 'both' isn't known; expected one of library, gain, paper, corners");
}

TEST_F(Words, NamesFromAClosedListAreMatchedToTheNearest) {
  const std::string stand = " --scenario config/scenarios/stand.yaml --out " + (folder_ / "out").string();
  expect_line("pmg_sil --policy none --robot Z1" + stand,
              "pmg_sil: robot 'Z1' is neither known nor a folder; did you mean z1?");
  EXPECT_THAT(run("pmg_sil --policy pgm" + stand).err, HasSubstr("did you mean pmg?"));
  expect_line("pmg_sil --policy none --scenario config/scenarios/tuor.yaml --out x",
              "pmg_sil: config/scenarios/tuor.yaml: there is no such file; did you mean config/scenarios/tour.yaml?");
  expect_line("pmg_calibrate_motor --make-excitation --robot z1 --joint left_kne --out " + (folder_ / "out").string(),
              "pmg_calibrate_motor: --joint left_kne: z1 has no such joint; did you mean left_knee?");
  std::ofstream(folder_ / "s.yaml") << "name: x\nsteps:\n  - {for_s: 1, txt: a}\n";
  EXPECT_THAT(run("pmg_sil --policy none --scenario " + (folder_ / "s.yaml").string() + " --out x").err,
              HasSubstr("s.yaml:3:"));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

/// What people give in place of a file that they mean.
std::vector<fs::path> wrong_files(const fs::path& folder, const std::string& ending) {
  const fs::path missing = folder / ("missing" + ending), directory = folder / ("folder" + ending),
                 empty = folder / ("empty" + ending), picture = folder / ("picture" + ending);
  fs::create_directories(directory);  // and the folder of all
  std::ofstream(empty).close();
  std::ofstream(picture) << std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\1\0", 20);
  return {missing, directory, empty, picture};
}

TEST_F(Words, AFileThatIsNotWhatWasMeantIsNamedBesideWhatWasExpected) {
  const std::string out = " --out " + (folder_ / "out").string(), sil = "pmg_sil --policy none --scenario stand";
  const std::string log = "test/data/logs/walk_fault_reset.lcm";
  const std::vector<std::pair<std::string, std::string>> commands = {
      {".lcm", "pmg_log info FILE"},
      {".lcm", "pmg_log replay FILE"},
      {".lcm", "pmg_log export FILE --csv " + (folder_ / "out").string()},
      {".lcm", "pmg_report FILE" + out},
      {".lcm", "pmg_calibrate_zero FILE --robot z1" + out},
      {".lcm", "pmg_diagnose --robot z1 FILE" + out},
      {".yaml", "pmg_sil --policy none --scenario FILE" + out},
      {".yaml", sil + " --motor FILE" + out},
      {".yaml", sil + " --inject FILE" + out},
      {".yaml", sil + " --vary FILE" + out},
      {"", sil + " --robot FILE" + out},
      {".onnx", "pmg_sil --scenario stand --policy FILE" + out},
      {".png", "pmg_sil --scenario stand --policy FILE" + out},
      {"", "pmg_calibrate_motor FILE" + out},
      {"", "pmg_diagnose FILE" + out},
      {".yaml", "pmg_diagnose --robot z1 " + log + " --set-file FILE" + out},
      {".yaml", "pmg_calibrate_zero " + log + " --robot z1 --motor FILE" + out},
      {".yaml", "pmg_eval table2 --plants FILE" + out},
      {".csv", "pmg_eval gait --norms FILE" + out},
      {".bvh", "pmg_clips inspect FILE"},
      {".c3d", "pmg_clips inspect FILE"},
      {".npz", "pmg_clips inspect FILE"},
      {".yaml", "pmg_clips build FILE" + out},
      {"", "pmg_clips show --clips FILE"},
      {".csv", "pmg_clips show --norms FILE"},
      {".log", "pmg_bus replay FILE"},
      {".yaml", "pmg_gamepad --mapping FILE"},
  };
  for (const auto& [ending, command] : commands) {
    const fs::path folder = folder_ / ("of" + ending);  // a network beside a descriptor would give way to it
    for (const fs::path& file : wrong_files(folder, ending)) {
      std::string line = command;
      line.replace(line.find("FILE"), 4, file.string());
      const test::Finished refused = run(line);
      EXPECT_EQ(refused.exit_code, 2) << line << refused.err;
      EXPECT_THAT(refused.err, HasSubstr(file.string())) << line;
      EXPECT_THAT(refused.err, AnyOf(HasSubstr("; expected "), HasSubstr(": there is no such file"))) << line;
      EXPECT_THAT(refused.err, Not(HasSubstr(": ;"))) << line;
      EXPECT_THAT(refused.err, Not(HasSubstr("onnxruntime"))) << line;
      EXPECT_EQ(std::ranges::count(refused.err, '\n'), 1) << refused.err;
      EXPECT_FALSE(fs::exists(folder_ / "out")) << line;
    }
  }
}

TEST_F(Words, APictureIsSaidToBeNoText) {
  const std::string picture = wrong_files(folder_, ".yaml").back().string();
  expect_line("pmg_sil --policy none --scenario " + picture + " --out x",
              "pmg_sil: " + picture + ": isn't a text; expected a YAML file");
}

TEST_F(Words, AFileWhereAFolderIsExpectedIsSaidToBeOne) {
  std::ofstream(folder_ / "notes.txt") << "mine\n";
  const std::string notes = (folder_ / "notes.txt").string();
  expect_line("pmg_sil --policy none --scenario stand --out " + notes,
              "pmg_sil: " + notes + ": a file has this name; expected a folder, or a new name");
}

TEST_F(Words, WhichDrivesThisBuildHasIsSaid) {
  EXPECT_THAT(run("pmg_controller --help").out, HasSubstr("can, drives on CAN buses"));
#ifdef PMG_ETHERCAT
  EXPECT_THAT(run("pmg_controller --hal ethercat").err, HasSubstr("ethercat: is missing; expected a mapping"));
#else
  EXPECT_THAT(run("pmg_controller --hal ethercat").err,
              HasSubstr("this build has no EtherCAT backend (SOEM: third_party/fetch-soem)"));
#endif
  expect_line("pmg_controller --hal sli", "pmg_controller: --hal: 'sli' isn't known; did you mean sil?");
  EXPECT_THAT(run("pmg_controller --help").out, HasSubstr("sil: hang the robot in a gantry"));
  expect_line("pmg_controller --hal can --gantry",
              "pmg_controller: --gantry: is an option of --hal sil; expected none with --hal can");
  expect_line("pmg_controller --hal sil --seed many",
              "pmg_controller: --seed: 'many' isn't a whole number of at least 0");
}

}  // namespace
}  // namespace pmg
