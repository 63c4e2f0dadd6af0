#include "reference_stream.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace pmg::training {

namespace {

GeneratorOptions generator_options(const model::RobotModel& robot) {
  GeneratorOptions options;
  options.limits = robot.command_limits;
  options.scale_positive = robot.velocity_scale_positive;
  options.scale_negative = robot.velocity_scale_negative;
  return options;
}

/// The forward clip alone: every other direction and every posture is missing.
ClipLibrary forward_clip_only(ClipLibrary library) {
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    if (channel != kVx) library.positive[channel].reset();
    library.negative[channel].reset();
  }
  return library;
}

}  // namespace

Variant variant_of(const std::string& name) {
  if (name == "pmg") return Variant::kPmg;
  if (name == "without_gco") return Variant::kWithoutGco;
  if (name == "single_gait") return Variant::kSingleGait;
  throw std::invalid_argument("variant " + name + "; expected pmg, without_gco or single_gait");
}

ReferenceStream::ReferenceStream(const model::RobotModel& robot, const ClipLibrary& library, Variant variant,
                                 std::uint64_t seed)
    : variant_(variant),
      options_(generator_options(robot)),
      random_command_(options_.limits, seed),
      generator_(library, options_),
      gco_(robot),
      base_attitude_(robot),
      standing_height_m_(robot.standing_height_m) {
  if (variant == Variant::kSingleGait) forward_only_.emplace(forward_clip_only(library), options_);
  reset();
}

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
  generator_.reset();
  if (forward_only_) forward_only_->reset();
  gco_.reset();
  reference_ = generator_.reference();
  optimised_ = Command{};
}

void ReferenceStream::step(const Command& user, float* row) {
  reference_ = generator_.step(user, kTick_s);
  if (forward_only_) single_gait(reference_);
  optimised_ = reference_.command;
  vz_m_s_ = 0.0;
  if (variant_ == Variant::kPmg) {
    const gco::Result& result = gco_.solve(reference_);
    optimised_ = result.command;
    vz_m_s_ = result.vz_m_s;
  }
  write(user, row);
}

/// The command stays the user's, admissible and rate-limited; gait, joints and contacts are the forward clip's.
void ReferenceStream::single_gait(const Reference& wanted) {
  const Command command = wanted.command, rate = wanted.command_rate;
  Command forward;
  forward[kVx] = wanted.gain * options_.scale_positive[kVx];
  reference_ = forward_only_->step(forward, kTick_s);
  reference_.command = command;
  reference_.command_rate = rate;
}

void ReferenceStream::write(const Command& user, float* row) {
  const auto put = [&row](double value) { *row++ = static_cast<float>(value); };
  const Reference& r = reference_;
  for (const double u : user.u) put(u);
  for (const double u : r.command.u) put(u);
  for (const double u : optimised_.u) put(u);
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
  put(optimised_[kVx]);
  put(optimised_[kVy]);
  put(vz_m_s_);
  put(base.omega_HB_H.x());
  put(base.omega_HB_H.y());
  put(optimised_[kOmega]);
  put(standing_height_m_ + optimised_[kHeight]);
}

}  // namespace pmg::training
