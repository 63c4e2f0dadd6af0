// Excitations as files: runs.csv, commands/, and bench.yaml for the recordings to come.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "bench/csv_table.hpp"
#include "bench/excitation.hpp"
#include "files/number_table.hpp"
#include "files/result_folder.hpp"
#include "io/whole_file.hpp"
#include "model/bundle.hpp"

namespace pmg::bench {

namespace {

namespace fs = std::filesystem;

/// A trajectory, and the rate of its commands [Hz] from their times: runs.csv has no rate.
ExcitationTrajectory read_trajectory(const fs::path& file, const std::string& name, double& rate_hz) {
  const files::NumberTable table = files::read_number_table(file, {"t_s", "q_cmd_rad"}, "of a command over time");
  const std::size_t time = table.columns.front() == "t_s" ? 0 : 1;
  if (table.rows.size() < 2) files::raise({file.string()}, "", "is too short", "at least two rows");
  const double step_s = table.rows[1][time] - table.rows[0][time];
  ExcitationTrajectory trajectory{name, {}};
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    const double due_s = table.rows[0][time] + static_cast<double>(k) * step_s;
    if (!(step_s > 0.0) || std::abs(table.rows[k][time] - due_s) > 0.1 * step_s) {
      files::raise(table.place(k), "t_s", fmt::format("is {}", table.rows[k][time]), "evenly spaced, growing times");
    }
    trajectory.q_cmd_rad.push_back(table.rows[k][1 - time]);
  }
  const double span_s = table.rows.back()[time] - table.rows.front()[time];
  rate_hz = std::round(1e6 * static_cast<double>(table.rows.size() - 1) / span_s) / 1e6;
  return trajectory;
}

double finite_number(const CsvTable& table, std::size_t row, const std::string& column) {
  const auto at = table.find(column);
  if (!at) files::raise({table.file.string(), table.header_line}, column, "is missing", "a column of an excitation");
  const auto value = to_number(table.rows[row][*at]);
  if (!value || !std::isfinite(*value)) {
    files::raise(table.place(row), column, "is '" + table.rows[row][*at] + "'", "a finite number");
  }
  return *value;
}

}  // namespace

void write_excitation(const fs::path& folder, const Excitation& excitation, const std::string& design) {
  files::expect_unused(folder, "an excitation or a bench", {"runs.csv", "bench.yaml"});
  fs::create_directories(folder / "commands");
  for (const ExcitationTrajectory& trajectory : excitation.trajectories) {
    std::vector<std::vector<double>> rows;
    for (std::size_t k = 0; k < trajectory.q_cmd_rad.size(); ++k) {
      rows.push_back({static_cast<double>(k) / excitation.rate_hz, trajectory.q_cmd_rad[k]});
    }
    io::write_whole_file(folder / "commands" / (trajectory.name + ".csv"),
                         files::format_number_table({"t_s", "q_cmd_rad"}, rows));
  }
  std::string runs = "file,trajectory,repeat,kp_Nm_per_rad,kd_Nm_s_per_rad\n";
  for (const ExcitationRow& row : excitation.rows) {
    runs += fmt::format("{},{},{},{},{}\n", row.file, row.trajectory, row.repeat, row.gains.kp_Nm_per_rad,
                        row.gains.kd_Nm_s_per_rad);
  }
  io::write_whole_file(folder / "runs.csv", runs);
  io::write_whole_file(
      folder / "bench.yaml",
      fmt::format(
          "# To be recorded: play commands/TRAJECTORY.csv for each row of runs.csv, write what the joint did to\n"
          "# runs/FILE (t_s, q_cmd_rad, q_rad, ...), and say here what the rig and its loads are.\n"
          "rig: horizontal  # or pendulum, linear; robot is written by pmg_sil and pmg_controller --bench\n"
          "units: {{q: rad, t: s}}\n"
          "sample_rate_hz: {}\n"
          "drive: {{law: position_pd}}\n"
          "# loads:  [{{mass_kg: 1.0, length_m: 0.1, inertia_kg_m2: unknown, gravity_Nm: unknown}}]\n"
          "design: {}\n",
          excitation.rate_hz, design));
}

Excitation read_excitation(const fs::path& folder) {
  if (fs::exists(folder / "runs") && !fs::exists(folder / "commands")) {
    throw files::ConfigError(
        fmt::format("{}: is a recorded bench; expected the excitation that it was recorded with (pmg_calibrate_motor "
                    "--make-excitation)",
                    folder.string()));
  }
  const CsvTable table = read_csv(folder / "runs.csv");
  Excitation excitation;
  std::map<std::string, double> rate_hz;
  std::set<std::string> files;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const auto text = [&](const std::string& column) {
      const auto at = table.find(column);
      if (!at || table.rows[row][*at].empty()) files::raise(table.place(row), column, "is missing", "a name");
      return table.rows[row][*at];
    };
    ExcitationRow found{text("file"),
                        text("trajectory"),
                        static_cast<int>(finite_number(table, row, "repeat")),
                        {finite_number(table, row, "kp_Nm_per_rad"), finite_number(table, row, "kd_Nm_s_per_rad")}};
    if (!files.insert(found.file).second)
      files::raise(table.place(row), "file", found.file + " is there twice", "one row a file");
    if (fs::path(found.file).filename() != found.file) files::raise(table.place(row), "file", "has a folder", "a name");
    if (!rate_hz.contains(found.trajectory)) {
      excitation.trajectories.push_back(read_trajectory(folder / "commands" / (found.trajectory + ".csv"),
                                                        found.trajectory, rate_hz[found.trajectory]));
    }
    if (rate_hz[found.trajectory] != rate_hz.begin()->second) {
      files::raise(table.place(row), "trajectory", "has another rate than those before", "one rate for all");
    }
    excitation.rows.push_back(std::move(found));
  }
  excitation.rate_hz = rate_hz.begin()->second;
  return excitation;
}

std::string excitation_sha256(const fs::path& folder, const Excitation& excitation) {
  std::vector<fs::path> files = {folder / "runs.csv"};
  for (const ExcitationTrajectory& trajectory : excitation.trajectories) {
    files.push_back(folder / "commands" / (trajectory.name + ".csv"));
  }
  return model::files_sha256(std::move(files));
}

}  // namespace pmg::bench
