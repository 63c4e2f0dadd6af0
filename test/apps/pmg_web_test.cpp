// pmg_web as a user runs it: pairings, its first lines, its end, and what it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/running_program.hpp"
#include "temporary_folder.hpp"

namespace pmg {
namespace {

using test::Finished;
using test::RunningProgram;
using testing::AllOf, testing::HasSubstr, testing::Not;

class PmgWeb : public testing::Test {
 protected:
  std::vector<std::string> with_folder(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--folder", folder_.file("web").string(), "--lcm-url", "memq://"});
    return arguments;
  }
  Finished run(std::vector<std::string> arguments) const {
    return RunningProgram("pmg_web", with_folder(std::move(arguments)), folder_.path()).finish();
  }
  void expect_refusal(std::vector<std::string> arguments, const std::string& words) const {
    const Finished end = run(std::move(arguments));
    EXPECT_EQ(end.exit_code, 2) << words;
    EXPECT_THAT(end.err, HasSubstr(words));
    EXPECT_EQ(std::ranges::count(end.err, '\n'), 1) << end.err;
  }
  const test::TemporaryFolder folder_;
};

TEST_F(PmgWeb, PairsListsAndRevokes) {
  const Finished paired = run({"pair", "phone"});
  EXPECT_EQ(paired.exit_code, 0);
  EXPECT_THAT(paired.out, HasSubstr("https://localhost:8443/#"));
  EXPECT_EQ(run({"list"}).out, "phone\n");
  expect_refusal({"pair", "phone"}, "revoke it first");
  EXPECT_EQ(run({"revoke", "phone"}).exit_code, 0);
  EXPECT_EQ(run({"revoke", "phone"}).exit_code, 1);
  EXPECT_EQ(run({"list"}).out, "");
}

TEST_F(PmgWeb, SaysWhereItIsAndWhatItsCertificateIsAndEndsWithCtrlC) {
  RunningProgram program("pmg_web", with_folder({"--port", "0"}), folder_.path());
  ASSERT_TRUE(program.until([&] { return program.out().find("nothing is paired") != std::string::npos; }));
  EXPECT_THAT(program.out(),
              AllOf(HasSubstr("https://localhost:"), HasSubstr("fingerprint of the certificate (SHA-256): ")));
  program.send(SIGINT);
  EXPECT_EQ(program.wait(), 0);
  EXPECT_THAT(program.out(), HasSubstr("no controller is heard on memq://"));
}

TEST_F(PmgWeb, TheCertificateIsTheSameAtTheNextStart) {
  std::vector<std::string> lines;
  for (int k = 0; k < 2; ++k) {
    std::filesystem::remove(folder_.file("pmg_web.out"));
    RunningProgram program("pmg_web", with_folder({"--port", "0"}), folder_.path());
    ASSERT_TRUE(program.until([&] { return program.out().find("nothing is paired") != std::string::npos; }));
    program.send(SIGTERM);
    EXPECT_EQ(program.wait(), 0);
    const std::string out = program.out();
    const std::size_t at = out.find("fingerprint");
    lines.push_back(out.substr(at, out.find('\n', at) - at));
  }
  EXPECT_EQ(lines[0], lines[1]);
}

TEST_F(PmgWeb, WhatItCannotUseIsSaidInOneLine) {
  expect_refusal({"--listen", "everywhere"}, "expected an IP address");
  expect_refusal({"--listen", "192.0.2.1"}, "192.0.2.1 port 8443: ");
  expect_refusal({"--port", "99999"}, "--port");
  expect_refusal({"pair", "a phone"}, "expected 1 to 15 letters");
  expect_refusal({"--keys", folder_.file("none").string()}, "none");
}

TEST_F(PmgWeb, HelpHasExamplesAndExitCodes) {
  EXPECT_THAT(run({"--help"}).out, AllOf(HasSubstr("Examples:"), HasSubstr("Exit codes: 0"),
                                         HasSubstr("not safety-rated"), HasSubstr("--listen")));
}

}  // namespace
}  // namespace pmg
