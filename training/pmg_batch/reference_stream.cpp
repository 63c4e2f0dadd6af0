#include "reference_stream.hpp"

#include <cmath>
#include <numbers>

namespace pmg::training {

ReferenceStream::ReferenceStream(const model::RobotModel& robot, const ClipLibrary& library, Variant variant,
                                 std::uint64_t seed)
    : random_command_(robot.command_limits, seed),
      motion_(robot, library, variant, gco::generator_options(robot)),
      base_attitude_(robot),
      standing_height_m_(robot.standing_height_m) {}

std::vector<Field> ReferenceStream::fields(const model::RobotModel& robot) {
  const int joints = robot.joint_index.size();
  const int channels = static_cast<int>(kChannels);
  std::vector<Field> fields = {{"user", 0, channels},     {"command", 0, channels}, {"optimised", 0, channels},
                               {"phase", 0, 3},           {"q_ref", 0, joints},     {"dq_ref", 0, joints},
                               {"contact", 0, 2},         {"contact_weight", 0, 2}, {"base_quat_H", 0, 4},
                               {"base_velocity_H", 0, 3}, {"base_omega_H", 0, 3},   {"base_height", 0, 1}};
  int offset = 0;
  for (Field& field : fields) {
    field.offset = offset;
    offset += field.size;
  }
  return fields;
}

void ReferenceStream::reset() {
  motion_.reset();
  ground_ = {};
}

void ReferenceStream::step(const Command& user, float* row) {
  motion_.advance(user, kTick_s);
  ground_ = motion_.ground();
  write(user, row);
}

void ReferenceStream::write(const Command& user, float* row) {
  const auto put = [&row](double value) { *row++ = static_cast<float>(value); };
  const Reference& r = motion_.reference();
  const Command& observed = ground_.command;
  for (const double u : user.u) put(u);
  for (const double u : r.command.u) put(u);
  for (const double u : observed.u) put(u);
  const double angle = 2.0 * std::numbers::pi * r.phase;
  put(r.gain * std::sin(angle));
  put(r.gain * std::cos(angle));
  put(r.gain);
  for (const double q : r.q) put(q);
  for (const double dq : r.dq) put(dq);
  for (const bool contact : r.contact) put(contact ? 1.0 : 0.0);
  for (const double weight : r.contact_weight) put(weight);
  const model::BaseAttitude::Result base = base_attitude_.compute(r.q, r.dq, r.command[kPitch], r.command[kRoll],
                                                                  r.command_rate[kPitch], r.command_rate[kRoll]);
  const Eigen::Quaterniond q_HB(base.R_HB);
  put(q_HB.w());
  put(q_HB.x());
  put(q_HB.y());
  put(q_HB.z());
  put(observed[kVx]);
  put(observed[kVy]);
  put(ground_.vz_m_s);
  put(base.omega_HB_H.x());
  put(base.omega_HB_H.y());
  put(observed[kOmega]);
  put(standing_height_m_ + observed[kHeight]);
}

}  // namespace pmg::training
