#include "zero/zero_stances.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <Eigen/Dense>
#include <stdexcept>

#include "io/whole_file.hpp"
#include "model/clip_library_file.hpp"
#include "model/clip_library_writer.hpp"
#include "model/leg_kinematics.hpp"

namespace pmg::zero {

namespace {

namespace fs = std::filesystem;

constexpr double kCommandStep_m = 0.001;     // of the height command from one stance to the next
constexpr double kMove_s = 2.0;              // from one stance to the next, feet in the air
constexpr double kLift_s = 4.5;              // tighten the rope, lift, move
constexpr double kHold_s = 7.0;              // 3.5 s down, settling, and three seconds of averaging
constexpr double kLegMargin_rad = 0.18;      // zero points may be 0.1 off, and legs yield
constexpr double kLimitMargin_rad = 0.05;    // of the other joints; the generator keeps 0.035
constexpr std::size_t kFewestStances = 10;   // 5 equations each, 12 joints and a few unknowns besides
constexpr double kSoftKp_Nm_per_rad = 15.0;  // 3 Nm, a tenth of the joint's torque, turn a sole that is 0.2 rad off
constexpr double kYieldingLeg = 0.5;  // share of the gains: legs that offsets make unequal still share the weight
constexpr double kSoftKd_Nm_s_per_rad = 1.0;

/// Rotation vector of a small rotation.
Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

/// Inverse kinematics by damped Newton steps; the legs stay far from singular postures.
void reach(JointVector& q, const model::RobotModel& robot, Foot foot, const Eigen::Matrix3d& R_BF,
           const Eigen::Vector3d& sole_B, const std::string& stance) {
  model::LegKinematics legs(robot);
  const JointVector rest = JointVector::Zero(q.size());
  const auto& joints = robot.leg_joints[foot];
  for (int iteration = 0; iteration < 100; ++iteration) {
    const model::FootKinematics& now = legs.compute(q, rest)[foot];
    const Eigen::Vector3d arm_B =
        now.R_BF * (robot.feet[foot].box_center_F - Eigen::Vector3d(0.0, 0.0, robot.feet[foot].box_half_size_m.z()));
    Eigen::Matrix<double, 6, 1> miss;
    miss << sole_B - (now.p_BF + arm_B), rotation_vector(R_BF * now.R_BF.transpose());
    Eigen::MatrixXd J = now.J;
    for (Eigen::Index i = 0; i < J.cols(); ++i)
      J.col(i).head<3>() += Eigen::Vector3d(now.J.col(i).tail<3>()).cross(arm_B);
    const Eigen::MatrixXd normal = J.transpose() * J + 1e-6 * Eigen::MatrixXd::Identity(J.cols(), J.cols());
    const Eigen::VectorXd step = normal.ldlt().solve(J.transpose() * miss);
    for (std::size_t i = 0; i < joints.size(); ++i)
      q[joints[i]] += std::clamp(step[static_cast<Eigen::Index>(i)], -0.2, 0.2);
    if (miss.norm() < 1e-9) return;
  }
  throw std::invalid_argument(fmt::format("{}: the {} leg can't reach the stance \"{}\"", robot.name,
                                          foot == kLeft ? "left" : "right", stance));
}

/// Turns the joints between pelvis and torso until the torso has this attitude in the base frame.
void turn_torso(JointVector& q, const model::RobotModel& robot, const Eigen::Matrix3d& R_BT) {
  if (robot.torso_joints.empty()) return;
  model::ChainKinematics torso(robot.torso_chain, robot.torso_joints);
  for (int iteration = 0; iteration < 50; ++iteration) {
    torso.compute(q);
    const Eigen::Vector3d miss = rotation_vector(R_BT * torso.R().transpose());
    Eigen::MatrixXd J(3, static_cast<Eigen::Index>(torso.size()));
    for (std::size_t i = 0; i < torso.size(); ++i) J.col(static_cast<Eigen::Index>(i)) = torso.axis(i);
    const Eigen::VectorXd step = J.completeOrthogonalDecomposition().solve(miss);
    for (std::size_t i = 0; i < torso.size(); ++i) q[torso.joint(i)] += step[static_cast<Eigen::Index>(i)];
  }
}

void expect_within_limits(const JointVector& q, const model::RobotModel& robot, const std::string& stance) {
  std::vector<double> margin_rad(robot.joints.size(), kLimitMargin_rad);
  for (const auto& leg : robot.leg_joints) {
    for (const int joint : leg) margin_rad[static_cast<std::size_t>(joint)] = kLegMargin_rad;
  }
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const model::Joint& joint = robot.joints[j];
    const double angle_rad = q[static_cast<Eigen::Index>(j)];
    if (angle_rad >= joint.lower_rad + margin_rad[j] && angle_rad <= joint.upper_rad - margin_rad[j]) continue;
    if (angle_rad == joint.stand_rad) continue;
    throw std::invalid_argument(
        fmt::format("{}: the stance \"{}\" needs {} at {:.3f} rad; its range is {:.3f} to {:.3f}, less {} at each end",
                    robot.name, stance, joint.name, angle_rad, joint.lower_rad, joint.upper_rad, margin_rad[j]));
  }
}

/// robot.yaml with soft sole joints and a height command that selects the stance.
std::string rig_yaml(const model::RobotModel& robot, std::size_t stances) {
  YAML::Node yaml = YAML::LoadFile((robot.directory / "robot.yaml").string());
  yaml.remove("policy");  // it was trained with other leg gains and clips
  for (const auto& leg : robot.leg_joints) {
    for (const int joint : leg)
      yaml["joints"][robot.joint_index.name(joint)]["kp_Nm_per_rad"] =
          kYieldingLeg * robot.joints[static_cast<std::size_t>(joint)].kp_Nm_per_rad;
  }
  for (const int joint : sole_joints(robot)) {
    YAML::Node node = yaml["joints"][robot.joint_index.name(joint)];
    node["kp_Nm_per_rad"] = kSoftKp_Nm_per_rad;
    node["kd_Nm_s_per_rad"] = kSoftKd_Nm_s_per_rad;
  }
  YAML::Node height = yaml["command"]["height_m"];
  height["range"] = std::vector<double>{-kCommandStep_m * static_cast<double>(stances), kCommandStep_m};
  height["rate_per_s"] = kCommandStep_m / kMove_s;
  return fmt::format("# {} for taking the logs of a zero calibration: made by pmg_calibrate_zero.\n{}\n", robot.name,
                     YAML::Dump(yaml));
}

std::string scenario_yaml(const std::vector<ZeroStance>& stances) {
  std::string text =
      "# Every stance of a zero calibration: the gantry lifts the robot, it takes the posture, and is set down in "
      "straps "
      "that\n# keep the torso upright while the legs carry the weight.\nname: zero calibration\nsteps:\n"
      "  - {for_s: 4.0, text: lifted, mode: stand, hoist_without_policy: true, steady_without_policy: true}\n";
  for (std::size_t k = 0; k < stances.size(); ++k) {
    const double command = -kCommandStep_m * static_cast<double>(k + 1);
    text += fmt::format(
        "  - {{for_s: {}, text: \"to {}\", mode: walk, command: {{height_m: {}}}, hoist_without_policy: true}}\n",
        kLift_s, stances[k].text, command);
    text += fmt::format("  - {{for_s: {}, text: \"{}\", command: {{height_m: {}}}, hoist_without_policy: false}}\n",
                        kHold_s, stances[k].text, command);
  }
  return text;
}

StaticClip stance_clip(const std::vector<ZeroStance>& stances, const model::RobotModel& robot) {
  StaticClip clip;
  for (std::size_t k = stances.size(); k-- > 0;) {
    clip.command.push_back(-kCommandStep_m * static_cast<double>(k + 1));
    clip.q.push_back(posture(stances[k], robot));
  }
  for (const double command : {0.0, kCommandStep_m}) {
    clip.command.push_back(command);
    clip.q.push_back(robot.q_stand());
  }
  return clip;
}

}  // namespace

