// scripts/import-bench makes the three measured benches anew of files as a logger writes them: other separators, other
// units, no description. The measured recordings are no part of the project: where they aren't there, this is skipped.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "bench/bench.hpp"
#include "folders.hpp"
#include "recorded_benches.hpp"
#include "temporary_folder.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;

struct RawColumn {
  std::string name;
  double per_unit;  ///< the file's number for one of the bench's unit
  std::function<const std::vector<double>&(const bench::Recording&)> values;
};

struct Measured {
  std::string name, separator;
  bool decimal_comma;
  std::vector<RawColumn> columns;
  std::string options;  ///< of the import
};

const std::vector<double>& t_of(const bench::Recording& r) { return r.t_s; }
const std::vector<double>& command_of(const bench::Recording& r) { return r.q_cmd_rad; }
const std::vector<double>& position_of(const bench::Recording& r) { return r.q_rad; }
const std::vector<double>& voltage_of(const bench::Recording& r) { return r.drive_V; }
const std::vector<double>& bus_of(const bench::Recording& r) { return r.bus_V; }

constexpr double kDegrees = 57.29577951308232;
const char* const kServoName =
    " --name "
    "'(?P<trajectory>.+)_kp(?P<kp_firmware>[0-9]+)_m(?P<load_mass_kg>[0-9.]+)_l(?P<load_length_m>[0-9.]+)_r(?P<repeat>["
    "0-9])'";

std::vector<Measured> measured() {
  return {{"emps",
           ";",
           true,
           {{"zeit", 1e3, t_of}, {"soll", 1e3, command_of}, {"ist", 1e3, position_of}, {"u", 1e3, voltage_of}},
           "--rig linear --law cascade_pd --drive kp_per_s=160.18 --drive kv_V_s_per_m=243.45 --drive "
           "gtau_N_per_V=35.15065188"
           " --map 't_s=zeit[ms]' --map 'q_cmd_m=soll[mm]' --map 'q_m=ist[mm]' --map 'drive_V=u[mV]'"},
          {"xl330",
           "\t",
           false,
           {{"time_us", 1e6, t_of}, {"goal", kDegrees, command_of}, {"pos (deg)", kDegrees, position_of}},
           "--rig pendulum --law servo_voltage --drive error_gain_per_rad=unknown"
           " --load mass_kg=0.49,length_m=0.10,inertia_kg_m2=unknown,gravity_Nm=unknown"
           " --map 't_s=time_us' --map 'q_cmd_rad=goal[deg]' --map 'q_rad=pos (deg)'" +
               std::string(kServoName)},
          {"sts3215",
           ",",
           false,
           {{"t", 1e3, t_of},
            {"goal", 1.0, command_of},
            {"pos", 4096.0 * kDegrees / 360.0, position_of},
            {"supply", 1e3, bus_of}},
           "--rig pendulum --law servo_voltage --drive error_gain_per_rad=0.16489"
           " --load mass_kg=0.535,length_m=0.10,inertia_kg_m2=0.006745244,gravity_Nm=0.542214288"
           " --load mass_kg=0.535,length_m=0.15,inertia_kg_m2=0.013687744,gravity_Nm=0.823616640"
           " --load mass_kg=0.741,length_m=0.10,inertia_kg_m2=0.009272826,gravity_Nm=0.744369943"
           " --load mass_kg=0.741,length_m=0.15,inertia_kg_m2=0.018792538,gravity_Nm=1.126850123"
           " --load mass_kg=0.969,length_m=0.10,inertia_kg_m2=0.012182358,gravity_Nm=0.967748572"
           " --load mass_kg=0.969,length_m=0.15,inertia_kg_m2=0.024549846,gravity_Nm=1.461918065"
           " --load mass_kg=1.168,length_m=0.10,inertia_kg_m2=0.014614670,gravity_Nm=1.163041735"
           " --load mass_kg=1.168,length_m=0.15,inertia_kg_m2=0.029471882,gravity_Nm=1.754857811"
           " --map 't_s=t[ms]' --map 'q_cmd_rad=goal[rad]' --map 'q_rad=pos[tick/4096]' --map 'bus_V=supply[mV]'" +
               std::string(kServoName)}};
}

void write_raw(const fs::path& file, const Measured& bench, const bench::Recording& recording) {
  std::string text;
  for (const RawColumn& column : bench.columns) text += (text.empty() ? "" : bench.separator) + column.name;
  for (std::size_t row = 0; row < recording.t_s.size(); ++row) {
    for (std::size_t c = 0; c < bench.columns.size(); ++c) {
      std::string cell = fmt::format("{:.12g}", bench.columns[c].per_unit * bench.columns[c].values(recording)[row]);
      if (bench.decimal_comma) {
        if (const auto point = cell.find('.'); point != std::string::npos) cell[point] = ',';
      }
      text += (c == 0 ? "\n" : bench.separator) + cell;
    }
  }
  std::ofstream(file) << text << '\n';
}

class ImportedBench : public testing::TestWithParam<std::size_t> {};

TEST_P(ImportedBench, OfALoggersFilesIsTheMeasuredBenchAgain) {
  const Measured wanted = measured()[GetParam()];
  PMG_NEEDS_BENCH(wanted.name);
  const test::TemporaryFolder temporary;
  const bench::Bench original = bench::read_bench(test::recorded_bench(wanted.name));
  const std::vector<bench::BenchRun> runs = original.read_runs(bench::RowFilter(""));
  for (const bench::BenchRun& run : runs) write_raw(temporary.path() / run.file, wanted, run.recording);

  const fs::path out = temporary.path() / "bench";
  const std::string command =
      fmt::format("cd '{}' && '{}/scripts/import-bench' *.csv {} --out '{}' >log 2>&1", temporary.path().string(),
                  test::project_folder(), wanted.options, out.string());
  ASSERT_EQ(std::system(command.c_str()), 0) << std::ifstream(temporary.path() / "log").rdbuf();

  const bench::Bench imported = bench::read_bench(out);
  EXPECT_EQ(imported.law, original.law);
  EXPECT_EQ(imported.rig, original.rig);
  std::vector<bench::BenchRun> again = imported.read_runs(bench::RowFilter(""));
  ASSERT_EQ(again.size(), runs.size());
  for (const bench::BenchRun& run : runs) {
    const auto same = std::ranges::find(again, run.file, &bench::BenchRun::file);
    ASSERT_NE(same, again.end()) << run.file;
    EXPECT_EQ(same->kp, run.kp) << run.file;
    EXPECT_EQ(same->repeat, run.repeat) << run.file;
    EXPECT_EQ(same->load, run.load) << run.file;
    for (const RawColumn& column : wanted.columns) {
      const std::vector<double>&left = column.values(same->recording), &right = column.values(run.recording);
      ASSERT_EQ(left.size(), right.size()) << run.file << ", " << column.name;
      for (std::size_t i = 0; i < left.size(); ++i)
        ASSERT_NEAR(left[i], right[i], 1e-8 * (1.0 + std::abs(right[i])))
            << run.file << ", " << column.name << ", " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Real, ImportedBench, testing::Range<std::size_t>(0, 3),
                         [](const auto& row) { return measured()[row.param].name; });

}  // namespace
}  // namespace pmg
