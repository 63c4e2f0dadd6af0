#include "sim/world.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <mutex>
#include <stdexcept>

#include "sim/actuator_joint.hpp"
#include "sim/box_contacts.hpp"
#include "sim/motors_in_force.hpp"
#include "sim/mujoco_objects.hpp"
#include "sim/sensor_noise.hpp"
#include "sim/set_values.hpp"
#include "sim/suspension.hpp"

namespace pmg::sim {

namespace {

constexpr double kGantryLift_m = 0.2;            // of a world that starts hanging
constexpr double kClampInertia = 1e12;           // [kg, kg m^2] 100 Nm turn it by 0.05 mrad in 1000 s
constexpr double kRopeLength_m = 4.0;            // in pictures
constexpr double kDriveTemperature_degC = 35.0;  // drives have no thermal model

/// MuJoCo's own handlers write MUJOCO_LOG.TXT into the working directory and wait for a key. mjData counts the
/// warnings.
void silence_warnings(const char*) {}

/// mju_error doesn't expect its handler to return. A step that ends this way leaves a state that only a reset repairs.
[[noreturn]] void throw_error(const char* message) { throw std::runtime_error(std::string("MuJoCo: ") + message); }

/// One robot at a time: MuJoCo's XML reader and its handlers of errors are global.
ModelPointer compile(const std::string& xml) {
  static std::mutex reader;
  const std::scoped_lock lock(reader);
  mju_user_warning = silence_warnings;
  mju_user_error = throw_error;
  drop_phantom_contacts();
  constexpr const char* kName = "robot.xml";
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), kName, static_cast<int>(xml.size()));
  // NOLINTNEXTLINE(bugprone-not-null-terminated-result): a file has its size
  std::memcpy(files->filedata[mj_findFileVFS(files.get(), kName)], xml.data(), xml.size());
  std::array<char, 1000> error{};
  ModelPointer model(mj_loadXML(kName, files.get(), error.data(), static_cast<int>(error.size())));
  mj_deleteVFS(files.get());
  if (!model) throw std::runtime_error(std::string("MuJoCo refuses the robot: ") + error.data());
  return model;
}

int find(const mjModel* model, mjtObj type, const std::string& name) {
  const int id = mj_name2id(model, type, name.c_str());
  if (id < 0) throw std::runtime_error("no such object in the MuJoCo model: " + name);
  return id;
}

model::JointCommand limp(int joints) {
  const JointVector zero = JointVector::Zero(joints);
  return {.q = zero, .dq = zero, .kp = zero, .kd = zero, .tau_ff = zero};
}

Eigen::Quaterniond quaternion(const mjtNum* q) { return {q[0], q[1], q[2], q[3]}; }

}  // namespace

struct World::Impl {
  Impl(const model::RobotModel& robot, const WorldOptions& world_options)
      : options(world_options),
        model(compile(mjcf(robot, world_options))),
        data(mj_makeData(model.get())),
        suspension(robot.total_mass_kg, robot.standing_height_m),
        noise(world_options, robot.joint_index.size()),
        underway(1 +
                 static_cast<std::size_t>(std::lround(world_options.variation.delay_s / world_options.timestep_s))) {
    make_motors(robot);
    apply(options.variation, robot, model.get(), data.get());
    for (const auto& joint : robot.joints) {
      const int id = find(model.get(), mjOBJ_JOINT, joint.name);
      qpos_address.push_back(model->jnt_qposadr[id]);
      dof_address.push_back(model->jnt_dofadr[id]);
    }
    base_body = find(model.get(), mjOBJ_BODY, robot.base_link);
    if (!options.benched_joint.empty()) clamp_all_but(options.benched_joint);
    torso_body = find(model.get(), mjOBJ_BODY, robot.torso_link);
    for (const Foot foot : {kLeft, kRight}) {
      foot_body[foot] = find(model.get(), mjOBJ_BODY, robot.feet[foot].link);
      sole_geom[foot] = find(model.get(), mjOBJ_GEOM, robot.feet[foot].link + "_sole");
    }
    gyro_address = model->sensor_adr[find(model.get(), mjOBJ_SENSOR, "imu_gyro")];
    accelerometer_address = model->sensor_adr[find(model.get(), mjOBJ_SENSOR, "imu_accelerometer")];
    orientation_address = model->sensor_adr[find(model.get(), mjOBJ_SENSOR, "imu_orientation")];
  }

