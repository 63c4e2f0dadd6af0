// The promises of pmg_clips to its callers in a shell.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "folders.hpp"
#include "temporary_folder.hpp"

namespace pmg::generator {
namespace {

struct Outcome {
  int exit_code = -1;
  std::string errors;
};

Outcome run(const std::string& arguments, const std::filesystem::path& scratch) {
  const std::filesystem::path errors = scratch / "stderr.txt";
  const int status = std::system(
      (pmg::test::program_folder() + "/pmg_clips " + arguments + " > /dev/null 2> '" + errors.string() + "'").c_str());
  std::stringstream text;
  text << std::ifstream(errors).rdbuf();
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text.str()};
}

class PmgClips : public ::testing::Test {
 protected:
  test::TemporaryFolder folder_;
  std::filesystem::path scratch_ = folder_.path();
};

TEST_F(PmgClips, RefusesAnUnknownRobotAndWritesNothing) {
  const Outcome outcome = run("synth --robot nobody --out '" + (scratch_ / "clips").string() + "'", scratch_);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.errors.find("nobody"), std::string::npos) << outcome.errors;
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "clips"));
}

TEST_F(PmgClips, RefusesAnOutputThatIsNoDirectoryBeforeItWorks) {
  const std::filesystem::path file = scratch_ / "a_file";
  std::ofstream(file) << "mine";
  const Outcome outcome = run("synth --robot z1 --out '" + (file / "clips").string() + "'", scratch_);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.errors.find("a_file"), std::string::npos) << outcome.errors;
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
  std::string content;
  std::ifstream(file) >> content;
  EXPECT_EQ(content, "mine");
}

TEST_F(PmgClips, RefusesAMissingOption) { EXPECT_EQ(run("synth --robot z1", scratch_).exit_code, 2); }

}  // namespace
}  // namespace pmg::generator