std::vector<ZeroStance> zero_stances() {
  const auto soles = [](SolePlace left, SolePlace right) { return PerFoot<SolePlace>{left, right}; };
  return {
      {"standing", 0.03, 0.0, 0.0, soles({}, {})},
      {"left foot ahead", 0.06, 0.0, 0.0, soles({0.14, 0.02, 0.0}, {-0.14, 0.0, 0.1})},
      {"right foot ahead", 0.06, 0.0, 0.0, soles({-0.14, 0.0, 0.1}, {0.14, 0.02, 0.0})},
      {"left foot ahead, low", 0.10, 0.0, 0.0, soles({0.14, 0.0, 0.1}, {-0.08, 0.02, 0.3})},
      {"right foot ahead, low", 0.10, 0.0, 0.0, soles({-0.08, 0.02, 0.3}, {0.14, 0.0, 0.1})},
      {"left foot far ahead", 0.06, 0.0, 0.0, soles({0.22, 0.0, 0.0}, {-0.04, 0.0, 0.0})},
      {"right foot far ahead", 0.06, 0.0, 0.0, soles({-0.04, 0.0, 0.0}, {0.22, 0.0, 0.0})},
      {"left foot far behind", 0.07, 0.0, 0.0, soles({-0.16, 0.0, 0.0}, {0.06, 0.0, 0.0})},
      {"right foot far behind", 0.07, 0.0, 0.0, soles({0.06, 0.0, 0.0}, {-0.16, 0.0, 0.0})},
      {"squat, toes out", 0.11, 0.0, 0.0, soles({0.0, 0.05, 0.35}, {0.0, 0.05, 0.35})},
      {"left leg out", 0.06, 0.0, 0.0, soles({0.0, 0.13, 0.0}, {0.03, -0.02, 0.0})},
      {"right leg out", 0.06, 0.0, 0.0, soles({0.03, -0.02, 0.0}, {0.0, 0.13, 0.0})},
      {"pelvis to the right", 0.08, 0.15, 0.0, soles({0.05, 0.02, 0.2}, {-0.05, 0.02, 0.0})},
      {"pelvis to the left", 0.08, -0.15, 0.0, soles({-0.05, 0.02, 0.0}, {0.05, 0.02, 0.2})},
      {"bent, left foot ahead", 0.07, 0.0, 0.2, soles({0.14, 0.03, 0.0}, {-0.1, 0.0, 0.0})},
      {"bent, right foot ahead", 0.07, 0.0, 0.2, soles({-0.1, 0.0, 0.0}, {0.14, 0.03, 0.0})},
      {"left toes out, low", 0.10, 0.0, 0.0, soles({0.08, 0.04, 0.4}, {-0.05, 0.0, -0.1})},
      {"right toes out, low", 0.10, 0.0, 0.0, soles({-0.05, 0.0, -0.1}, {0.08, 0.04, 0.4})},
      {"left toes in, leg out", 0.09, 0.0, 0.0, soles({0.05, 0.1, -0.25}, {-0.05, 0.0, 0.25})},
      {"right toes in, leg out", 0.09, 0.0, 0.0, soles({-0.05, 0.0, 0.25}, {0.05, 0.1, -0.25})},
  };
}

