// One run, one folder: logs of two runs in one folder are read as one run's, and refused.
#include "recording/run_folder.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace pmg::recording {
namespace {

namespace fs = std::filesystem;

class RunFolder : public testing::Test {
 protected:
  ~RunFolder() override { fs::remove_all(folder_); }
  void put(const std::string& file) const {
    fs::create_directories((folder_ / file).parent_path());
    std::ofstream(folder_ / file) << "x";
  }
  const fs::path folder_ = fs::temp_directory_path() / ("pmg_run_folder_" + std::to_string(getpid()));
};

TEST_F(RunFolder, OfTheFirstRunIsTheOneThatWasAskedFor) {
  EXPECT_EQ(run_folder(folder_ / "first"), folder_ / "first");
  EXPECT_FALSE(fs::exists(folder_ / "first")) << "nothing is made";
  put("first/notes.txt");
  EXPECT_EQ(run_folder(folder_ / "first"), folder_ / "first") << "what isn't a log mixes with none";
}

TEST_F(RunFolder, OfALaterRunIsNumberedOn) {
  put("first/log-0000.lcm");
  EXPECT_EQ(run_folder(folder_ / "first"), folder_ / "first-2");
  EXPECT_EQ(run_folder(folder_ / "first" / ""), folder_ / "first-2");
  put("first-2/fault-0000.lcm");
  EXPECT_EQ(run_folder(folder_ / "first"), folder_ / "first-3") << "a fault's record alone is a run's, too";
}

}  // namespace
}  // namespace pmg::recording
