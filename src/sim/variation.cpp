#include "sim/variation.hpp"

#include <fmt/format.h>

#include <cmath>
#include <kdl/chain.hpp>
#include <numbers>
#include <random>
#include <stdexcept>

#include "sim/world.hpp"

namespace pmg::sim {

namespace {

/// Uniform numbers that are the same on every machine. std::uniform_real_distribution may differ between standard
/// libraries.
class UniformSource {
 public:
  explicit UniformSource(std::uint64_t seed) : engine_(seed) {}
  double in(const Range& range) { return range.lower + (range.upper - range.lower) * share(); }
  double around_zero(double half_width) { return in({-half_width, half_width}); }
  double share() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  std::uint64_t seed() { return engine_(); }

  JointVector joints(const Range& range, int count) {
    JointVector values(count);
    for (double& value : values) value = in(range);
    return values;
  }

 private:
  std::mt19937_64 engine_;
};

double deviation(double half_width) { return half_width / std::numbers::sqrt3; }

/// Number of moving joints from the torso to a link, and the last link that moves; 0 if the torso isn't above the link.
struct Arm {
  int joints = 0;
  std::string last_moving_link;
};
Arm arm_to(const model::RobotModel& robot, const std::string& link) {
  KDL::Chain chain;
  Arm arm;
  if (!robot.tree.getChain(robot.torso_link, link, chain)) return arm;
  for (const KDL::Segment& segment : chain.segments) {
    const KDL::Joint& joint = segment.getJoint();
    if (joint.getType() == KDL::Joint::Fixed) continue;
    // getChain climbs first. Joints of the torso's own chain lead away from it, so they lead to no hand.
    for (const int above : robot.torso_joints) {
      if (joint.getName() == robot.joints[static_cast<std::size_t>(above)].name) return {};
    }
    ++arm.joints;
    arm.last_moving_link = segment.getName();
  }
  return arm;
}

double factor(const JointVector& factors, Eigen::Index joint) { return factors.size() > 0 ? factors[joint] : 1.0; }

void expect_size(const JointVector& values, const model::RobotModel& robot, const char* what) {
  if (values.size() == 0 || values.size() == robot.joint_index.size()) return;
  throw std::invalid_argument(
      fmt::format("{}: {} values; expected one for each of {} joints", what, values.size(), robot.joint_index.size()));
}

int body(const mjModel* model, const std::string& link) {
  const int id = mj_name2id(model, mjOBJ_BODY, link.c_str());
  if (id < 0) throw std::invalid_argument(fmt::format("variation of link {}: the robot has no such link", link));
  return id;
}

}  // namespace

// A seed's meaning includes the order of the draws: new draws go to the end.
void vary(WorldOptions& options, const VariationRanges& ranges, const model::RobotModel& robot, std::uint64_t seed) {
  UniformSource random(seed);
  options.seed = random.seed();
  const int joints = robot.joint_index.size();
  Variation& v = options.variation;
  options.floor_friction = random.in(ranges.friction);
  v.torso_mass_kg = random.in(ranges.torso_mass_kg);
  for (double& shift : v.torso_center_of_mass_m) shift = random.around_zero(ranges.torso_center_of_mass_m);
  const bool carries = random.share() < ranges.payload_share;
  for (const Foot side : {kLeft, kRight}) {
    const double payload_kg = random.in(ranges.hand_payload_kg);
    v.hand_payload_kg[side] = carries ? payload_kg : 0.0;
  }
  v.delay_s = random.in(ranges.delay_s);
  v.armature_factor = random.joints(ranges.armature_factor, joints);
  v.joint_friction_factor = random.joints(ranges.joint_friction_factor, joints);
  v.kp_factor = random.joints(ranges.kp_factor, joints);
  v.kd_factor = random.joints(ranges.kd_factor, joints);
  v.encoder_offset_rad = random.joints({-ranges.encoder_offset_rad, ranges.encoder_offset_rad}, joints);
  v.link_mass_factor.clear();
  for (const auto& [name, link] : robot.urdf->links_) {  // sorted by name
    if (link->inertial) v.link_mass_factor[name] = random.in(ranges.link_mass_factor);
  }
  options.gyro_noise_rad_s = deviation(ranges.gyro_noise_rad_s);
  options.orientation_noise_rad = deviation(ranges.gravity_direction_noise);
  options.encoder_noise_rad = deviation(ranges.encoder_noise_rad);
  options.velocity_noise_rad_s = deviation(ranges.velocity_noise_rad_s);
  if (carries) hand_links(robot);
}

PerFoot<std::string> hand_links(const model::RobotModel& robot) {
  PerFoot<Arm> arms;
  for (const auto& [name, link] : robot.urdf->links_) {
    const Arm arm = arm_to(robot, name);
    for (const Foot side : {kLeft, kRight}) {
      const char* mark = side == kLeft ? "left_" : "right_";
      if (arm.last_moving_link.find(mark) != std::string::npos && arm.joints > arms[side].joints) arms[side] = arm;
    }
  }
  for (const Foot side : {kLeft, kRight}) {
    if (arms[side].joints == 0) {
      throw std::invalid_argument(fmt::format("{}: no {} arm hangs on {}; a payload needs a hand", robot.name,
                                              side == kLeft ? "left" : "right", robot.torso_link));
    }
  }
  return {arms[kLeft].last_moving_link, arms[kRight].last_moving_link};
}

void expect_joints(const Variation& variation, const model::RobotModel& robot) {
  expect_size(variation.armature_factor, robot, "armature_factor");
  expect_size(variation.joint_friction_factor, robot, "joint_friction_factor");
  expect_size(variation.kp_factor, robot, "kp_factor");
  expect_size(variation.kd_factor, robot, "kd_factor");
  expect_size(variation.encoder_offset_rad, robot, "encoder_offset_rad");
}

model::ActuatorParameters varied(model::ActuatorParameters actuator, const Variation& variation, Eigen::Index joint) {
  actuator.drive.kp_scale *= factor(variation.kp_factor, joint);
  actuator.drive.kd_scale *= factor(variation.kd_factor, joint);
  actuator.transmission.armature_kg_m2 *= factor(variation.armature_factor, joint);
  model::ActuatorParameters::Friction& friction = actuator.friction;
  for (double* dry : {&friction.coulomb_Nm, &friction.stribeck_Nm, &friction.load_driving, &friction.load_backdriving})
    *dry *= factor(variation.joint_friction_factor, joint);
  if (variation.encoder_offset_rad.size() > 0) actuator.sensor.zero_offset_rad += variation.encoder_offset_rad[joint];
  return actuator;
}

void apply(const Variation& variation, const model::RobotModel& robot, mjModel* model, mjData* data) {
  for (const auto& [link, factor] : variation.link_mass_factor) {
    const int id = body(model, link);
    model->body_mass[id] *= factor;
    for (int axis = 0; axis < 3; ++axis) model->body_inertia[3 * id + axis] *= factor;
  }
  const int torso = body(model, robot.torso_link);
  model->body_mass[torso] += variation.torso_mass_kg;
  for (int axis = 0; axis < 3; ++axis) model->body_ipos[3 * torso + axis] += variation.torso_center_of_mass_m[axis];
  if (variation.hand_payload_kg[kLeft] > 0.0 || variation.hand_payload_kg[kRight] > 0.0) {
    const PerFoot<std::string> hands = hand_links(robot);
    for (const Foot side : {kLeft, kRight}) {
      model->body_mass[body(model, hands[side])] += variation.hand_payload_kg[side];
    }
  }
  for (int id = 1; id < model->nbody; ++id) {
    if (model->body_mass[id] < 0.0) {
      throw std::invalid_argument(
          fmt::format("variation leaves {} kg of {}", model->body_mass[id], mj_id2name(model, mjOBJ_BODY, id)));
    }
  }
  mj_setConst(model, data);
}

}  // namespace pmg::sim
