// A bench is read whole or refused with one line that says what is wrong and where.
#include "bench/bench.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <optional>
#include <utility>

#include "calib/synthetic_bench.hpp"
#include "temporary_folder.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class BenchFiles : public testing::Test {
 protected:
  BenchFiles() {
    calib::JointModel model;
    model.actuator.transmission.armature_kg_m2 = 0.02;
    test::write_bench(folder_, test::record(test::pd_bench(true), model, 3));
  }

  std::string refusal(const std::string& filter = "") const {
    try {
      bench::read_bench(folder_).read_runs(bench::RowFilter(filter));
    } catch (const std::exception& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << "one line";
      return error.what();
    }
    return "accepted";
  }
  /// Every line of a recording but the header, changed.
  void change(const std::function<std::string(int row, std::vector<std::string> cells)>& edit,
              const char* header = nullptr) const {
    const fs::path file = folder_ / "runs" / "run1.csv";
    const bench::CsvTable table = bench::read_csv(file);
    std::ofstream out(file);
    out << (header != nullptr ? header : "t_s,q_cmd_rad,q_rad") << '\n';
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      const std::string line = edit(static_cast<int>(r), table.rows[r]);
      if (!line.empty()) out << line << '\n';
    }
  }
  void replace(const char* file, const std::string& from, const std::string& to) const {
    std::ifstream in(folder_ / file);
    std::string text((std::istreambuf_iterator<char>(in)), {});
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, from.size(), to);
    std::ofstream(folder_ / file) << text;
  }
  static std::string join(const std::vector<std::string>& c) { return c[0] + "," + c[1] + "," + c[2]; }

  const test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.file("a bench");
};

// Without it the fit took a gain of 1 for one of hundreds, and ended with a file.
TEST_F(BenchFiles, AColumnThatIsNearlyAKnownOneIsAskedAbout) {
  for (const auto& [meant, written] : {std::pair{"repeat", "repeats"}, std::pair{"kp_Nm_per_rad", "kp_Nm_per_rd"}}) {
    replace("runs.csv", meant, written);
    EXPECT_THAT(refusal(), AllOf(HasSubstr("runs.csv:1: column " + std::string(written)),
                                 HasSubstr("did you mean " + std::string(meant))));
    replace("runs.csv", written, meant);
  }
  replace("runs.csv", "trajectory", "day");
  EXPECT_EQ(refusal(), "accepted") << "columns of one's own are free";
}

TEST_F(BenchFiles, ATableOfAnotherSeparatorIsSaidToBeOne) {
  std::ifstream in(folder_ / "runs.csv");
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  for (const auto& [separator, name] : {std::pair{';', "semicolons"}, std::pair{'\t', "tabs"}}) {
    std::string other = text;
    std::ranges::replace(other, ',', separator);
    std::ofstream(folder_ / "runs.csv") << other;
    EXPECT_THAT(refusal(), HasSubstr(std::string("runs.csv:1: columns are parted by ") + name + "; expected commas"));
  }
}

TEST_F(BenchFiles, AFolderThatIsNoBenchIsToldWhatItIs) {
  fs::rename(folder_ / "runs", folder_ / "commands");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("is an excitation that is still to be recorded"), HasSubstr("--bench")));
  fs::remove(folder_ / "bench.yaml");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("is no bench"), HasSubstr("bench.yaml, runs.csv and runs/")));
}

TEST_F(BenchFiles, AJointIsCalledAsBenchYamlSaysOrElseAsItsFolder) {
  EXPECT_EQ(bench::read_bench(folder_).joint_name(), folder_.filename().string());
  std::ofstream(folder_ / "bench.yaml", std::ios::app) << "joint: left_knee\n";
  EXPECT_EQ(bench::read_bench(folder_).joint_name(), "left_knee");
}

TEST_F(BenchFiles, OfAServoSayItsNominalVoltageAmongRemarks) {
  const char* before = "law: position_pd";
  for (const auto& [bus_V, nominal_V] : {std::pair{"12.5", std::optional(12.5)},
                                         {"{nominal: 15, note: sags}", std::optional(15.0)},
                                         {"{nominal: unknown}", std::optional<double>()},
                                         {"{note: trust the column}", std::optional<double>()}}) {
    const std::string text = std::string("law: servo_voltage\n  bus_V: ") + bus_V;
    replace("bench.yaml", before, text);
    EXPECT_EQ(bench::read_bench(folder_).nominal_supply_V, nominal_V) << bus_V;
    replace("bench.yaml", text, before);
  }
}

