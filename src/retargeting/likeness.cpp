#include "retargeting/likeness.hpp"

#include <algorithm>
#include <cmath>

#include "retargeting/leg_imitation.hpp"

namespace pmg::retargeting {
namespace {

void add(const SidePose& pose, LegAngles& angles) {
  angles.thigh.push_back(thigh_pitch_rad(pose));
  angles.knee.push_back(knee_flexion_rad(pose));
  angles.ankle.push_back(ankle_flexion_rad(pose));
}

Likeness worse_leg(const PerFoot<LegAngles>& robot, const PerFoot<LegAngles>& human,
                   std::vector<double> LegAngles::*curve) {
  Likeness worse;
  for (const Foot foot : {kLeft, kRight}) {
    const auto array = [curve](const LegAngles& of) {
      return Eigen::Map<const Eigen::ArrayXd>((of.*curve).data(), std::ssize(of.*curve));
    };
    const Eigen::ArrayXd ours = array(robot[foot]), theirs = array(human[foot]);
    const Eigen::ArrayXd a = ours - ours.mean(), b = theirs - theirs.mean();
    worse.rms_rad = std::max(worse.rms_rad, std::sqrt((ours - theirs).square().mean()));
    worse.shape_rad = std::max(worse.shape_rad, std::sqrt((a - b).square().mean()));
    worse.correlation = std::min(worse.correlation, (a * b).sum() / std::sqrt(a.square().sum() * b.square().sum()));
  }
  return worse;
}

}  // namespace

PerFoot<LegAngles> leg_angles(const generator::RobotLegs& legs, const std::vector<generator::LegPose>& q,
                              const std::vector<generator::BaseMotion>& base) {
  PerFoot<LegAngles> angles;
  for (std::size_t k = 0; k < q.size(); ++k) {
    for (const Foot foot : {kLeft, kRight}) {
      SidePose pose = leg_directions(legs.geometry[foot], q[k][foot]);
      for (Eigen::Vector3d* d : {&pose.thigh, &pose.shank, &pose.sole}) *d = base[k].R_HB * *d;
      add(pose, angles[foot]);
    }
  }
  return angles;
}

PerFoot<LegAngles> leg_angles(const HumanCycle& human) {
  PerFoot<LegAngles> angles;
  for (const HumanPose& pose : human.pose) {
    for (const Foot foot : {kLeft, kRight}) add(pose.side[foot], angles[foot]);
  }
  return angles;
}

Imitation imitation(const PerFoot<LegAngles>& robot, const PerFoot<LegAngles>& human) {
  return {worse_leg(robot, human, &LegAngles::thigh), worse_leg(robot, human, &LegAngles::knee),
          worse_leg(robot, human, &LegAngles::ankle)};
}

}  // namespace pmg::retargeting
