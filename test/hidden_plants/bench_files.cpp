#include "bench_files.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "blind_plants/files.hpp"

namespace pmg::hidden {

namespace {

std::string bench_yaml(const Rig& rig) {
  std::string text = fmt::format(
      "# A made-up bench for tests of the diagnosis.\nrig: pendulum\nunits: {{q: rad, t: s}}\nsample_rate_hz: {}\n",
      rig.sample_rate_hz);
  const PlantParameters::Drive& drive = rig.healthy.drive;
  if (drive.servo) {
    text += fmt::format(
        "drive:\n  law: servo_voltage\n  error_gain_per_rad: {:.5g}\n  torque_Nm_per_V: {:.4g}\n"
        "  kt_V_s_per_rad: {:.4g}\n  bus_V: {:.4g}\n",
        drive.kp_factor, drive.torque_Nm_per_V, drive.back_emf_V_s_per_rad, rig.bus_V);
  } else {
    text += fmt::format("drive:\n  law: position_pd\n  limit_Nm: {:.4g}\n", drive.limit);
  }
  text += "loads:\n";
  for (const RigLoad& load : rig.loads) {
    text += fmt::format("  - {{mass_kg: {:.5f}, length_m: {:.5f}, inertia_kg_m2: {:.6g}, gravity_Nm: {:.6g}}}\n",
                        load.mass_kg, load.length_m, load.inertia_kg_m2, load.gravity_Nm);
  }
  text += fmt::format("rotor: {{armature_kg_m2: {:.4g}}}\n", rig.healthy.body.rotor_inertia_kg_m2);
  return text;
}

std::string csv(const PlantRecording& r, bool temperature) {
  const bool switched = std::find(r.enabled.begin(), r.enabled.end(), false) != r.enabled.end();
  std::string text = "t_s,q_cmd_rad,q_rad";
  if (switched) text += ",enabled";
  if (temperature) text += ",temp_C";
  text += '\n';
  for (std::size_t k = 0; k < r.t_s.size(); ++k) {
    text += fmt::format("{:.6f},{:.6f},{:.6f}", r.t_s[k], r.q_cmd_rad[k], r.q_rad[k]);
    if (switched) text += r.enabled[k] ? ",1" : ",0";
    if (temperature) text += fmt::format(",{:.1f}", r.temp_C[k]);
    text += '\n';
  }
  return text;
}

class BenchWriter {
 public:
  BenchWriter(const std::filesystem::path& folder, const HiddenPlant& hidden, const PlantParameters& plant)
      : folder_(folder), hidden_(hidden), plant_(plant) {
    std::filesystem::create_directories(folder / "runs");
    rows_ = hidden.rig.healthy.drive.servo
                ? "file,trajectory,repeat,kp_firmware,load_mass_kg,load_length_m,use\n"
                : "file,trajectory,repeat,kp_Nm_per_rad,kd_Nm_s_per_rad,load_mass_kg,load_length_m,use\n";
  }

  void add(const PlantRun& run, const std::string& trajectory, int repeat, bool scored) {
    const std::string file = fmt::format("run{:02}.csv", count_++);
    const std::string gains =
        hidden_.rig.healthy.drive.servo ? fmt::format("{}", run.kp) : fmt::format("{},{}", run.kp, run.kd);
    rows_ += fmt::format("{},{},{},{},{:.5f},{:.5f},{}\n", file, trajectory, repeat, gains, run.load.mass_kg,
                         run.load.length_m, scored ? "score" : "fit");
    write_text(folder_ / "runs" / file,
               csv(record(plant_, hidden_.rig, hidden_.seed, run), hidden_.rig.records_temperature));
  }

  void finish() {
    write_text(folder_ / "bench.yaml", bench_yaml(hidden_.rig));
    write_text(folder_ / "runs.csv", rows_);
  }

 private:
  const std::filesystem::path folder_;
  const HiddenPlant& hidden_;
  const PlantParameters& plant_;
  std::string rows_;
  int count_ = 0;
};

}  // namespace

void write_bench(const std::filesystem::path& folder, const HiddenPlant& hidden, const PlantParameters& plant,
                 std::uint64_t take, const std::vector<FurtherRun>& further) {
  BenchWriter writer(folder, hidden, plant);
  for (std::size_t i = 0; i < hidden.rig.runs.size(); ++i) {
    const RigRun& run = hidden.rig.runs[i];
    writer.add(run_of(hidden, i, take), hidden.rig.commands[run.command].name, run.repeat, run.scored);
  }
  for (const FurtherRun& one : further) writer.add(one.run, one.trajectory, one.repeat, false);
  writer.finish();
}

}  // namespace pmg::hidden
