#include "bench/bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "files/config_reader.hpp"
#include "files/nearest_name.hpp"
#include "pmg/types.hpp"

namespace pmg::bench {

namespace {

using files::ConfigReader;

constexpr double kPresliding_m = 1e-5;  // of guides and screws; the joints' default of 1e-3 rad would mean 1 mm

/// A positive number; empty if the file says "unknown" or lacks the key.
std::optional<double> known_number(ConfigReader& reader, const std::string& key) {
  if (!reader.has(key)) return std::nullopt;
  try {
    return reader.required<double>(key, files::positive());
  } catch (const files::ConfigError&) {
    if (reader.required<std::string>(key) == "unknown") return std::nullopt;
    reader.fail(key, "is '" + reader.required<std::string>(key) + "'", "a number above 0, or unknown");
  }
}

void take(Bench& bench, ConfigReader& drive, const std::string& key, const std::string& parameter) {
  const std::optional<double> value = known_number(drive, key);
  if (value)
    model::actuator_parameter(parameter).in(bench.known) = *value;
  else
    bench.unknown.push_back(parameter);
}

void read_servo(Bench& bench, ConfigReader& drive) {
  bench.known.drive.limit = 1.0;  // duty
  take(bench, drive, "error_gain_per_rad", "drive.kp_scale");
  take(bench, drive, "torque_Nm_per_V", "drive.torque_per_unit_Nm");
  take(bench, drive, "kt_V_s_per_rad", "drive.back_emf_s_per_rad");
  if (!drive.has("bus_V")) return;
  try {  // a number, or remarks, of which a nominal number tells the unit of a recorded voltage
    bench.supply_V = drive.required<double>("bus_V", files::positive());
    bench.nominal_supply_V = bench.supply_V;
  } catch (const files::ConfigError&) {
    ConfigReader remarks = drive.map("bus_V");
    for (const std::string& key : remarks.keys()) {
      if (!key.starts_with("nominal")) continue;
      try {
        bench.nominal_supply_V = remarks.required<double>(key, files::positive());
      } catch (const files::ConfigError&) {
      }
    }
  }
}

void read_cascade(Bench& bench, ConfigReader& drive, const std::string& length) {
  const double kp_per_s = drive.required<double>("kp_per_s", files::positive());
  bench.kd_of_law = drive.required<double>("kv_V_s_per_" + length, files::positive());
  bench.kp_of_law = kp_per_s * bench.kd_of_law;
  bench.known.drive.limit = drive.optional<double>("limit_V", 10.0, files::positive());
  bench.known.command.hold_s =
      1.0 / bench.sample_rate_hz;  // a digital loop reads command and position at the same time
  take(bench, drive, length == "m" ? "gtau_N_per_V" : "gtau_Nm_per_V", "drive.torque_per_unit_Nm");
}

void read_position_pd(Bench& bench, ConfigReader& drive) {
  bench.kp_of_law = known_number(drive, "kp_Nm_per_rad").value_or(1.0);
  bench.kd_of_law = known_number(drive, "kd_Nm_s_per_rad").value_or(1.0);
  bench.known.drive.limit = known_number(drive, "limit_Nm").value_or(bench.known.drive.limit);
}

void read_drive(Bench& bench, ConfigReader drive) {
  const std::string law = drive.one_of("law", {"servo_voltage", "position_pd", "cascade_pd", "torque"});
  if (law == "servo_voltage") {
    bench.law = DriveLaw::kServoVoltage;
    read_servo(bench, drive);
  } else if (law == "cascade_pd") {
    bench.law = DriveLaw::kCascadePd;
    read_cascade(bench, drive, bench.rig == Rig::kLinear ? "m" : "rad");
  } else if (law == "position_pd") {
    bench.law = DriveLaw::kPositionPd;
    read_position_pd(bench, drive);
  } else {
    bench.law = DriveLaw::kTorque;
    bench.kp_of_law = bench.kd_of_law = 0.0;
  }
  drive.finish();
}

BenchLoad read_load(ConfigReader reader, bool hangs) {
  BenchLoad load;
  load.mass_kg = reader.required<double>("mass_kg", files::positive());
  load.length_m = reader.optional<double>("length_m", 0.0, files::non_negative());
  const auto inertia = known_number(reader, "inertia_kg_m2"), gravity = known_number(reader, "gravity_Nm");
  load.inertia_unknown = reader.has("inertia_kg_m2") && !inertia;
  load.gravity_unknown = hangs && reader.has("gravity_Nm") && !gravity;
  if (hangs && (load.inertia_unknown || load.gravity_unknown) && load.length_m == 0.0)
    reader.fail(load.gravity_unknown ? "gravity_Nm" : "inertia_kg_m2", "is unknown, and so is where the mass sits",
                "length_m, about: the fit finds factors on the point mass that it makes of mass_kg and length_m");
  const double point = load.length_m > 0.0 ? load.mass_kg * load.length_m * load.length_m : load.mass_kg;
  load.load.inertia_kg_m2 = inertia.value_or(point);
  load.load.hangs_at_rad = reader.optional<double>("hangs_at_rad", 0.0, files::any_number());
  load.load.gravity_Nm = hangs ? gravity.value_or(load.mass_kg * kGravity_m_s2 * load.length_m) : 0.0;
  reader.finish();
  return load;
}

void check_units(ConfigReader units, bool linear) {
  const std::string expected = linear ? "m" : "rad";
  if (units.has("q") && units.required<std::string>("q") != expected)
    units.fail("q", "is '" + units.required<std::string>("q") + "'", expected);
  if (units.has("t") && units.required<std::string>("t") != "s")
    units.fail("t", "is '" + units.required<std::string>("t") + "'", "s");
}

std::optional<std::string> cell(const CsvTable& table, std::size_t row, const std::string& column) {
  const auto c = table.find(column);
  if (!c || table.rows[row][*c].empty()) return std::nullopt;
  return table.rows[row][*c];
}

std::optional<double> number(const CsvTable& table, std::size_t row, const std::string& column) {
  const auto text = cell(table, row, column);
  if (!text) return std::nullopt;
  const auto value = to_number(*text);
  if (!value || !std::isfinite(*value)) files::raise(table.place(row), column, "is '" + *text + "'", "a finite number");
  return value;
}

/// The load of bench.yaml with the row's mass. Both files round masses.
JointLoad load_of(const Bench& bench, std::size_t row) {
  if (bench.loads.empty()) return {};
  const auto mass = number(bench.runs, row, "load_mass_kg"), length = number(bench.runs, row, "load_length_m");
  if (!mass && bench.loads.size() == 1) return bench.loads.front().load;
  for (const BenchLoad& load : bench.loads) {
    const bool same_mass = mass && std::abs(*mass - load.mass_kg) <= 2e-3 * load.mass_kg;
    const bool same_length = !length || std::abs(*length - load.length_m) <= 1e-6 + 2e-3 * load.length_m;
    if (same_mass && same_length) return load.load;
  }
  files::raise(bench.runs.place(row), "load_mass_kg", "no such load in bench.yaml", "one of `loads`");
}

BenchRun describe(const Bench& bench, std::size_t row) {
  BenchRun run;
  const auto file = cell(bench.runs, row, "file"), trajectory = cell(bench.runs, row, "trajectory");
  if (!file) files::raise(bench.runs.place(row), "file", "is missing", "a file of runs/");
  run.file = *file;
  run.trajectory = trajectory.value_or("");
  run.repeat = static_cast<int>(number(bench.runs, row, "repeat").value_or(0.0));
  const bool firmware = bench.law == DriveLaw::kServoVoltage;
  run.kp = number(bench.runs, row, firmware ? "kp_firmware" : "kp_Nm_per_rad").value_or(bench.kp_of_law);
  run.kd = number(bench.runs, row, "kd_Nm_s_per_rad").value_or(bench.kd_of_law);
  run.temp_C = number(bench.runs, row, "temp_C");
  run.load = load_of(bench, row);
  run.place = (static_cast<double>(row) + 0.5) / static_cast<double>(bench.runs.rows.size());
  return run;
}

/// Throws files::ConfigError where the folder is something else.
void expect_bench(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder / "bench.yaml")) {
    throw files::ConfigError(
        fmt::format("{}: is no bench, it has no bench.yaml; expected a folder with bench.yaml, runs.csv and runs/ "
                    "(docs/how-to/calibration.md)",
                    folder.string()));
  }
}

