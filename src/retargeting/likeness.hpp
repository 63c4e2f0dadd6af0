// How like a human's legs a robot's legs move: angles in the sagittal plane, compared at the same phase.
#pragma once

#include <vector>

#include "generator/gait_measure.hpp"
#include "retargeting/human_cycle.hpp"

namespace pmg::retargeting {

/// One leg's angles [rad], one per sample of a cycle.
struct LegAngles {
  std::vector<double> thigh, knee, ankle;  ///< as thigh_pitch_rad, knee_flexion_rad, ankle_flexion_rad
};

/// Of a robot whose base has these attitudes, one per sample.
PerFoot<LegAngles> leg_angles(const generator::RobotLegs& legs, const std::vector<generator::LegPose>& q,
                              const std::vector<generator::BaseMotion>& base);
PerFoot<LegAngles> leg_angles(const HumanCycle& human);

/// Robot's curve against the same human's at the same phase; the worse of both legs.
struct Likeness {
  double rms_rad = 0.0;    ///< with the difference of the means
  double shape_rad = 0.0;  ///< RMS without it
  double correlation = 1.0;
};

/// Robot against human.
struct Imitation {
  Likeness thigh, knee, ankle;
};
Imitation imitation(const PerFoot<LegAngles>& robot, const PerFoot<LegAngles>& human);

}  // namespace pmg::retargeting
