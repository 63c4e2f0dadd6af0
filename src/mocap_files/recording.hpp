// A human's motion in metres, z up: what gait events, cutting and retargeting start from.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mocap_files/key_bodies.hpp"
#include "mocap_files/motion.hpp"

namespace pmg::mocap {

struct Body {
  std::string from;  ///< the file's name of the point, or how it was made; empty: the recording lacks this body
  std::vector<Eigen::Vector3d> position_m;      ///< of each frame
  std::vector<Eigen::Quaterniond> orientation;  ///< of each frame; empty for markers
  bool known() const { return !position_m.empty(); }
};

struct Recording {
  std::string file, format;
  bool markers = false;
  std::size_t frames = 0;
  double rate_hz = 0.0;
  std::string rate_from;  ///< "the file", "given", "assumed"
  double unit_m = 1.0;    ///< metres a unit of the file
  std::string unit_from;  ///< how that is known
  std::string up;         ///< the file's axis that points up, as "+y"
  std::array<Body, kKeyBodies> bodies;
  std::vector<Point> skeleton;                 ///< names and parents alone
  std::vector<std::string> joints;             ///< of a robot or a body model, if the file has angles
  std::vector<std::vector<double>> joint_rad;  ///< of each frame
  double leg_length_m = 0.0;                   ///< hip to knee to ankle, median over frames, mean of both; 0: not known
  std::vector<std::string> notes;              ///< what was guessed, filled or seems wrong

  const Body& body(KeyBody key) const { return bodies[static_cast<std::size_t>(key)]; }
  double duration_s() const { return static_cast<double>(frames) / rate_hz; }
};

/// What a user knows better than the file or the guess.
struct RecordingOptions {
  std::optional<double> rate_hz, unit_m;
  std::string up;  ///< "+x" ... "-z"; empty: guessed
};

/// (motion, names) => positions [m] of the key bodies, z up. The up axis is the one along which the upper body is above
/// the feet in the mean. A unit that the file doesn't state follows from the length of the legs. Gaps of markers are
/// bridged by straight lines. Hip centres that a marker set lacks come from the iliac spines by the regression of M.
/// Harrington et al., J. Biomechanics 40(3):595-602, 2007. Throws ConfigError if no body is known.
Recording make_recording(const std::string& file, Motion motion, const NameTable& names,
                         const RecordingOptions& options = {});

}  // namespace pmg::mocap
