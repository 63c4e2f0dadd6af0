// The bundle's hash changes with every byte that decides the controller's behaviour, and with nothing else.
#include "model/bundle.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "files/config_error.hpp"
#include "folders.hpp"

namespace pmg::model {
namespace {

namespace fs = std::filesystem;

class BundleTest : public testing::Test {
 protected:
  BundleTest() {
    fs::create_directories(folder_);
    make_robot(folder_ / "robot");
  }
  ~BundleTest() override { fs::remove_all(folder_); }

  /// The test's robot with a policy and a calibration.
  static void make_robot(const fs::path& directory) {
    fs::copy(fs::path(pmg::test::project_folder()) / "test/data/robots/biped", directory, fs::copy_options::recursive);
    fs::create_directories(directory / "policies");
    fs::create_directories(directory / "calibration");
    write(directory / "policies/walk.onnx", "weights");
    write(directory / "calibration/zeros.yaml", "left_knee: 0.01\n");
  }
  static void write(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }
  static std::string read(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static Bundle of(const fs::path& directory) {
    return bundle(load_robot(directory), directory / "clips", {directory / "policies/walk.onnx"});
  }

  fs::path folder_ = fs::temp_directory_path() / ("pmg_bundle_test_" + std::to_string(getpid()));
};

TEST_F(BundleTest, NamesEveryFileByItsRole) {
  const Bundle bundle = of(folder_ / "robot");
  std::vector<std::string> names;
  for (const auto& [name, sha256] : bundle.files) {
    names.push_back(name);
    EXPECT_EQ(sha256.size(), 64u) << name;
  }
  EXPECT_TRUE(std::ranges::is_sorted(names));
  for (const char* name : {"robot.yaml", "biped.urdf", "clips/forward.csv", "clips/forward.yaml", "clips/squat.yaml",
                           "policies/walk.onnx", "calibration/zeros.yaml"}) {
    EXPECT_TRUE(std::ranges::count(names, name) == 1) << name;
  }
  EXPECT_EQ(names.size(), 18u) << "seven clips of two files each, and four more";
}

TEST_F(BundleTest, AgreesWithSha256sum) {
  std::string lines;
  for (const auto& [name, sha256] : of(folder_ / "robot").files) lines += name + "\n";
  write(folder_ / "names", lines);
  const std::string command = "cd '" + (folder_ / "robot").string() +
                              "' && xargs sha256sum < ../names > ../sums && sha256sum < ../sums > ../sum";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(read(folder_ / "sum").substr(0, 64), of(folder_ / "robot").sha256);
}

TEST_F(BundleTest, AnyByteOfAnyFileChangesItAndOnlyThatFilesHash) {
  const fs::path robot = folder_ / "robot";
  const model::RobotModel loaded = load_robot(robot);
  const auto now = [&] { return bundle(loaded, robot / "clips", {robot / "policies/walk.onnx"}); };
  const Bundle before = now();
  for (std::size_t i = 0; i < before.files.size(); ++i) {
    const fs::path file = robot / before.files[i].first;
    const std::string text = read(file);
    std::string changed = text;
    changed.back() = changed.back() == '\n' ? ' ' : '\n';  // the last byte: nothing is cut off; YAML stays YAML
    write(file, changed);
    const Bundle after = now();
    EXPECT_NE(after.sha256, before.sha256) << file;
    for (std::size_t j = 0; j < before.files.size(); ++j) {
      EXPECT_EQ(after.files[j].second != before.files[j].second, i == j) << file << " " << before.files[j].first;
    }
    write(file, text);
  }
  EXPECT_EQ(now().sha256, before.sha256);
}

TEST_F(BundleTest, NeitherPlaceNorOrderNorStrangersChangeIt) {
  const Bundle before = of(folder_ / "robot");
  make_robot(folder_ / "elsewhere");
  EXPECT_EQ(of(folder_ / "elsewhere").sha256, before.sha256) << "another folder, other times";

  // Changes the order of directory entries: removes the files and writes them again, last one first.
  for (auto file = before.files.rbegin(); file != before.files.rend(); ++file) {
    const std::string text = read(folder_ / "robot" / file->first);
    fs::remove(folder_ / "robot" / file->first);
    write(folder_ / "robot" / file->first, text);
  }
  write(folder_ / "robot/README.md", "notes");
  write(folder_ / "robot/clips/forward.csv.bak", "old");
  write(folder_ / "robot/policies/another.onnx", "not in use");
  EXPECT_EQ(of(folder_ / "robot").sha256, before.sha256);
}

TEST_F(BundleTest, AnAddedCalibrationOrAbsentPolicyChangesIt) {
  const fs::path robot = folder_ / "robot";
  const Bundle before = of(robot);
  EXPECT_NE(bundle(load_robot(robot), robot / "clips").sha256, before.sha256);
  write(robot / "calibration/left_knee.yaml", "");
  EXPECT_NE(of(robot).sha256, before.sha256);
}

TEST_F(BundleTest, SaysWhichFileItCannotRead) {
  const fs::path robot = folder_ / "robot";
  try {
    bundle(load_robot(robot), robot / "clips", {robot / "policies/absent.onnx"});
    FAIL();
  } catch (const files::ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("absent.onnx"), std::string::npos) << error.what();
  }
}

TEST_F(BundleTest, AFileAboveItsBoundIsNotRead) {
  const fs::path robot = folder_ / "robot";
  fs::resize_file(robot / "policies/walk.onnx", std::uintmax_t{1} << 34);  // 16 GiB that the disk doesn't hold
  try {
    of(robot);
    FAIL();
  } catch (const files::ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("walk.onnx: has 1.64e+04 MiB; expected a file of a robot of 64 MiB"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace pmg::model