void expect_recorded(const std::filesystem::path& folder) {
  if (std::filesystem::exists(folder / "runs") || !std::filesystem::exists(folder / "commands")) return;
  throw files::ConfigError(
      fmt::format("{}: is an excitation that is still to be recorded; expected the bench that pmg_sil --bench JOINT "
                  "--excitation {} --out BENCH makes of it, or on a robot pmg_controller --bench",
                  folder.string(), folder.string()));
}

/// Columns are free, for --fit and --score; one that is nearly a known one would leave that one unread.
void expect_no_misspelt_column(const CsvTable& runs) {
  static const std::vector<std::string> known = {"file",         "trajectory",    "repeat",
                                                 "kp_firmware",  "kp_Nm_per_rad", "kd_Nm_s_per_rad",
                                                 "load_mass_kg", "load_length_m", "temp_C"};
  for (const std::string& column : runs.header) {
    if (std::find(known.begin(), known.end(), column) != known.end()) continue;
    const std::string meant = files::nearest_name(column, known);
    if (meant.empty() || runs.find(meant)) continue;
    throw files::ConfigError(fmt::format("{}:{}: column {} is read by nothing; did you mean {}?", runs.file.string(),
                                         runs.header_line, column, meant));
  }
}

}  // namespace

double Bench::feed_forward_output(double torque_Nm, double supply) const {
  if (torque_Nm == 0.0) return 0.0;
  const bool constant_unknown = std::find(unknown.begin(), unknown.end(), "drive.torque_per_unit_Nm") != unknown.end();
  return constant_unknown ? std::nan("") : torque_Nm / (known.drive.torque_per_unit_Nm * supply);
}