TEST_F(BenchFiles, AreReadAsTheyWereWritten) {
  const bench::Bench bench = bench::read_bench(folder_);
  const std::vector<bench::BenchRun> runs = bench.read_runs(bench::RowFilter("kp_Nm_per_rad in 20 and repeat == 0"));
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[1].file, "run2.csv");
  EXPECT_EQ(runs[1].kp, 20.0);
  EXPECT_EQ(runs[1].load.gravity_Nm, 2.0);
  EXPECT_EQ(runs[1].recording.t_s.size(), 300U);
  EXPECT_EQ(runs[1].recording.dropouts(), 0U);
}

TEST_F(BenchFiles, WithoutRunsToReadAreRefused) {
  EXPECT_THAT(refusal("repeat == 7"), AllOf(HasSubstr("no run matches"), HasSubstr("repeat == 7")));
}

TEST_F(BenchFiles, WithNanAreRefused) {
  change([](int row, auto c) { return c[0] + "," + c[1] + "," + (row == 40 ? "nan" : c[2]); });
  EXPECT_THAT(refusal(), AllOf(HasSubstr("run1.csv:42"), HasSubstr("q_rad"), HasSubstr("finite")));
}

TEST_F(BenchFiles, WithAGapAreRefused) {
  change([](int row, auto c) { return row > 50 && row < 60 ? "" : join(c); });
  EXPECT_THAT(refusal(), AllOf(HasSubstr("run1.csv:53"), HasSubstr("gap of 0.1 s")));
}

TEST_F(BenchFiles, WithTimesThatRunBackwardsAreRefused) {
  change([](int row, auto c) { return row == 70 ? "0.2," + c[1] + "," + c[2] : join(c); });
  EXPECT_THAT(refusal(), AllOf(HasSubstr("run1.csv:72"), HasSubstr("increase")));
}

TEST_F(BenchFiles, WithATimeTwiceAreRefused) {
  change([](int row, auto c) { return join(c) + (row == 70 ? "\n" + join(c) : ""); });
  EXPECT_THAT(refusal(), AllOf(HasSubstr("run1.csv:73"), HasSubstr("twice")));
}

TEST_F(BenchFiles, InMillisecondsAreRefused) {
  change([](int row, auto c) { return fmt::format("{},{},{}", 10 * row, c[1], c[2]); });
  EXPECT_THAT(refusal(), AllOf(HasSubstr("t_s"), HasSubstr("seconds")));
}

TEST_F(BenchFiles, InDegreesAreRefusedByName) {
  change([](int, auto c) { return join(c); }, "t_s,q_cmd_deg,q_deg");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("q_cmd_deg"), HasSubstr("another unit"), HasSubstr("q_cmd_rad")));
}

TEST_F(BenchFiles, InDegreesAreRefusedBySize) {
  change([](int row, auto c) { return fmt::format("{},{},{}", c[0], row, c[2]); });
  EXPECT_THAT(refusal(), AllOf(HasSubstr("q_cmd_rad"), HasSubstr("degrees?")));
}

TEST_F(BenchFiles, InAnotherDeclaredUnitAreRefused) {
  replace("bench.yaml", "q: rad", "q: deg");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("bench.yaml:2"), HasSubstr("units.q"), HasSubstr("deg")));
}

TEST_F(BenchFiles, WithAConstantCommandAreRefused) {
  change([](int, auto c) { return c[0] + ",0.1," + c[2]; });
  EXPECT_THAT(refusal(), AllOf(HasSubstr("run1.csv"), HasSubstr("never changes")));
}

TEST_F(BenchFiles, ThatAreTooShortAreRefused) {
  change([](int row, auto c) { return row < 30 ? join(c) : ""; });
  EXPECT_THAT(refusal(), AllOf(HasSubstr("30 samples"), HasSubstr("at least 50")));
}

TEST_F(BenchFiles, WithAnUnknownKeyAreRefused) {
  replace("bench.yaml", "law: position_pd", "law: position_pd\n  kpp_Nm_per_rad: 3");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("bench.yaml:6"), HasSubstr("kpp_Nm_per_rad"), HasSubstr("unknown")));
}

