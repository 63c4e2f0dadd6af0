// Each kind of data fault in measured recordings, put in after reading: real joints do more than the model knows.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "data_faults/examine.hpp"
#include "folders.hpp"

namespace pmg::data_faults {
namespace {

namespace fs = std::filesystem;
using bench::Column;
using Runs = std::vector<bench::BenchRun>;

constexpr double kDegrees = 57.29577951308232;

struct Case {
  const char* name;
  const char* folder;
  const char* filter;
  void (*spoil)(Runs& runs);
  Kind kind;
  const char* where;
};
std::ostream& operator<<(std::ostream& out, const Case& one) { return out << one.name; }

void scale_all(Runs& runs, Column column, double factor) {
  for (bench::BenchRun& run : runs) bench::correct(run, {.columns = {column}, .factor = factor});
}

constexpr const char* kServo = "kp_firmware in 4,16 and repeat == 0 and load_length_m == 0.15";
constexpr const char* kRepeated = "kp_firmware in 4,16 and load_length_m == 0.15";

// Not told there: a gain halved in half of the rows and one load in four that is 30 % too light or too heavy, both of
// the servo, which nothing explains to its noise; readings of the small servo 0.1 s early in all runs; readings of the
// axis turned, which are named with a second fault, of the recorded voltage.
const std::vector<Case>& cases() {
  static const std::vector<Case> kCases = {
      {"ServoCommandInDegrees", "sts3215", kServo,
       [](Runs& runs) { scale_all(runs, Column::kPositionCommand, kDegrees); }, Kind::kUnit, "q_cmd_rad"},
      {"ServoReadingsTurnedInOneRun", "sts3215", kServo,
       [](Runs& runs) { bench::correct(runs[5], {.columns = {Column::kPosition}, .factor = -1.0}); }, Kind::kSign,
       "q_rad"},
      {"ServoRunsSwapped", "sts3215", kServo,
       [](Runs& runs) { std::swap(runs.front().recording, runs.back().recording); }, Kind::kSwappedRuns, "runs.csv"},
      {"ServoReadingsLateInOneRun", "sts3215", kServo,
       [](Runs& runs) { bench::correct(runs[7], {.columns = {Column::kPosition}, .shift_s = -0.08}); },
       Kind::kTimeShift, "q_rad"},
      {"RepeatedServoReadingsThreeSamplesLateInOneRun", "sts3215", kRepeated,
       [](Runs& runs) {
         bench::Recording& r = runs[53].recording;
         r.q_rad = bench::shifted(r.t_s, r.q_rad, -0.03);
       },
       Kind::kTimeShift, "q_rad"},
      {"RepeatedServoRunsOfOneLoadSwapped", "sts3215", kRepeated,
       [](Runs& runs) {
         const auto other = std::ranges::find_if(runs, [&](const bench::BenchRun& run) {
           return run.trajectory == runs[53].trajectory && run.load == runs[53].load && run.kp != runs[53].kp;
         });
         std::swap(runs[53].recording, other->recording);
       },
       Kind::kSwappedRuns, "runs.csv"},
      {"RepeatedServoSupplyInTenthsOfAVolt", "sts3215", kRepeated,
       [](Runs& runs) { scale_all(runs, Column::kBus, 10.0); }, Kind::kUnit, "bus_V"},
      {"SmallServoReadingsInDegreesInOneRun", "xl330", "",
       [](Runs& runs) { bench::correct(runs[4], {.columns = {Column::kPosition}, .factor = kDegrees}); }, Kind::kUnit,
       "q_rad"},
      {"SmallServoCommandsTurned", "xl330", "", [](Runs& runs) { scale_all(runs, Column::kPositionCommand, -1.0); },
       Kind::kSign, "q_cmd_rad"},
      {"AxisCommandInMillimetres", "emps", "", [](Runs& runs) { scale_all(runs, Column::kPositionCommand, 1000.0); },
       Kind::kUnit, "q_cmd_m"},
      {"AxisVoltsAreNewtons", "emps", "", [](Runs& runs) { scale_all(runs, Column::kDriveVoltage, 35.15); },
       Kind::kUnit, "drive_V"},
      {"AxisVoltsTurned", "emps", "", [](Runs& runs) { scale_all(runs, Column::kDriveVoltage, -1.0); }, Kind::kSign,
       "drive_V"},
  };
  return kCases;
}

class MeasuredFault : public testing::TestWithParam<Case> {};

TEST_P(MeasuredFault, IsNamedWithItsPlace) {
  const Case& one = GetParam();
  const fs::path folder = fs::path(pmg::test::project_folder()) / "../shared/data/bench" / one.folder;
  if (!fs::exists(folder)) GTEST_SKIP() << "no measured recordings in " << folder;
  const bench::Bench bench = bench::read_bench(folder);
  Runs runs = bench.read_runs(bench::RowFilter(one.filter));
  one.spoil(runs);
  const std::vector<DataFault> found = find_data_faults(bench, runs, std::nullopt, {}, 1);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(name(found.front().kind), std::string(name(one.kind))) << found.front().where;
  EXPECT_NE(found.front().where.find(one.where), std::string::npos) << found.front().where;
  for (const DataFault& fault : found)
    EXPECT_EQ(&fault, &found.front()) << fault.where << ": " << fault.correction << "; " << fault.evidence.back();
}

INSTANTIATE_TEST_SUITE_P(DataFaults, MeasuredFault, testing::ValuesIn(cases()),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace pmg::data_faults
