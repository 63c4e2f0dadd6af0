// The diagnosis of a whole robot from its logs: payload, centre of mass, IMU mounting, ground, and single joints.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "evidence/verdict.hpp"
#include "robot_diagnosis/robot_evidence.hpp"
#include "robot_diagnosis/robot_ground.hpp"
#include "robot_diagnosis/robot_options.hpp"
#include "robot_diagnosis/robot_recording.hpp"

namespace pmg::robot_diagnosis {

struct RobotCause {
  std::string effect{}, place{};  ///< of RobotCandidate
  std::vector<evidence::ParameterEstimate> parameters{};
  double log_evidence = 0.0;
  int folds_better = 0, folds = 0;
  std::vector<std::string> or_instead{};  ///< "effect of place"
  std::string told_apart_by{};            ///< "hanging" or "standing": where the rivals differ most; "" without rivals
};

/// Recorded time of each kind of support [s].
struct RobotCoverage {
  double hanging_s = 0.0, standing_s = 0.0, other_s = 0.0;
};

struct RobotDiagnosis {
  evidence::Verdict verdict = evidence::Verdict::kNone;
  std::vector<RobotCause> causes;  ///< the strongest first
  GroundFriction ground;
  RobotCoverage coverage;
  double held_out_before = 0.0, held_out_after = 0.0;  ///< rms of left-out equations, in units of their noise
  std::vector<std::string> depends_on;                 ///< unexplained: equations whose residual exceeds the noise
  std::vector<RobotCause> others;                      ///< the next candidates, with their evidence, no parameters
  std::vector<std::string> recordings;                 ///< each log, and where it was made
  std::string drive_sampling;                          ///< when the drives sample positions, and the source
  RobotDiagnosisOptions options;                       ///< thresholds in force
  std::vector<std::string> not_seen;                   ///< "effect of place": not observable in these logs
};

/// (robot, recordings) => (diagnosis). Throws std::runtime_error if the recordings hold no usable data,
/// work::Interrupted after an interruption.
RobotDiagnosis diagnose_robot(const model::RobotModel& robot, std::span<const RobotRecording> recordings,
                              const RobotDiagnosisOptions& options = {}, const work::Progress& progress = {});

}  // namespace pmg::robot_diagnosis