JointVector posture(const ZeroStance& stance, const model::RobotModel& robot) {
  JointVector q = robot.q_stand();
  const JointVector rest = JointVector::Zero(q.size());
  model::LegKinematics legs(robot);
  const PerFoot<model::FootKinematics> standing = legs.compute(q, rest);
  // W: at the pelvis' origin, level, x along its heading.
  const Eigen::Matrix3d R_WB = (Eigen::AngleAxisd(stance.pelvis_pitch_rad, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(stance.pelvis_roll_rad, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  for (const Foot foot : {kLeft, kRight}) {
    const SolePlace& place = stance.soles[foot];
    const double outward = foot == kLeft ? 1.0 : -1.0;
    Eigen::Vector3d sole_W = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& corner : standing[foot].sole_B) sole_W += 0.25 * corner;
    sole_W += Eigen::Vector3d(place.forward_m, outward * place.outward_m, 0.0);
    sole_W.z() = stance.drop_m - robot.standing_height_m;
    const Eigen::Matrix3d R_WF =
        Eigen::AngleAxisd(outward * place.turned_out_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    reach(q, robot, foot, R_WB.transpose() * R_WF, R_WB.transpose() * sole_W, stance.text);
  }
  turn_torso(q, robot, R_WB.transpose());
  expect_within_limits(q, robot, stance.text);
  return q;
}

std::vector<ZeroStance> reachable_stances(const model::RobotModel& robot) {
  std::vector<ZeroStance> reachable;
  std::string last_refusal;
  for (const ZeroStance& stance : zero_stances()) {
    try {
      posture(stance, robot);
      reachable.push_back(stance);
    } catch (const std::invalid_argument& refusal) {
      last_refusal = refusal.what();
    }
  }
  if (reachable.size() < kFewestStances) {
    throw std::invalid_argument(fmt::format("{} can take {} stances; expected {} at least ({})", robot.name,
                                            reachable.size(), kFewestStances, last_refusal));
  }
  return reachable;
}

std::vector<int> sole_joints(const model::RobotModel& robot) {
  std::vector<int> joints;
  for (const auto& leg : robot.leg_joints) {
    joints.insert(joints.end(), leg.size() < 2 ? leg.begin() : leg.end() - 2, leg.end());
  }
  return joints;
}

void write_zero_rig(const model::RobotModel& robot, const fs::path& out) {
  const std::vector<ZeroStance> stances = reachable_stances(robot);
  const StaticClip clip = stance_clip(stances, robot);
  const fs::path clips = out / "clips";
  fs::create_directories(clips);
  const fs::path urdf = YAML::LoadFile((robot.directory / "robot.yaml").string())["urdf"].as<std::string>();
  fs::create_directories((out / urdf).parent_path());
  fs::copy_file(robot.directory / urdf, out / urdf, fs::copy_options::overwrite_existing);
  // Leave out the command inverse: it belongs to the robot's own clips.
  for (const fs::path& file : model::clip_library_files(robot.directory / "clips")) {
    if (file.stem() != "inverse") fs::copy_file(file, clips / file.filename(), fs::copy_options::overwrite_existing);
  }
  model::write_static_clip(clips, "squat", kHeight, clip, robot, "stances of the zero calibration");
  io::write_whole_file(out / "robot.yaml", rig_yaml(robot, stances.size()));
  io::write_whole_file(out / "scenario.yaml", scenario_yaml(stances));
}

}  // namespace pmg::zero
