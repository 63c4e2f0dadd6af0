// pmg_report, used as by its users: exit codes, messages, and the page.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/running_program.hpp"
#include "report/small_log.hpp"
#include "temporary_folder.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class PmgReport : public testing::Test {
 protected:
  PmgReport() { fs::create_directories(folder_); }

  test::Finished run(const std::vector<std::string>& arguments) const {
    test::RunningProgram program("pmg_report", arguments, folder_);
    return program.finish();
  }
  std::string log(const std::string& name, const test::SmallLog& content = {}) const {
    content.write(folder_ / name);
    return (folder_ / name).string();
  }
  const test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.file("a report");
  const std::string page_ = (folder_ / "page.html").string();
};

TEST_F(PmgReport, WritesAPageAndSaysWhatItSaw) {
  const test::Finished done = run({log("a.lcm"), log("b.lcm", {.fault_at = 50}), "--out", page_});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out,
              testing::AllOf(HasSubstr("a.lcm: tiny, policy none"), HasSubstr("FAULT at 0.50 s"), HasSubstr(page_)));
  EXPECT_EQ(done.err, "") << "nobody watches: no progress line";
  EXPECT_THAT(test::text_of(page_), testing::StartsWith("<!doctype html>"));
}

TEST_F(PmgReport, GivesMachinesTheFigures) {
  const test::Finished done = run({log("a.lcm", {.fault_at = 50}), "--out", page_, "--json"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const auto answer = nlohmann::json::parse(done.out);
  EXPECT_EQ(answer["report"], page_);
  EXPECT_EQ(answer["runs"][0]["robot"], "tiny");
  EXPECT_EQ(answer["runs"][0]["faults"].size(), 1U);
  EXPECT_EQ(answer["runs"][0]["fell"], false);
}

// (a run that walks, and one that walks without a policy until it falls) => errors and slip in the report equal the
// summary's, digit by digit.
TEST_F(PmgReport, ItsErrorsAndItsSlipAreThoseOfTheSummary) {
  std::ofstream(folder_ / "walk.yaml") << "name: walk\nsteps:\n  - {for_s: 1.5, text: stand, mode: stand}\n"
                                       << "  - {for_s: 2.5, text: go, mode: walk, command: {vx_m_s: 0.5}}\n"
                                       << "  - {for_s: 1, text: run, command: {vx_m_s: 50}}\n";
  for (const std::string policy : {"pmg", "none"}) {
    const std::string out = (folder_ / policy).string();
    test::RunningProgram sil(
        "pmg_sil", {"--robot", "z1", "--policy", policy, "--scenario", (folder_ / "walk.yaml").string(), "--out", out},
        folder_);
    sil.wait();
    const auto summary = nlohmann::json::parse(test::text_of(fs::path(out) / "summary.json"));
    const test::Finished done = run({out, "--out", page_, "--json"});
    const auto report = nlohmann::json::parse(done.out)["runs"][0];
    EXPECT_EQ(report["fell"], summary["fell"]) << policy;
    EXPECT_GT(summary["tracking"]["followed_s"].get<double>(), 1.0) << policy;
    EXPECT_EQ(report["tracking"], summary["tracking"]) << policy;
    EXPECT_GT(summary["reference_slip"]["before_mean_m_s"].get<double>(), 0.0) << policy;
    EXPECT_EQ(report["reference_slip"], summary["reference_slip"]) << policy;
    EXPECT_EQ(report["command_cut"], summary["command_cut"]) << policy;
    EXPECT_EQ(summary["command_cut"].is_null(), policy == "none") << "without a policy it has fallen by then";
    if (policy == "pmg") {
      EXPECT_THAT(summary["command_cut"]["text"].get<std::string>(), HasSubstr("forward 50 m/s asked"));
    }
    EXPECT_EQ(report["scenario"], "walk");
    EXPECT_EQ(report["steps"].size(), 3U);
    EXPECT_EQ(report["steps"][1]["text"], "go");
    EXPECT_NEAR(report["steps"][1]["from_s"].get<double>(), 1.5, 0.011);
  }
}

TEST_F(PmgReport, KeepsWhatIsReadableOfATruncatedLog) {
  const std::string path = log("cut.lcm");
  fs::resize_file(path, fs::file_size(path) / 2);
  const test::Finished done = run({path, "--out", page_});
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_THAT(done.out, HasSubstr("its end is missing"));
  EXPECT_TRUE(fs::exists(page_));
}

TEST_F(PmgReport, RefusesBadInputInOneLine) {
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& message) {
    const test::Finished done = run(arguments);
    EXPECT_EQ(done.exit_code, 2) << message;
    EXPECT_THAT(done.err, HasSubstr(message));
    EXPECT_EQ(std::ranges::count(done.err, '\n'), 1) << done.err;
    EXPECT_EQ(done.out, "");
    EXPECT_FALSE(fs::exists(page_));
  };
  refused({(folder_ / "none.lcm").string(), "--out", page_}, "there is no such file");
  refused({(folder_).string(), "--out", page_}, "no log in this folder");
  refused({log("a.lcm"), "--out", "/dev/full"}, "can't be written");
  refused({log("a.lcm"), "--out", folder_.string()}, "is a folder; expected a file for the page, as ");
  refused({log("a.lcm"), page_}, "page.html: is no log; --out ");
  const std::string a = log("a.lcm");
  refused({a, a, a, a, a, "--out", page_}, "expected 4 at most");
}

TEST_F(PmgReport, HelpShowsAnExampleAndTheExitCodes) {
  const test::Finished done = run({"--help"});
  EXPECT_EQ(done.exit_code, 0);
  EXPECT_THAT(done.out, testing::AllOf(HasSubstr("Example:"), HasSubstr("Exit codes:")));
}

}  // namespace
}  // namespace pmg
