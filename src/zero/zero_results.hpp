// Output of a finished zero calibration: zero.json, report.html, and the actuators of zero.yaml.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "pages/page.hpp"
#include "sim/motor_file.hpp"
#include "work/worth.hpp"
#include "zero/zero_calibration.hpp"

namespace pmg::zero {

struct ZeroResults {
  const model::RobotModel* robot = nullptr;
  const std::vector<StillPose>* poses = nullptr;
  ZeroOptions options;
  ZeroCalibration found;
  bool interrupted = false;
};

/// (actuators, results) => (actuators with sensor.zero_offset_rad = -z, reading minus true angle, at the joints whose
/// zero points are known well or roughly). -z replaces an actuator's earlier offset: readings of poses are raw, so z
/// corrects the whole offset.
sim::ActuatorsByJoint with_zero_offsets(sim::ActuatorsByJoint actuators, const ZeroResults& results);

/// A joint whose zero point the poses do not determine, with the reason.
struct UnobservedJoint {
  std::string name, why;
};
std::vector<UnobservedJoint> unobserved_joints(const ZeroResults& results);

/// Interrupted; off its data, where the poses disagree by more than kMostWeightedRms; missed, where the iteration did
/// not converge; partial, where the zero point of a joint between soles and IMU is known roughly or not at all.
work::Worth worth_of(const ZeroResults& results);
inline constexpr double kMostWeightedRms = 3.0;  ///< of what was expected: three standard deviations

nlohmann::ordered_json zero_json(const ZeroResults& results);
pages::Page zero_report(const ZeroResults& results);
std::vector<std::string> zero_text(const ZeroResults& results);     ///< lines for a console
std::vector<std::string> zero_remarks(const ZeroResults& results);  ///< of zero.yaml

}  // namespace pmg::zero
