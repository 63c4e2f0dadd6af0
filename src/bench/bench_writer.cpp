#include "bench/bench_writer.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "files/number_table.hpp"
#include "io/whole_file.hpp"

namespace pmg::bench {

namespace {

namespace fs = std::filesystem;

std::string recording(const WrittenRun& run) {
  const std::vector<std::pair<std::string, const std::vector<double>*>> columns = {
      {"t_s", &run.t_s},           {"q_cmd_rad", &run.q_cmd_rad}, {"q_rad", &run.q_rad},
      {"dq_rad_s", &run.dq_rad_s}, {"torque_Nm", &run.torque_Nm}, {"temp_C", &run.temp_C}};
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows(run.t_s.size());
  for (const auto& [name, values] : columns) {
    if (values->empty()) continue;
    names.push_back(name);
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k].push_back((*values)[k]);
  }
  return files::format_number_table(names, rows);
}

}  // namespace

void write_bench(const fs::path& folder, const RobotBench& bench, const std::vector<WrittenRun>& runs) {
  fs::create_directories(folder / "runs");
  std::string table = "file,trajectory,repeat,kp_Nm_per_rad,kd_Nm_s_per_rad\n";
  for (const WrittenRun& run : runs) {
    io::write_whole_file(folder / "runs" / run.file, recording(run));
    table +=
        fmt::format("{},{},{},{},{}\n", run.file, run.trajectory, run.repeat, run.kp_Nm_per_rad, run.kd_Nm_s_per_rad);
  }
  io::write_whole_file(folder / "runs.csv", table);
  const JointLoad& load = bench.load;
  io::write_whole_file(
      folder / "bench.yaml",
      fmt::format("rig: robot  # gravity torque = gravity_Nm * sin(q - hangs_at_rad)\nrobot: {}\njoint: {}\n"
                  "units: {{q: rad, t: s}}\nsample_rate_hz: {}\n"
                  "drive: {{law: position_pd, limit_Nm: {}}}\n"
                  "loads:  # as the robot's model says\n"
                  "  - {{mass_kg: {}, inertia_kg_m2: {}, gravity_Nm: {}, hangs_at_rad: {}}}\n"
                  "design: {}\n",
                  bench.robot, bench.joint, bench.sample_rate_hz, bench.effort_limit_Nm, bench.load_mass_kg,
                  load.inertia_kg_m2, load.gravity_Nm, load.hangs_at_rad, bench.design));
}

}  // namespace pmg::bench
