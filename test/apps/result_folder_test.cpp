// What an earlier command wrote stays: its folder is refused until --overwrite is given.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/running_program.hpp"
#include "temporary_folder.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class ResultFolder : public testing::Test {
 protected:
  test::Finished run(const std::string& line) const { return test::run_in_shell(line, folder_.path()); }
  std::string at(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string scenario(const std::string& name) const {
    std::ofstream(at(name + ".yaml")) << "name: " << name << "\nsteps:\n  - {for_s: 0.2, text: up, mode: stand}\n";
    return at(name + ".yaml");
  }
  /// A folder with a file of this name.
  std::string used(const std::string& name) const {
    const fs::path folder = folder_.path() / ("used_" + name);
    fs::create_directories(folder);
    std::ofstream(folder / name) << "mine\n";
    return folder.string();
  }
  /// Expects that the line, with a folder that has a file of this name in the place of DIR, is refused, and that the
  /// file stays.
  void expect_refused(std::string line, const std::string& name, const std::string& what) const {
    const std::string folder = used(name);
    line.replace(line.find("DIR"), 3, folder);
    const test::Finished refused = run(line);
    EXPECT_EQ(refused.exit_code, 2) << line;
    EXPECT_THAT(refused.err, HasSubstr(folder + ": holds " + what + " already (" + name +
                                       "); expected a new folder, or --overwrite\n"))
        << line;
    EXPECT_EQ(refused.out, "") << line;
    EXPECT_EQ(test::text_of(fs::path(folder) / name), "mine\n") << line;
  }

  const test::TemporaryFolder folder_;
};

TEST_F(ResultFolder, ARunIsNotWrittenOverAnotherOne) {
  const std::string sil = "pmg_sil --policy none --gantry --out " + at("run") + " --scenario ";
  ASSERT_EQ(run(sil + scenario("first")).exit_code, 0);
  const std::string log = test::text_of(at("run/log.lcm"));
  const test::Finished refused = run(sil + scenario("second"));
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.err,
            "pmg_sil: " + at("run") + ": holds a run already (log.lcm); expected a new folder, or --overwrite\n");
  EXPECT_TRUE(test::text_of(at("run/log.lcm")) == log);
  std::ofstream(at("run/video.mp4")) << "of the first run";
  std::ofstream(at("run/notes.txt")) << "mine";
  EXPECT_EQ(run(sil + at("absent.yaml") + " --overwrite").exit_code, 2);
  EXPECT_TRUE(test::text_of(at("run/log.lcm")) == log) << "bad input writes nothing";
  const test::Finished replaced = run(sil + scenario("second") + " --overwrite");
  ASSERT_EQ(replaced.exit_code, 0) << replaced.err;
  EXPECT_EQ(nlohmann::json::parse(test::text_of(at("run/summary.json")))["scenario"], "second");
  EXPECT_FALSE(fs::exists(at("run/video.mp4"))) << "it was of the other run";
  EXPECT_TRUE(fs::exists(at("run/notes.txt"))) << "what pmg_sil didn't write stays";
}

TEST_F(ResultFolder, EveryProgramKeepsWhatAnEarlierOneFound) {
  const std::string log = "test/data/logs/walk_fault_reset.lcm";
  for (const char* command : {"table1", "table2", "table3", "push", "robust", "gait", "steady", "jumps"}) {
    expect_refused(std::string("pmg_eval ") + command + " --out DIR", "report.html", "an evaluation");
    expect_refused(std::string("pmg_eval ") + command + " --out DIR", std::string(command) + ".json", "an evaluation");
  }
  expect_refused("pmg_calibrate_motor bench --out DIR", "fit.json", "a calibration");
  expect_refused("pmg_calibrate_zero " + log + " --out DIR", "zero.yaml", "a calibration");
  expect_refused("pmg_calibrate_zero --make-stances DIR", "robot.yaml", "a robot or a scenario");
  expect_refused("pmg_diagnose bench --out DIR", "diagnosis.json", "a diagnosis");
  expect_refused("pmg_diagnose --robot z1 " + log + " --out DIR", "diagnosis.json", "a diagnosis");
  expect_refused("pmg_diagnose --robot z1 --record DIR", "hanging.lcm", "recordings");
  expect_refused("pmg_log export " + log + " --csv DIR", "STATE.csv", "an export");
}

TEST_F(ResultFolder, AnEvaluationThatReplacesAnotherRemovesTheFilmsThatItNames) {
  const fs::path folder = used("jumps.json");
  std::ofstream(folder / "jumps.json") << R"({"films": ["pmg.mp4", "../mine.mp4", "log.lcm", 3]})";
  for (const char* name : {"pmg.mp4", "mine.mp4", "log.lcm", "../mine.mp4"}) std::ofstream(folder / name) << "a film";
  const test::Finished replaced =
      run("pmg_eval jumps --nominal --policy none --seeds 1 --duration 1 --overwrite --out " + folder.string());
  EXPECT_LE(replaced.exit_code, 1) << replaced.err;
  EXPECT_FALSE(fs::exists(folder / "pmg.mp4"));
  for (const char* name : {"mine.mp4", "log.lcm", "../mine.mp4"}) EXPECT_TRUE(fs::exists(folder / name)) << name;
}

TEST_F(ResultFolder, AnExportNeverReplacesALogAndAFileOnlyWhereAsked) {
  fs::copy("test/data/logs/walk_fault_reset.lcm", at("log.lcm"));
  const std::string before = test::text_of(at("log.lcm"));
  const std::string line = "pmg_log export " + at("log.lcm") + " --mcap ";
  for (const char* more : {"", " --overwrite"}) {
    const test::Finished refused = run(line + at("log.lcm") + more);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err, HasSubstr("log.lcm: is the log itself; expected a new file"));
    EXPECT_TRUE(test::text_of(at("log.lcm")) == before);
  }
  std::ofstream(at("a.mcap")) << "mine\n";
  EXPECT_THAT(run(line + at("a.mcap")).err, HasSubstr("a.mcap: is there already; expected a new file, or --overwrite"));
  EXPECT_EQ(test::text_of(at("a.mcap")), "mine\n");
  EXPECT_EQ(run(line + at("a.mcap") + " --overwrite").exit_code, 0);
  EXPECT_GT(fs::file_size(at("a.mcap")), 1000u);
}

TEST_F(ResultFolder, APageIsDrawnAnewOverAPageAlone) {
  fs::copy("test/data/logs/walk_fault_reset.lcm", at("log.lcm"));
  const std::string before = test::text_of(at("log.lcm")), line = "pmg_report " + at("log.lcm") + " --out ";
  const test::Finished refused = run(line + at("log.lcm"));
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("log.lcm: is there and is no page; expected a new file"));
  EXPECT_TRUE(test::text_of(at("log.lcm")) == before);
  for (int again = 0; again < 2; ++again) EXPECT_EQ(run(line + at("page.html")).exit_code, 0);
}

}  // namespace
}  // namespace pmg