  /// The MJCF's actuators are position servos with MuJoCo's friction; here they become actuator models.
  void make_motors(const model::RobotModel& robot) {
    expect_joints(options.variation, robot);
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      const model::ActuatorParameters actuator = actuator_in_force(robot.joints[j], options.motors);
      motors.emplace_back(varied(actuator, options.variation, static_cast<Eigen::Index>(j)), options.timestep_s);
      hand_over(model.get(), static_cast<int>(j), motors.back());
    }
  }

  /// Clamps by a huge rotor inertia: a rotor has no weight and adds no mass to the links above. The clamp works at any
  /// step and has no spring that could ring.
  void clamp_all_but(const std::string& joint) {
    const int free_dof = model->jnt_dofadr[find(model.get(), mjOBJ_JOINT, joint)];
    for (int dof = 0; dof < model->nv; ++dof) {
      if (dof != free_dof) model->dof_armature[dof] = kClampInertia;
    }
  }

  WorldOptions options;
  ModelPointer model;
  DataPointer data;
  Suspension suspension;
  SensorNoise noise;
  std::vector<model::JointCommand> underway;  // to the drives: a ring as long as the delay, the newest included
  std::size_t newest_command = 0;
  std::vector<ActuatorModel> motors;  // in joint order
  Eigen::Vector3d push_W_N = Eigen::Vector3d::Zero();
  std::vector<int> qpos_address, dof_address;  // in joint order, which is the actuators' order
  int base_body = 0, torso_body = 0;
  std::array<int, 2> foot_body{}, sole_geom{};
  int gyro_address = 0, accelerometer_address = 0, orientation_address = 0;
  std::array<double, 2> foot_force_N{}, foot_slip_m_s{};
  std::uint64_t steps = 0;
  bool diverged = false;
};

World::World(const model::RobotModel& robot, const WorldOptions& options)
    : robot_(robot), set_values_(sim::set_values(robot, options)), impl_(std::make_unique<Impl>(robot, options)) {
  model_ = impl_->model.get();
  data_ = impl_->data.get();
  reset();
}

World::~World() = default;

void World::reset() {
  Impl& w = *impl_;
  mj_resetDataKeyframe(model_, data_, find(model_, mjOBJ_KEY, "stand"));
  mju_zero(data_->ctrl, model_->nu);
  mju_zero(model_->actuator_biasprm, mjNBIAS * model_->nu);  // no drive acts before the first command
  mj_forward(model_, data_);
  w.suspension = Suspension(robot_.total_mass_kg, robot_.standing_height_m);
  w.suspension.set_ground_place(Eigen::Map<const Eigen::Vector3d>(data_->xipos + 3 * w.torso_body), 0.0);
  if (w.options.gantry) {
    w.suspension.set(kGantryLift_m, 1.0);
    data_->qpos[2] += kGantryLift_m - Suspension::kSag_m;
    mj_forward(model_, data_);
  }
  w.noise = SensorNoise(w.options, robot_.joint_index.size());
  std::ranges::fill(w.underway, limp(robot_.joint_index.size()));
  for (std::size_t j = 0; j < w.motors.size(); ++j) w.motors[j].reset(data_->qpos[w.qpos_address[j]]);
  w.push_W_N.setZero();
  w.foot_force_N = w.foot_slip_m_s = {};
  w.steps = 0;
  w.diverged = false;
}

// mj_step in two halves. After the step, positions, velocities and their sensors all belong to the new state; mj_step
// leaves them one step behind. Forces, and therefore the accelerometer, belong to the step just done.
void World::step(const model::JointCommand& command) noexcept {
  Impl& w = *impl_;
  if (w.diverged) return;
  w.newest_command = (w.newest_command + 1) % w.underway.size();
  w.underway[w.newest_command] = command;
  set_drives(w.underway[(w.newest_command + 1) % w.underway.size()]);
  mjtNum* torso_wrench = data_->xfrc_applied + 6 * w.torso_body;
  mju_zero(torso_wrench, 6);
  Eigen::Map<Eigen::Vector3d>(torso_wrench) += w.push_W_N;
  w.suspension.apply(model_, data_, w.torso_body);
  try {
    mj_step2(model_, data_);
    measure_feet();
    mj_step1(model_, data_);
  } catch (const std::runtime_error&) {  // from throw_error: the implicit integrator can't factor its matrix
    w.diverged = true;
    return;
  }
  w.noise.draw();
  ++w.steps;
  check_divergence();
}

void World::set_drives(const model::JointCommand& command) noexcept {
  Impl& w = *impl_;
  for (int j = 0; j < model_->nu; ++j) {
    const auto index = static_cast<std::size_t>(j);
    const int dof = w.dof_address[index];
    const double q_rad = data_->qpos[w.qpos_address[index]], dq_rad_s = data_->qvel[dof];
    const ActuatorInput input{.q_rad = command.q[j],
                              .dq_rad_s = command.dq[j],
                              .kp = command.kp[j],
                              .kd = command.kd[j],
                              .feed_forward_Nm = command.tau_ff[j],
                              .temperature_C = kDriveTemperature_degC,
                              .external_Nm = data_->qfrc_constraint[dof] - data_->qfrc_bias[dof]};
    apply(model_, data_, j, w.motors[index].step(input, q_rad, dq_rad_s), dq_rad_s);
  }
}