std::string Bench::joint_name() const {
  return joint.empty() ? std::filesystem::weakly_canonical(folder).filename().string() : joint;
}

Bench read_bench(const std::filesystem::path& folder) {
  expect_bench(folder);
  ConfigReader reader = ConfigReader::from_file(folder / "bench.yaml");
  Bench bench;
  bench.folder = folder;
  const std::string rig = reader.one_of("rig", {"pendulum", "horizontal", "linear", "robot"});
  bench.rig = rig == "pendulum" ? Rig::kPendulum
              : rig == "linear" ? Rig::kLinear
              : rig == "robot"  ? Rig::kRobot
                                : Rig::kHorizontal;
  if (bench.rig == Rig::kLinear) bench.known.friction.presliding_rad = kPresliding_m;
  bench.sample_rate_hz = reader.required<double>("sample_rate_hz", files::positive());
  if (reader.has("units")) check_units(reader.map("units"), bench.rig == Rig::kLinear);
  if (reader.has("command_hold")) bench.linear_hold = reader.one_of("command_hold", {"hold", "linear"}) == "linear";
  read_drive(bench, reader.map("drive"));
  if (reader.has("loads")) {
    for (ConfigReader& load : reader.maps("loads"))
      bench.loads.push_back(read_load(load, bench.rig == Rig::kPendulum || bench.rig == Rig::kRobot));
  }
  if (reader.has("rotor")) {
    ConfigReader rotor = reader.map("rotor");
    bench.known.transmission.armature_kg_m2 = known_number(rotor, "armature_kg_m2").value_or(0.0);
    known_number(rotor, "gear_ratio");
    rotor.finish();
  }
  bench.robot = reader.optional<std::string>("robot", "");
  bench.joint = reader.optional<std::string>("joint", "");
  if (reader.has("design")) reader.required<std::string>("design");
  if (reader.has("reference")) reader.map("reference");  // a reference result for comparisons; a fit does not use it
  reader.finish();
  bench.runs = read_csv(folder / "runs.csv");
  expect_no_misspelt_column(bench.runs);
  return bench;
}

std::vector<BenchRun> Bench::read_runs(const RowFilter& filter, const work::Progress& progress) const {
  expect_recorded(folder);
  const std::vector<bool> kept = filter.keeps(runs);
  std::vector<BenchRun> found;
  const RecordingFormat format{rig == Rig::kLinear, sample_rate_hz, law != DriveLaw::kTorque, other_units};
  for (std::size_t row = 0; row < kept.size(); ++row) {
    if (!kept[row]) continue;
    BenchRun run = describe(*this, row);
    if (std::find(left_out.begin(), left_out.end(), run.file) != left_out.end()) continue;
    run.recording = read_recording(folder / "runs" / run.file, format);
    for (const Correction& correction : corrections) correct(run, correction);
    found.push_back(std::move(run));
    if (!progress(static_cast<double>(row + 1) / static_cast<double>(kept.size()))) break;
  }
  if (found.empty()) {
    throw std::invalid_argument(fmt::format("{}: no run matches '{}' among {}{}; expected at least one",
                                            runs.file.string(), filter.text(), kept.size(),
                                            left_out.empty() ? "" : fmt::format(", {} left out", left_out.size())));
  }
  return found;
}

}  // namespace pmg::bench
