// One recording of a bench: commands to a joint and its response, checked while they are read.
#pragma once

#include <filesystem>
#include <vector>

namespace pmg::bench {

/// Columns of equal length; a column that the file lacks is empty. On a linear rig rad means m and Nm means N.
struct Recording {
  std::filesystem::path file;
  std::vector<double> t_s, q_cmd_rad, q_rad;  ///< never empty
  std::vector<double> dq_cmd_rad_s, dq_rad_s, tau_ff_Nm, torque_Nm, bus_V, drive_V, temp_C;
  std::vector<bool> enabled;
  /// One flag per sample; false for a dropout of the sensor, a single reading far from both of its neighbours, and for
  /// a reading that a correction calls unknown.
  std::vector<bool> valid;
  std::size_t dropouts() const;
};

struct RecordingFormat {
  bool linear = false;            ///< columns end in _m instead of _rad
  double sample_rate_hz = 100.0;  ///< from bench.yaml
  bool commanded = true;          ///< positions are commanded; false where the recorded torque is the input
  /// For whoever looks for columns in another unit: positions that are too large for radians or metres are read, too.
  bool other_units = false;
};

/// Throws files::ConfigError with file, line and column on: missing columns or columns in another unit, NaN, times that
/// do not increase, gaps, a sample rate other than bench.yaml's (times in milliseconds?), angles that look like
/// degrees, too few samples, and a constant command.
Recording read_recording(const std::filesystem::path& file, const RecordingFormat& format);

/// True if no position is larger than a bench's joint can go, in radians (metres on a linear rig).
bool plausible_positions(const Recording& recording, bool linear);

}  // namespace pmg::bench
