#include "model/robot_model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <kdl/treefksolverpos_recursive.hpp>
#include <limits>

#include "files/config_reader.hpp"
#include "model/leg_kinematics.hpp"
#include "model/mirror.hpp"
#include "model/standing_posture.hpp"
#include "model/urdf_tree.hpp"

namespace pmg::model {
namespace {

Eigen::Vector3d vector3(files::ConfigReader& reader, const std::string& key,
                        const files::NumberCheck& check = files::any_number()) {
  const std::vector<double> v = reader.numbers(key, 3, check);
  return {v[0], v[1], v[2]};
}

std::string link_name(files::ConfigReader& reader, const std::string& key, const UrdfTree& tree) {
  const std::string name = reader.required<std::string>(key);
  if (!tree.urdf->getLink(name)) reader.fail(key, "'" + name + "' isn't a link", "a link of " + tree.file.string());
  return name;
}

FootModel read_foot(files::ConfigReader reader, const UrdfTree& tree) {
  FootModel foot;
  foot.link = link_name(reader, "link", tree);
  foot.box_center_F = vector3(reader, "box_center_m");
  foot.box_half_size_m = 0.5 * vector3(reader, "box_size_m", files::positive());
  reader.finish();
  return foot;
}

SerialImuModel read_serial_imu(files::ConfigReader reader) {
  reader.one_of("protocol", {"xsens_mti"});
  SerialImuModel serial;
  serial.device = reader.required<std::string>("device");
  if (!serial.device.starts_with("/dev/")) reader.fail("device", "is '" + serial.device + "'", "a file below /dev");
  // A policy needs a sample a tick, and an IMU that is 10 ms silent is late: 200 Hz leave one sample to be lost.
  serial.rate_Hz = reader.required<int>("rate_Hz", files::in_range(200, 2000));
  serial.baud = reader.required<int>("baud", files::in_range(57'600, 4'000'000));
  constexpr int kBitsPerSample = 66 * 10;  // the message, with start and stop bits
  if (serial.baud < kBitsPerSample * serial.rate_Hz) {
    reader.fail("baud", "carries no " + std::to_string(serial.rate_Hz) + " samples a second",
                "at least " + std::to_string(kBitsPerSample * serial.rate_Hz));
  }
  reader.finish();
  return serial;
}

ImuModel read_imu(files::ConfigReader reader, const UrdfTree& tree) {
  ImuModel imu;
  imu.link = link_name(reader, "link", tree);
  imu.T_LI.translation() = vector3(reader, "position_m");
  const Eigen::Vector3d rpy = vector3(reader, "rpy_rad");
  imu.T_LI.linear() =
      (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  if (reader.has("serial")) imu.serial = read_serial_imu(reader.map("serial"));
  if (reader.has("process_data")) {
    if (imu.serial) reader.fail("process_data", "stands beside `serial`", "one way to the IMU");
    reader.leave("process_data");
  }
  reader.finish();
  return imu;
}

BusAddress read_bus(files::ConfigReader reader) {
  BusAddress bus;
  bus.bus = reader.required<std::string>("name");
  bus.node = reader.required<int>("node", files::non_negative());
  bus.drive = reader.optional<std::string>("drive", "");
  bus.direction = reader.optional<int>("direction", 1);
  if (std::abs(bus.direction) != 1) reader.fail("direction", fmt::format("is {}", bus.direction), "1 or -1");
  bus.gear = reader.optional<double>("gear", 1.0, files::positive());
  if (reader.has("reply_id")) bus.reply_id = reader.required<int>("reply_id", files::in_range(0, 0x7FF));
  bus.zero_offset_rad = reader.optional<double>("zero_offset_rad", 0.0);
  reader.finish();
  return bus;
}

Joint read_joint(files::ConfigReader reader, const std::string& name, const UrdfTree& tree) {
  const urdf::JointConstSharedPtr source = tree.urdf->getJoint(name);
  if (!source || source->type == urdf::Joint::FIXED) {
    files::raise(reader.place(), "joints." + name, "isn't a moving joint", "one of " + tree.file.string());
  }
  Joint joint;
  joint.name = name;
  joint.axis = {source->axis.x, source->axis.y, source->axis.z};
  joint.lower_rad = source->limits->lower;
  joint.upper_rad = source->limits->upper;
  joint.velocity_limit_rad_s = source->limits->velocity;
  joint.effort_limit_Nm = source->limits->effort;
  joint.stand_rad = reader.required<double>("stand_rad", files::in_range(joint.lower_rad, joint.upper_rad));
  joint.sit_down_rad =
      reader.optional<double>("sit_down_rad", joint.stand_rad, files::in_range(joint.lower_rad, joint.upper_rad));
  joint.kp_Nm_per_rad = reader.required<double>("kp_Nm_per_rad", files::positive());
  joint.kd_Nm_s_per_rad = reader.required<double>("kd_Nm_s_per_rad", files::non_negative());
  joint.armature_kg_m2 = reader.required<double>("armature_kg_m2", files::non_negative());
  joint.damping_Nm_s_per_rad = reader.required<double>("damping_Nm_s_per_rad", files::non_negative());
  joint.friction_Nm = reader.required<double>("friction_Nm", files::non_negative());
  reader.one_of("drive", {"position_pd"});
  joint.bus = read_bus(reader.map("bus"));
  reader.finish();
  return joint;
}

void read_joints(RobotModel& robot, files::ConfigReader reader, const UrdfTree& tree) {
  for (const std::string& name : reader.keys()) robot.joints.push_back(read_joint(reader.map(name), name, tree));
  if (robot.joints.empty() || robot.joints.size() > static_cast<std::size_t>(kMaxJoints)) {
    files::raise(reader.place(), "joints", fmt::format("has {} joints", robot.joints.size()),
                 fmt::format("1 to {}", kMaxJoints));
  }
  robot.joint_index = JointIndex(reader.keys());
  for (const auto& [name, joint] : tree.urdf->joints_) {
    if (joint->type != urdf::Joint::FIXED && !robot.joint_index.find(name)) {
      files::raise(reader.place(), "joints." + name, "is missing",
                   fmt::format("every moving joint of {}:{}", tree.file.string(), tree.place("joint", name).line));
    }
  }
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const BusAddress &mine = robot.joints[i].bus, &theirs = robot.joints[k].bus;
      if (mine.bus == theirs.bus && mine.node == theirs.node) {
        reader.fail(robot.joints[i].name, "has the bus address of " + robot.joints[k].name, "an address of its own");
      }
    }
  }
}

void read_channel(RobotModel& robot, files::ConfigReader reader, std::size_t channel) {
  const std::vector<double> range = reader.numbers("range", 2);
  if (range[0] > 0.0 || range[1] < 0.0 || !(range[0] < range[1])) {
    reader.fail("range", fmt::format("is [{}, {}]", range[0], range[1]), "lower < upper with 0 between them");
  }
  robot.command_limits.lower[channel] = range[0];
  robot.command_limits.upper[channel] = range[1];
  robot.command_limits.rate_per_s[channel] = reader.required<double>("rate_per_s", files::positive());
  if (channel < kVelocityChannels) {
    const std::vector<double> scale = reader.numbers("velocity_scale", 2, files::positive());
    robot.velocity_scale_negative[channel] = scale[0];
    robot.velocity_scale_positive[channel] = scale[1];
  }
  reader.finish();
}

void read_policy_joints(RobotModel& robot, files::ConfigReader& reader) {
  for (const std::string& name : reader.required<std::vector<std::string>>("policy_joints")) {
    const std::optional<int> joint = robot.joint_index.find(name);
    if (!joint) reader.fail("policy_joints", "'" + name + "' isn't a joint", "names of `joints`");
    robot.joints[static_cast<std::size_t>(*joint)].policy = true;
  }
}

/// (link) => (chain from the base, joint order index of each of its moving joints).
std::vector<int> find_chain(const RobotModel& robot, const std::string& link, KDL::Chain& chain) {
  robot.tree.getChain(robot.base_link, link, chain);
  std::vector<int> joints;
  for (const KDL::Segment& segment : chain.segments) {
    if (segment.getJoint().getType() != KDL::Joint::Fixed)
      joints.push_back(robot.joint_index.at(segment.getJoint().getName()));
  }
  return joints;
}

void find_chains(RobotModel& robot, files::ConfigReader& reader) {
  for (const Foot foot : {kLeft, kRight}) {
    robot.leg_joints[foot] = find_chain(robot, robot.feet[foot].link, robot.leg_chain[foot]);
    const std::size_t count = robot.leg_joints[foot].size();
    if (count == 0 || count > static_cast<std::size_t>(kMaxLegJoints)) {
      reader.fail("feet", fmt::format("{} hangs on {} joints", robot.feet[foot].link, count),
                  fmt::format("1 to {}", kMaxLegJoints));
    }
  }
  robot.torso_joints = find_chain(robot, robot.torso_link, robot.torso_chain);
}

double standing_height(const RobotModel& robot) {
  const JointVector q = robot.q_stand();
  LegKinematics legs(robot);
  double lowest = std::numeric_limits<double>::infinity();
  for (const FootKinematics& foot : legs.compute(q, JointVector::Zero(q.size()))) {
    for (const Eigen::Vector3d& corner : foot.sole_B) lowest = std::min(lowest, corner.z());
  }
  return -lowest;
}

double mass(const KDL::Tree& tree) {
  double sum = 0.0;
  for (const auto& [name, element] : tree.getSegments()) sum += GetTreeElementSegment(element).getInertia().getMass();
  return sum;
}

template <typename Get>
JointVector collect(const std::vector<Joint>& joints, Get get) {
  JointVector values(static_cast<Eigen::Index>(joints.size()));
  for (std::size_t i = 0; i < joints.size(); ++i) values[static_cast<Eigen::Index>(i)] = get(joints[i]);
  return values;
}

}  // namespace

std::array<Eigen::Vector3d, 4> FootModel::sole_corners_F() const {
  const Eigen::Vector3d& h = box_half_size_m;
  return {box_center_F + Eigen::Vector3d(h.x(), h.y(), -h.z()), box_center_F + Eigen::Vector3d(h.x(), -h.y(), -h.z()),
          box_center_F + Eigen::Vector3d(-h.x(), h.y(), -h.z()),
          box_center_F + Eigen::Vector3d(-h.x(), -h.y(), -h.z())};
}

JointVector RobotModel::q_stand() const {
  return collect(joints, [](const Joint& joint) { return joint.stand_rad; });
}
JointVector RobotModel::q_sit_down() const {
  return collect(joints, [](const Joint& joint) { return joint.sit_down_rad; });
}
JointVector RobotModel::q_lower() const {
  return collect(joints, [](const Joint& joint) { return joint.lower_rad; });
}
JointVector RobotModel::q_upper() const {
  return collect(joints, [](const Joint& joint) { return joint.upper_rad; });
}

RobotModel load_robot(const std::filesystem::path& directory) {
  files::ConfigReader reader = files::ConfigReader::from_file(directory / "robot.yaml");
  RobotModel robot;
  robot.directory = directory;
  robot.name = reader.required<std::string>("name");
  const UrdfTree tree = read_urdf(directory / reader.required<std::string>("urdf"));
  if (reader.has("policy")) reader.required<std::string>("policy");      // read by src/control
  if (reader.has("motor")) reader.required<std::string>("motor");        // read by sim/motors_in_force.hpp
  for (const char* section : {"drives", "buses", "ethercat", "arms"}) {  // read by drives/drive_setup.hpp,
    if (reader.has(section)) reader.map(section);  // ethercat/ethercat_hal.hpp, arms/arm_setup.hpp
  }
  if (reader.has("linkages")) reader.maps("linkages");  // likewise
  robot.urdf = tree.urdf;
  robot.tree = tree.tree;
  robot.base_inertia = tree.root_inertia;

  robot.base_link = link_name(reader, "base_link", tree);
  if (robot.base_link != tree.urdf->getRoot()->name) {
    reader.fail("base_link", "'" + robot.base_link + "' isn't the root", tree.urdf->getRoot()->name);
  }
  robot.torso_link = link_name(reader, "torso_link", tree);
  robot.imu = read_imu(reader.map("imu"), tree);
  files::ConfigReader feet = reader.map("feet");
  robot.feet = {read_foot(feet.map("left"), tree), read_foot(feet.map("right"), tree)};
  feet.finish();
  read_joints(robot, reader.map("joints"), tree);
  files::ConfigReader command = reader.map("command");
  for (std::size_t channel = 0; channel < kChannels; ++channel) {
    read_channel(robot, command.map(kChannelNames[channel]), channel);
  }
  command.finish();
  read_policy_joints(robot, reader);
  reader.finish();

  find_chains(robot, reader);
  robot.mirror = find_mirror(robot, tree);
  robot.total_mass_kg = robot.base_inertia.getMass() + mass(robot.tree);
  robot.standing_height_m = standing_height(robot);
  return robot;
}

RobotModel standing_as(RobotModel robot, const JointVector& q_stand) {
  for (Joint& joint : robot.joints) {
    const double angle_rad = q_stand[robot.joint_index.at(joint.name)];
    if (joint.sit_down_rad == joint.stand_rad) joint.sit_down_rad = angle_rad;
    joint.stand_rad = angle_rad;
  }
  robot.standing_height_m = standing_height(robot);
  return robot;
}

RobotModel load_robot_standing_as(const std::string& robot, const std::filesystem::path& clips) {
  RobotModel loaded = load_robot(find_robot(robot));
  if (!std::filesystem::is_directory(clips)) return loaded;  // what reads the clips says what is wrong with them
  const JointVector q_stand = standing_posture(clips, loaded);
  return standing_as(std::move(loaded), q_stand);
}

}  // namespace pmg::model
