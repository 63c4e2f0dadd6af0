#include "robot_diagnosis/hidden_robot.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "excitation/robot_excitation.hpp"
#include "model/clip_library_file.hpp"
#include "sil/simulated_robot.hpp"

namespace pmg::robot_diagnosis {

namespace {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double between(double lower, double upper) {
    return lower + (upper - lower) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  double either_sign(double least, double most) { return (coin() ? 1.0 : -1.0) * between(least, most); }
  bool coin() { return between(0.0, 1.0) < 0.5; }
  int below(int count) { return static_cast<int>(between(0.0, 1.0) * count); }
  JointVector joints(int count, double half_width, double center) {
    JointVector values(count);
    for (double& value : values) value = center + between(-half_width, half_width);
    return values;
  }

 private:
  std::mt19937_64 engine_;
};

void vary_within_a_kind(Draw& draw, const model::RobotModel& robot, sim::Variation& variation) {
  const int n = robot.joint_index.size();
  for (const auto& [name, link] : robot.urdf->links_) {
    if (link->inertial) variation.link_mass_factor[name] = 1.0 + draw.between(-0.015, 0.015);
  }
  for (int axis = 0; axis < 3; ++axis) variation.torso_center_of_mass_m[axis] = draw.between(-0.003, 0.003);
  variation.kp_factor = draw.joints(n, 0.015, 1.0);
  variation.kd_factor = draw.joints(n, 0.04, 1.0);
  variation.armature_factor = draw.joints(n, 0.08, 1.0);
  variation.joint_friction_factor = draw.joints(n, 0.2, 1.0);
  variation.encoder_offset_rad = draw.joints(n, 0.002, 0.0);
}

/// One joint's effect, by the drive's model or by the joint's own numbers.
HiddenEffect hide_in_joint(Draw& draw, const model::RobotModel& robot, sim::WorldOptions& options) {
  const int j = draw.below(robot.joint_index.size());
  const model::Joint& joint = robot.joints[static_cast<std::size_t>(j)];
  sim::Variation& v = options.variation;
  model::ActuatorParameters& motor = options.motors[joint.name];
  const auto with_friction = [&] {  // a motor of its own with the joint's friction
    motor.friction.coulomb_Nm = joint.friction_Nm * v.joint_friction_factor[j];
    motor.friction.viscous_Nm_s_per_rad = joint.damping_Nm_s_per_rad;
  };
  switch (draw.below(7)) {
    case 0: {
      const double share = draw.either_sign(0.1, 0.3);
      if (draw.coin())
        motor.drive.kp_scale = 1.0 + share;
      else
        v.kp_factor[j] = 1.0 + share;
      return {"gain", joint.name, {share}};
    }
    case 1: {
      const double share = draw.either_sign(0.3, 0.6);
      motor.drive.kd_scale = 1.0 + share;
      return {"damping_gain", joint.name, {share}};
    }
    case 2: {
      const double more_Nm = draw.between(1.0, 3.0) * joint.friction_Nm;
      with_friction();
      motor.friction.coulomb_Nm += more_Nm;
      return {"coulomb", joint.name, {more_Nm}};
    }
    case 3: {
      const double more = draw.between(1.5, 4.0) * joint.damping_Nm_s_per_rad;
      with_friction();
      motor.friction.viscous_Nm_s_per_rad += more;
      return {"viscous", joint.name, {more}};
    }
    case 4: {
      const double share = draw.between(0.5, 1.2);
      v.armature_factor[j] = 1.0 + share;
      return {"armature", joint.name, {share * joint.armature_kg_m2}};
    }
    case 5: {
      const double offset_rad = draw.either_sign(0.02, 0.06);
      v.encoder_offset_rad[j] = offset_rad;
      return {"zero_offset", joint.name, {offset_rad}};
    }
    default: {
      motor.command.delay_s = draw.between(0.004, 0.016);
      return {"delay", joint.name, {motor.command.delay_s}};
    }
  }
}

}  // namespace

HiddenRobot hide(const model::RobotModel& robot, std::uint64_t seed) {
  Draw draw(0x5eed0000 + seed);
  HiddenRobot result{.hidden = {}, .ground_friction = draw.between(0.3, 1.1), .robot = robot, .options = {}};
  sim::WorldOptions& options = result.options;
  options = sil::world_with_noise(seed, false);
  options.velocity_noise_rad_s = 0.01;
  options.floor_friction = result.ground_friction;
  vary_within_a_kind(draw, robot, options.variation);
  switch (seed % 10) {
    case 0:
    case 1:
      break;  // clean
    case 2: {
      options.variation.torso_mass_kg = draw.between(1.0, 4.0);
      result.hidden = {"payload", robot.torso_link, {options.variation.torso_mass_kg}};
      break;
    }
    case 3: {
      const Foot side = draw.coin() ? kLeft : kRight;
      options.variation.hand_payload_kg[side] = draw.between(1.0, 2.0);
      result.hidden = {"payload", sim::hand_links(robot)[side], {options.variation.hand_payload_kg[side]}};
      break;
    }
    case 4: {
      if (draw.coin()) {  // else an IMU
        const Eigen::Vector3d shift_m(draw.either_sign(0.015, 0.04), draw.either_sign(0.0, 0.03),
                                      draw.between(-0.02, 0.02));
        options.variation.torso_center_of_mass_m += shift_m;
        result.hidden = {"center_of_mass", robot.torso_link, {shift_m.x(), shift_m.y(), shift_m.z()}};
        break;
      }
      [[fallthrough]];
    }
    case 5: {
      const Eigen::Vector3d turn_rad(draw.either_sign(0.01, 0.05), draw.either_sign(0.01, 0.05),
                                     draw.between(-0.03, 0.03));
      result.robot.imu.T_LI.linear() =
          robot.imu.T_LI.linear() * Eigen::AngleAxisd(turn_rad.norm(), turn_rad.normalized()).toRotationMatrix();
      result.hidden = {"imu_mounting", robot.imu.link, {turn_rad.x(), turn_rad.y(), turn_rad.z()}};
      break;
    }
    default:
      result.hidden = hide_in_joint(draw, robot, options);
      break;
  }
  return result;
}

bool named_right(const HiddenEffect& hidden, const RobotDiagnosis& diagnosis) {
  if (hidden.effect.empty()) return diagnosis.verdict == evidence::Verdict::kNone;
  if (diagnosis.verdict != evidence::Verdict::kFound || diagnosis.causes.size() != 1) return false;
  const RobotCause& cause = diagnosis.causes.front();
  if (cause.effect != hidden.effect || cause.place != hidden.place) return false;
  for (std::size_t i = 0; i < hidden.values.size(); ++i) {
    const double error = std::abs(cause.parameters[i].estimate.value - hidden.values[i]);
    if (hidden.effect == "payload" && error > 0.15 * hidden.values[i]) return false;
    if (hidden.effect == "imu_mounting" && error > 0.3 * std::numbers::pi / 180.0) return false;
  }
  return true;
}

std::vector<RobotRecording> record_hidden(const HiddenRobot& hidden) {
  std::vector<RobotRecording> recordings;
  sim::WorldOptions options = hidden.options;
  options.gantry = true;
  {
    sim::World world(hidden.robot, options);
    recordings.push_back(play(world, excitation::hanging_excitation(hidden.robot), "hanging"));
  }
  options.gantry = false;
  sim::World world(hidden.robot, options);
  const ClipLibrary clips = model::load_clip_library(hidden.robot.directory / "clips", hidden.robot);
  recordings.push_back(play(world, excitation::standing_excitation(hidden.robot, clips), "standing"));
  return recordings;
}

}  // namespace pmg::robot_diagnosis