// Runs between the two halves of a step, where contacts match their forces.
void World::measure_feet() noexcept {
  Impl& w = *impl_;
  for (std::size_t foot = 0; foot < 2; ++foot) {
    Eigen::Vector3d weighted_point = Eigen::Vector3d::Zero();
    double force_N = 0.0;
    for (int c = 0; c < data_->ncon; ++c) {
      const mjContact& contact = data_->contact[c];
      if (contact.geom1 != w.sole_geom[foot] && contact.geom2 != w.sole_geom[foot]) continue;
      mjtNum wrench[6];
      mj_contactForce(model_, data_, c, wrench);
      force_N += wrench[0];
      weighted_point += wrench[0] * Eigen::Map<const Eigen::Vector3d>(contact.pos);
    }
    w.foot_force_N[foot] = force_N;
    w.foot_slip_m_s[foot] = 0.0;
    if (force_N <= 0.0) continue;
    mjtNum velocity[6];
    mj_objectVelocity(model_, data_, mjOBJ_XBODY, w.foot_body[foot], velocity, 0);
    const Eigen::Map<const Eigen::Vector3d> omega(velocity), v(velocity + 3);
    const Eigen::Vector3d lever =
        weighted_point / force_N - Eigen::Map<const Eigen::Vector3d>(data_->xpos + 3 * w.foot_body[foot]);
    w.foot_slip_m_s[foot] = (v + omega.cross(lever)).head<2>().norm();
  }
}

// MuJoCo resets a bad state and goes on; only the counted warning shows it.
void World::check_divergence() noexcept {
  for (const mjWarningStat& warning : data_->warning)
    if (warning.number > 0) impl_->diverged = true;
}

void World::read(model::RobotState& state) noexcept {
  const Impl& w = *impl_;
  const int joints = model_->nu;
  state.stamp_ns = std::llround(static_cast<double>(w.steps) * w.options.timestep_s * 1e9);
  state.bus_sample = w.steps;
  state.q.resize(joints);
  state.dq.resize(joints);
  state.tau.resize(joints);
  state.temperature_degC.setConstant(joints, kDriveTemperature_degC);
  for (int j = 0; j < joints; ++j) {
    const auto index = static_cast<std::size_t>(j);
    state.tau[j] = w.motors[index].drive_torque_Nm();
    state.q[j] = w.motors[index].reading_rad(data_->qpos[w.qpos_address[index]]) + w.noise.encoder_rad()[j];
    state.dq[j] = data_->qvel[w.dof_address[index]] + w.noise.velocity_rad_s()[j];
  }
  state.gyro_rad_s = Eigen::Map<const Eigen::Vector3d>(data_->sensordata + w.gyro_address) + w.noise.gyro_rad_s();
  state.acceleration_m_s2 = Eigen::Map<const Eigen::Vector3d>(data_->sensordata + w.accelerometer_address);
  state.orientation_WI = quaternion(data_->sensordata + w.orientation_address) * w.noise.orientation();
}

model::GroundTruth World::truth() const noexcept {
  const Impl& w = *impl_;
  model::GroundTruth truth;
  truth.p_WB = Eigen::Map<const Eigen::Vector3d>(data_->xpos + 3 * w.base_body);
  truth.q_WB = quaternion(data_->xquat + 4 * w.base_body);
  truth.v_WB_W = Eigen::Map<const Eigen::Vector3d>(data_->qvel);
  truth.omega_WB_B = Eigen::Map<const Eigen::Vector3d>(data_->qvel + 3);
  truth.q_WT = quaternion(data_->xquat + 4 * w.torso_body);
  truth.foot_force_N = w.foot_force_N;
  truth.foot_slip_m_s = w.foot_slip_m_s;
  return truth;
}

Eigen::Isometry3d World::pose(const std::string& name) const {
  const int body = find(model_, mjOBJ_BODY, name);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Map<const Eigen::Vector3d>(data_->xpos + 3 * body);
  T.linear() = quaternion(data_->xquat + 4 * body).toRotationMatrix();
  return T;
}

bool World::touches(const std::string& one, const std::string& other) const {
  const int a = find(model_, mjOBJ_BODY, one), b = find(model_, mjOBJ_BODY, other);
  return std::any_of(data_->contact, data_->contact + data_->ncon, [&](const mjContact& contact) {
    const int first = model_->geom_bodyid[contact.geom1], second = model_->geom_bodyid[contact.geom2];
    return contact.exclude == 0 && ((first == a && second == b) || (first == b && second == a));
  });
}

bool World::diverged() const noexcept { return impl_->diverged; }

double World::time_s() const noexcept { return static_cast<double>(impl_->steps) * impl_->options.timestep_s; }

void World::set_hoist(double lift_m, double engaged) noexcept { impl_->suspension.set(lift_m, engaged); }

double World::torso_height_m() const noexcept {
  return data_->xipos[3 * impl_->torso_body + 2] - impl_->suspension.ground_height_m();
}

const std::array<double, 2>& World::foot_force_N() const noexcept { return impl_->foot_force_N; }

std::optional<Rope> World::gantry_rope() const {
  if (!impl_->suspension.engaged()) return std::nullopt;
  Rope rope;
  rope.bottom_W = Eigen::Map<const Eigen::Vector3d>(data_->xipos + 3 * impl_->torso_body);
  rope.top_W = impl_->suspension.anchor_W() + kRopeLength_m * Eigen::Vector3d::UnitZ();
  return rope;
}

void World::set_push(const Eigen::Vector3d& force_W_N) noexcept { impl_->push_W_N = force_W_N; }

}  // namespace pmg::sim