TEST_F(BenchFiles, WithAnUnknownLoadWhoseMassSitsNowhereAreRefused) {
  std::ifstream in(folder_ / "bench.yaml");
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  const std::size_t begin = text.find("inertia_kg_m2: "), end = text.find('}', begin);
  ASSERT_NE(begin, std::string::npos);
  replace("bench.yaml", text.substr(begin, end - begin), "inertia_kg_m2: unknown, gravity_Nm: unknown");
  EXPECT_EQ(refusal(), "accepted") << "as a point mass at length_m";
  replace("bench.yaml", "length_m: 0.1, ", "");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("bench.yaml:"), HasSubstr("is unknown"), HasSubstr("expected length_m")));
}

TEST_F(BenchFiles, WithALoadThatBenchYamlDoesntHaveAreRefused) {
  replace("runs.csv", "0.8,2\n", "0.8,2.5\n");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("runs.csv:3"), HasSubstr("no such load")));
}

TEST_F(BenchFiles, MayMissASampleOfTheSensor) {
  change([](int row, auto c) { return c[0] + "," + c[1] + "," + (row == 40 ? "-3.14" : c[2]); });
  const auto runs = bench::read_bench(folder_).read_runs(bench::RowFilter(""));
  EXPECT_EQ(runs[1].recording.dropouts(), 1U);
  EXPECT_FALSE(runs[1].recording.valid[40]);
}

/// Most steps of a coarse sensor are none, and the others a whole quantum: twenty of these are more than a reading
/// leaps.
TEST_F(BenchFiles, ACoarseSensorsReadingThatLeapsAwayIsADropout) {
  constexpr double kQuantum_rad = 0.05;
  change([](int row, auto c) {
    double quanta = std::round(std::stod(c[2]) / kQuantum_rad);
    if (row == 40) quanta += 12.0;
    if (row == 60) quanta += 2.0;
    return c[0] + "," + c[1] + "," + std::to_string(kQuantum_rad * quanta);
  });
  const auto runs = bench::read_bench(folder_).read_runs(bench::RowFilter(""));
  EXPECT_FALSE(runs[1].recording.valid[40]);
  EXPECT_TRUE(runs[1].recording.valid[60]) << "two quanta are noise";
  EXPECT_EQ(runs[1].recording.dropouts(), 1U);
}

TEST_F(BenchFiles, OfASensorThatDropsOutMoreThanOnceInTwentySamplesAreRefused) {
  const auto with_one_in = [&](int rows) {
    change([&](int row, auto c) { return c[0] + "," + c[1] + "," + (row % rows == 1 ? "-3.14" : c[2]); });
    return refusal();
  };
  EXPECT_EQ(with_one_in(23), "accepted");
  EXPECT_THAT(with_one_in(13),
              AllOf(HasSubstr("run1.csv: q_rad: the sensor drops out"), HasSubstr("at most one in 20")));
}

TEST(RowFilter, SaysWhatItCannotRead) {
  for (const char* text : {"kp", "kp in", "kp ~ 3", "kp == 3 or kp == 4", "kp == 3 and", "not"}) {
    EXPECT_THROW(bench::RowFilter{text}, std::invalid_argument) << text;
  }
}

TEST(RowFilter, ComparesNumbersAsNumbersAndNamesAsNames) {
  bench::CsvTable table;
  table.file = "runs.csv";
  table.header = {"trajectory", "kp"};
  table.rows = {{"swing", "4"}, {"swing", "8.0"}, {"step", "16"}, {"step", "32"}};
  const auto kept = [&](const char* text) { return bench::RowFilter(text).keeps(table); };
  EXPECT_EQ(kept(""), (std::vector{true, true, true, true}));
  EXPECT_EQ(kept("kp in 8, 32"), (std::vector{false, true, false, true}));
  EXPECT_EQ(kept("kp not in 8,32 and trajectory==step"), (std::vector{false, false, true, false}));
  EXPECT_EQ(kept("kp>=8 and kp < 32"), (std::vector{false, true, true, false}));
  EXPECT_EQ(kept("trajectory != swing"), (std::vector{false, false, true, true}));
  EXPECT_THROW(kept("gain == 4"), std::invalid_argument);
  EXPECT_THROW(kept("trajectory < 4"), std::invalid_argument);
}

}  // namespace
}  // namespace pmg
