// Robots, scenarios and the rest are found by name, from any folder.
#include "files/config_folders.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "files/config_error.hpp"
#include "folders.hpp"
#include "temporary_folder.hpp"

namespace pmg::files {
namespace {

namespace fs = std::filesystem;
using ::testing::ThrowsMessage;

class ConfigFolders : public testing::Test {
 protected:
  ~ConfigFolders() override { unsetenv("PMG_CONFIG"); }
  const test::TemporaryFolder folder_;
};

TEST_F(ConfigFolders, TheBuildTreeHasThemBesideItsBinaries) {
  const auto folders = config_folders("scenarios");
  ASSERT_EQ(folders.size(), 1U);
  EXPECT_EQ(folders.front(), fs::canonical(pmg::test::project_folder() + "/config/scenarios"))
      << "by its own name, not the link's";
}

TEST_F(ConfigFolders, TheEnvironmentsFolderGoesFirst) {
  fs::create_directories(folder_.path() / "scenarios");
  std::ofstream(folder_.path() / "scenarios/tour.yaml") << "mine";
  setenv("PMG_CONFIG", folder_.path().c_str(), 1);
  EXPECT_EQ(config_file("scenarios", "scenario", "tour"), folder_.path() / "scenarios/tour.yaml");
  EXPECT_TRUE(fs::exists(config_file("scenarios", "scenario", "stand"))) << "what it lacks comes from the others";
  setenv("PMG_CONFIG", "/nowhere", 1);
  EXPECT_THAT([] { config_folders("robots"); },
              ThrowsMessage<ConfigError>("PMG_CONFIG: '/nowhere' isn't a folder; expected the one with robots/"));
}

TEST_F(ConfigFolders, APathIsAFileAndAnUnknownNameIsRefused) {
  EXPECT_EQ(config_file("scenarios", "scenario", "folder/mine"), "folder/mine");
  EXPECT_EQ(config_file("scenarios", "scenario", "mine.yaml"), "mine.yaml");
  EXPECT_THAT([] { config_file("scenarios", "scenario", "tuor"); },
              ThrowsMessage<ConfigError>("scenario 'tuor' is neither known nor a file; did you mean tour?"));
}

}  // namespace
}  // namespace pmg::files
