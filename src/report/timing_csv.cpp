#include "report/timing_csv.hpp"

#include <array>
#include <fstream>
#include <sstream>

#include "files/bounded_file.hpp"
#include "report/series_samples.hpp"

namespace pmg::report {

namespace {
constexpr std::uint64_t kLargest_bytes = 1u << 30;  // a day of ticks
}  // namespace

void read_timing_csv(const std::filesystem::path& file, RunSeries& run) {
  if (!std::filesystem::exists(file)) return;
  files::expect_bounded_file(file, kLargest_bytes, "times of a run");
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  if (line != "time_s,tick_us,generator_us,gco_us,policy_us") return;
  std::array<double, 5> row{};
  double newest_s = 0.0;
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    bool whole = true;
    for (double& value : row) {
      std::string cell;
      whole = whole && std::getline(cells, cell, ',') && std::istringstream(cell) >> value;
    }
    if (!whole || (run.timing.ticks > 0 && row[0] < newest_s)) continue;
    newest_s = row[0];
    add_times(run.timing, row[1], row[2], row[3], row[4]);
  }
}

}  // namespace pmg::report
