#include "bench_files.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "files.hpp"

namespace pmg::literature {

namespace {

std::string drive_yaml(const Rig& rig) {
  const Machine::Drive& d = rig.healthy.drive;
  switch (d.law) {
    case Law::kServo:
      return fmt::format(
          "drive:\n  law: servo_voltage\n  error_gain_per_rad: {:.5g}\n  torque_Nm_per_V: {:.4g}\n"
          "  kt_V_s_per_rad: {:.4g}\n  bus_V: {:.4g}\n",
          d.kp_factor, d.torque_per_unit, d.back_emf, rig.bus_V);
    case Law::kCascade:
      return fmt::format(
          "drive:\n  law: cascade_pd\n  kp_per_s: {:.5g}\n  kv_V_s_per_rad: {:.5g}\n  gtau_Nm_per_V: {:.4g}\n"
          "  limit_V: {:.4g}\n",
          rig.gains.front().kp / rig.gains.front().kd, rig.gains.front().kd, d.torque_per_unit, d.limit);
    case Law::kTorque:
      return "drive:\n  law: torque\n";
    case Law::kPositionPd:
      break;
  }
  return fmt::format("drive:\n  law: position_pd\n  limit_Nm: {:.4g}\n", d.limit);
}

std::string bench_yaml(const Rig& rig) {
  std::string text = fmt::format(
      "# A made-up bench for tests of the diagnosis.\nrig: {}\nunits: {{q: rad, t: s}}\nsample_rate_hz: {}\n",
      rig.horizontal ? "horizontal" : "pendulum", rig.sample_rate_hz);
  text += drive_yaml(rig) + "loads:\n";
  for (const Load& load : rig.loads) {
    text += fmt::format("  - {{mass_kg: {:.5f}, length_m: {:.5f}, inertia_kg_m2: {:.6g}, gravity_Nm: {:.6g}}}\n",
                        load.mass_kg, load.length_m, load.inertia_kg_m2, load.gravity_Nm);
  }
  return text + fmt::format("rotor: {{armature_kg_m2: {:.4g}}}\n", rig.healthy.body.rotor_inertia_kg_m2);
}

std::string csv(const Rig& rig, const Recording& r) {
  const bool switched = std::find(r.enabled.begin(), r.enabled.end(), false) != r.enabled.end();
  const bool torque = rig.healthy.drive.law == Law::kTorque, warm = rig.records_temperature && !rig.temperature_in_rows;
  std::string text = "t_s,q_cmd_rad,q_rad";
  if (rig.commands_speed) text += ",dq_cmd_rad_s";
  if (torque) text += ",torque_Nm";
  if (rig.feeds_forward) text += ",tau_ff_Nm";
  if (rig.records_bus) text += ",bus_V";
  if (switched) text += ",enabled";
  if (warm) text += ",temp_C";
  text += '\n';
  for (std::size_t k = 0; k < r.t_s.size(); ++k) {
    text += fmt::format("{:.6f},{:.6f},{:.6f}", r.t_s[k], r.q_cmd_rad[k], r.q_rad[k]);
    if (rig.commands_speed) text += fmt::format(",{:.6f}", r.dq_cmd_rad_s[k]);
    if (torque || rig.feeds_forward) text += fmt::format(",{:.6f}", r.feed_forward[k]);
    if (rig.records_bus) text += fmt::format(",{:.3f}", r.bus_V[k]);
    if (switched) text += r.enabled[k] ? ",1" : ",0";
    if (warm) text += fmt::format(",{:.1f}", r.temp_C[k]);
    text += '\n';
  }
  return text;
}

std::string gains_header(Law law) {
  return law == Law::kServo    ? "kp_firmware,"
         : law == Law::kTorque ? ""
                               : "kp_Nm_per_rad,kd_Nm_s_per_rad,";  // a cascade's are V/rad and V s/rad
}

std::string gains_cells(Law law, const Gains& gains) {
  return law == Law::kServo    ? fmt::format("{:.8g},", gains.kp)
         : law == Law::kTorque ? ""
                               : fmt::format("{:.8g},{:.8g},", gains.kp, gains.kd);
}

}  // namespace

void write_bench(const std::filesystem::path& folder, const LiteraturePlant& plant, const Machine& machine,
                 std::uint64_t take, bool spoiled) {
  const Rig& rig = spoiled ? plant.rig : plant.sound_rig;
  const Law law = rig.healthy.drive.law;
  std::vector<FiledRun> files;
  for (std::size_t i = 0; i < rig.runs.size(); ++i) {
    files.push_back(
        {i, rig.gains[rig.runs[i].gains], rig.loads[rig.runs[i].load], record(machine, rig, plant.seed, i, take)});
  }
  if (spoiled) {
    for (const DataFault& fault : plant.faults) spoil(fault, files);
  }
  std::filesystem::create_directories(folder / "runs");
  const bool temperature = rig.records_temperature && rig.temperature_in_rows;
  std::string rows = "file,trajectory,repeat," + gains_header(law) + "load_mass_kg,load_length_m," +
                     (temperature ? "temp_C," : "") + "use\n";
  for (const FiledRun& file : files) {
    const RunDesign& run = rig.runs[file.index];
    const std::string name = fmt::format("run{:02}.csv", file.index);
    rows += fmt::format("{},{},{},{}{:.5f},{:.5f},", name, rig.trajectories[run.trajectory].name, run.repeat,
                        gains_cells(law, file.gains), file.load.mass_kg, file.load.length_m);
    if (temperature) rows += fmt::format("{:.1f},", file.recording.temp_C.front());
    rows += run.scored ? "score\n" : "fit\n";
    write_text(folder / "runs" / name, csv(rig, file.recording));
  }
  write_text(folder / "bench.yaml", bench_yaml(rig));
  write_text(folder / "runs.csv", rows);
}

}  // namespace pmg::literature
