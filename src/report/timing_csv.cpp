#include "report/timing_csv.hpp"

#include <array>
#include <limits>
#include <sstream>

#include "files/bounded_file.hpp"

namespace pmg::report {

namespace {
constexpr std::uint64_t kLargest_bytes = 1u << 30;  // a day of ticks
constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();
}  // namespace

void read_timing_csv(const std::filesystem::path& file, RunSeries& run) {
  if (!std::filesystem::exists(file)) return;
  std::istringstream in(files::read_bounded_text(file, kLargest_bytes, "times of a run"));
  std::string line;
  std::getline(in, line);
  if (line != "time_s,tick_us,generator_us,gco_us,policy_us") return;
  auto& to = run.timing;
  std::array<double, 5> row{};
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    bool whole = true;
    for (double& value : row) {
      std::string cell;
      whole = whole && std::getline(cells, cell, ',') && std::istringstream(cell) >> value;
    }
    if (!whole || (!to.t_s.empty() && row[0] < to.t_s.back())) continue;
    to.t_s.push_back(row[0]);
    to.tick_us.push_back(row[1]);
    to.generator_us.push_back(row[2] > 0.0 ? row[2] : kNotMeasured);
    to.gco_us.push_back(row[3] > 0.0 ? row[3] : kNotMeasured);
    to.policy_us.push_back(row[4] > 0.0 ? row[4] : kNotMeasured);
  }
}

}  // namespace pmg::report
