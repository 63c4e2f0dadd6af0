#include "diagnosis/next_excitation_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <stdexcept>

#include "files/bounded_file.hpp"
#include "files/number_table.hpp"
#include "io/whole_file.hpp"

namespace pmg::diagnosis {

namespace {

namespace fs = std::filesystem;

std::string command_csv(const bench::Bench& bench, const NextRun& run) {
  std::vector<std::vector<double>> rows;
  for (std::size_t k = 0; k < run.t_s.size(); ++k) rows.push_back({run.t_s[k], run.q_cmd_rad[k]});
  return files::format_number_table({"t_s", bench.rig == bench::Rig::kLinear ? "q_cmd_m" : "q_cmd_rad"}, rows);
}

/// The row's known cells, by column.
std::map<std::string, std::string> cells(const NextRun& run, int repeat) {
  std::map<std::string, std::string> known = {{"file", fmt::format("{}_r{}.csv", run.name, repeat)},
                                              {"trajectory", run.name},
                                              {"repeat", fmt::format("{}", repeat)},
                                              {"kp_firmware", fmt::format("{}", run.kp)},
                                              {"kp_Nm_per_rad", fmt::format("{}", run.kp)},
                                              {"kd_Nm_s_per_rad", fmt::format("{}", run.kd)}};
  if (run.load_mass_kg > 0.0) {
    known["load_mass_kg"] = fmt::format("{}", run.load_mass_kg);
    known["load_length_m"] = fmt::format("{}", run.load_length_m);
  }
  return known;
}

std::string runs_csv(const std::vector<std::string>& header, const NextExcitation& next) {
  std::string text = fmt::format("{}\n", fmt::join(header, ","));
  for (const NextRun& run : next.runs) {
    for (int time = 0; time < run.times; ++time) {
      const int repeat = time == 0 ? 0 : time + 1;  // repeat 1 is for the score
      const std::map<std::string, std::string> known = cells(run, repeat);
      std::vector<std::string> row;
      for (const std::string& column : header) row.push_back(known.contains(column) ? known.at(column) : "");
      text += fmt::format("{}\n", fmt::join(row, ","));
    }
  }
  return text;
}

std::string text_of(const fs::path& file) {
  return files::read_bounded_text(file, files::kLargestYaml_bytes, "a YAML file");
}

}  // namespace

void expect_no_recordings(const fs::path& folder) {
  if (fs::exists(folder / "runs"))
    throw std::runtime_error(folder.string() + " holds recordings already; expected a folder without runs/");
}

void remove_next_excitation(const fs::path& folder) {
  expect_no_recordings(folder);
  fs::remove_all(folder / "commands");
  for (const char* name : {"runs.csv", "bench.yaml"}) fs::remove(folder / name);
  if (fs::exists(folder) && fs::is_empty(folder)) fs::remove(folder);
}

void write_next_excitation(const fs::path& folder, const bench::Bench& bench, const NextExcitation& next) {
  remove_next_excitation(folder);
  fs::create_directories(folder / "commands");
  for (const NextRun& run : next.runs) {
    io::write_whole_file(folder / "commands" / (run.name + ".csv"), command_csv(bench, run));
  }
  io::write_whole_file(folder / "runs.csv", runs_csv(bench.runs.header, next));
  io::write_whole_file(folder / "bench.yaml", text_of(bench.folder / "bench.yaml"));
}

}  // namespace pmg::diagnosis
