// The promises of `pmg_clips inspect` to its callers in a shell.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/running_program.hpp"
#include "mocap_files/small_files.hpp"
#include "synthetic_gait.hpp"
#include "temporary_folder.hpp"
#include "written_bvh.hpp"

namespace pmg::mocap {
namespace {

class PmgClipsInspect : public ::testing::Test {
 protected:
  std::filesystem::path written(const std::string& name, const std::string& text) {
    std::ofstream(folder_.file(name), std::ios::binary) << text;
    return folder_.file(name);
  }
  pmg::test::Finished inspect(const std::filesystem::path& file, const std::string& options = "") {
    return pmg::test::run_in_shell(fmt::format("pmg_clips inspect '{}' {}", file.string(), options), folder_.path());
  }
  /// Refused in one line that names the file (or file and line) and has these words; nothing on standard output.
  void expect_refused(const std::filesystem::path& file, const std::string& place, const std::string& words,
                      const std::string& options = "") {
    const pmg::test::Finished outcome = inspect(file, options);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(file.filename().string() + place + ": "), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  }
  pmg::test::TemporaryFolder folder_;
};

TEST_F(PmgClipsInspect, TellsTheFormatTheUnitTheWalkAndItsCycle) {
  const pmg::test::Finished outcome = inspect(written("walk.bvh", test::bvh_of(test::walk({}))));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  for (const char* part : {"walk.bvh: BVH, 10 joints, 550 frames at 100 Hz (the file), 5.50 s", "unit 0.01 m", "up +y",
                           "legs 0.850 m", "walk_forward", "left foot lands: ", "cycle "}) {
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << "\n" << outcome.out;
  }
}

TEST_F(PmgClipsInspect, GivesMachinesTheSameAsJson) {
  const test::Walker walker;
  const pmg::test::Finished outcome = inspect(written("walk.bvh", test::bvh_of(test::walk(walker))), "--json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json out = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(out["format"], "BVH");
  EXPECT_EQ(out["frames"], 550);
  EXPECT_DOUBLE_EQ(out["unit_m"], 0.01);
  EXPECT_EQ(out["up"], "+y");
  EXPECT_NEAR(out["leg_length_m"], 0.85, 1e-4);
  EXPECT_EQ(out["bodies"]["left_toe"], "LeftToeBase");
  EXPECT_TRUE(out["bodies"]["left_wrist"].is_null());
  ASSERT_EQ(out["activities"].size(), 1U);
  EXPECT_EQ(out["activities"][0]["kind"], "walk_forward");
  EXPECT_NEAR(out["activities"][0]["vx_m_s"], test::walking_speed(walker), 0.01);
  ASSERT_EQ(out["cycles"].size(), 1U);
  EXPECT_NEAR(out["cycles"][0]["to_s"].get<double>() - out["cycles"][0]["from_s"].get<double>(), walker.period_s, 0.01);
  for (const char* foot : {"left", "right"}) {
    EXPECT_GE(out["events"][foot]["contact_s"].size(), 4U);
    EXPECT_GE(out["events"][foot]["off_s"].size(), 4U);
    // Phase 0 is the contact of one foot, so its contact's middle is at half its duty factor.
    if (out["cycles"][0]["foot"] == foot) {
      EXPECT_NEAR(out["cycles"][0]["contact"][foot]["center"],
                  out["cycles"][0]["contact"][foot]["duty_factor"].get<double>() / 2.0, 1e-6);
    }
  }
}

TEST_F(PmgClipsInspect, TakesWhatTheUserKnowsBetter) {
  const auto file = written("walk.bvh", test::bvh_of(test::walk({})));
  const auto out = nlohmann::json::parse(inspect(file, "--json --rate 50 --unit 0.02 --up=+y").out);
  EXPECT_DOUBLE_EQ(out["rate_hz"], 50.0);
  EXPECT_EQ(out["rate_from"], "given");
  EXPECT_NEAR(out["leg_length_m"], 1.7, 1e-3);
  ASSERT_EQ(out["notes"].size(), 1U);
  EXPECT_NE(out["notes"][0].get<std::string>().find("is the unit right?"), std::string::npos);
  EXPECT_EQ(inspect(file, "--up up").exit_code, 2);
  EXPECT_EQ(inspect(file, "--rate 0").exit_code, 2);
}

TEST_F(PmgClipsInspect, RefusesACutFileWithItsLine) {
  const std::string whole = test::bvh_of(test::walk({}));
  const std::string cut = whole.substr(0, whole.size() / 2);
  const auto lines = std::ranges::count(cut, '\n') + 1;
  const auto file = written("cut.bvh", cut);
  const pmg::test::Finished outcome = inspect(file);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
  EXPECT_NE(outcome.err.find(fmt::format("cut.bvh:{}: the file ends here", lines)), std::string::npos) << outcome.err;
}

TEST_F(PmgClipsInspect, RefusesAMissingFileAnUnknownKindAndAFolder) {
  expect_refused(folder_.file("nobody.bvh"), "", "expected a motion file");
  expect_refused(written("walk.fbx", "Kaydara"), "", ".bvh, .amc, .trc, .c3d, .npz or .csv");
  std::filesystem::create_directory(folder_.file("walk.trc"));
  expect_refused(folder_.file("walk.trc"), "", "is a folder");
  EXPECT_EQ(inspect("").exit_code, 2);
}

/// Largest memory of the programs that were started, beyond that of this one: each begins as a copy of it [bytes].
std::int64_t children_memory_bytes() {
  rusage children{}, self{};
  getrusage(RUSAGE_CHILDREN, &children);
  getrusage(RUSAGE_SELF, &self);
  return 1024 * (children.ru_maxrss - self.ru_maxrss);
}

TEST_F(PmgClipsInspect, RefusesPromisesOfTooMuchBeforeItTakesTheMemory) {
  const std::string frames = test::bvh_of(test::walk({}));
  std::string many = frames;
  many.replace(many.find("Frames: 550"), 11, "Frames: 1000000000");
  expect_refused(written("many.bvh", many), ":53", "expected the number of frames");
  many = frames;
  many.replace(many.find("Frames: 550"), 11, "Frames: 9999999");
  expect_refused(written("more.bvh", many), ":53", "9999999 frames of 10 points");
  std::string deep = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\n";
  for (int i = 0; i < 100'000; ++i) deep += "JOINT a\n{\n";
  expect_refused(written("deep.bvh", deep), ":2004", "1001 points");
  for (const std::string shape : {"(1000000000, 66)", "(4294967296, 4294967296)", "(18446744073709551615, 66)",
                                  "(99999999999999999999999, 66)", "(268435456, 66)"}) {
    expect_refused(written("shape.npz", test::zip({{"poses.npy", test::npy("<f8", shape, "")}}, true)), "",
                   "array 'poses'");
  }
  expect_refused(written("rows.npz", test::zip({{"poses.npy", test::npy("<f8", "(200000, 66)", "")}}, false)), "",
                 "13200000 numbers");
  std::string c3d = test::small_c3d(test::C3dProcessor::kIntel, -1.0F);
  for (const std::size_t at : {2U, 3U, 8U, 9U}) c3d[at] = static_cast<char>(0xff);  // points and last frame
  expect_refused(written("many.c3d", c3d), "", "65535 points");
  EXPECT_LT(children_memory_bytes(), 400 << 20);  // of which the sanitizers take most
}

TEST_F(PmgClipsInspect, AFrameOfTenSecondsTakesNoMemoryAndIsSaid) {
  std::string slow = test::bvh_of(test::walk({}));
  const std::size_t motion = slow.find("MOTION");
  const std::size_t rows = slow.find('\n', slow.find("Frame Time")) + 1;
  const std::string all = slow.substr(rows);
  std::string text = slow.substr(0, motion) + "MOTION\nFrames: 22000\nFrame Time: 10\n";
  for (int i = 0; i < 40; ++i) text += all;
  const pmg::test::Finished outcome = inspect(written("slow.bvh", text));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("is the rate right?"), std::string::npos) << outcome.out;
  EXPECT_LT(children_memory_bytes(), 400 << 20);
}

}  // namespace
}  // namespace pmg::mocap
