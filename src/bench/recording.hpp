// One recording of a bench: what was commanded and what the joint did, checked before anything is made of it.
#pragma once

#include <filesystem>
#include <vector>

namespace pmg::bench {

/// Columns of equal length. On a linear rig rad is m and Nm is N. Columns that the file doesn't have are empty.
struct Recording {
  std::filesystem::path file;
  std::vector<double> t_s, q_cmd_rad, q_rad;  ///< always there
  std::vector<double> dq_cmd_rad_s, tau_ff_Nm, torque_Nm, bus_V, drive_V, temp_C;
  std::vector<bool> enabled;
  /// False where the sensor dropped out for a sample: the reading leaps away and right back. One a sample.
  std::vector<bool> valid;
  std::size_t dropouts() const;
};

struct RecordingFormat {
  bool linear = false;            ///< columns end in _m instead of _rad
  double sample_rate_hz = 100.0;  ///< as bench.yaml says
  bool commanded = true;          ///< positions are commanded; false where the recorded torque is the input
};

/// Throws files::ConfigError that names file, line and column, on: missing columns or columns in another unit, NaN,
/// times that stand still or run backwards, gaps, a rate other than bench.yaml's (milliseconds?), angles that look like
/// degrees, too few samples, and a command that never changes.
Recording read_recording(const std::filesystem::path& file, const RecordingFormat& format);

}  // namespace pmg::bench
