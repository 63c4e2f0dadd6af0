#include "policy/signal_history.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pmg::policy {

namespace {

/// The IMU's frame in the base's; the joints between are fixed.
Eigen::Matrix3d imu_in_base(const model::RobotModel& robot) {
  Eigen::Matrix3d R = robot.imu.T_LI.linear();
  for (urdf::LinkConstSharedPtr link = robot.urdf->getLink(robot.imu.link); link->getParent();
       link = link->getParent()) {
    const urdf::Rotation& r = link->parent_joint->parent_to_joint_origin_transform.rotation;
    R = Eigen::Quaterniond(r.w, r.x, r.y, r.z).toRotationMatrix() * R;
  }
  return R;
}

}  // namespace

SignalHistory::SignalHistory(const PolicyDescriptor& descriptor, const model::RobotModel& robot)
    : joints_(descriptor.joints),
      default_rad_(descriptor.default_rad),
      R_BI_(imu_in_base(robot)),
      oldest_first_(descriptor.order.oldest_first),
      period_s_(1.0 / descriptor.rate_Hz) {
  int frame_size = 0, largest = 0;
  for (const SignalTerm& term : descriptor.observation) frame_size += term.size;
  int offset = 0;
  for (const SignalTerm& term : descriptor.observation) {
    const bool by_term = descriptor.order.by_term;
    tracks_.push_back({.term = term,
                       .ring = Eigen::MatrixXf::Zero(term.size, term.history),
                       .offset = offset,
                       .stride = by_term ? term.size : frame_size});
    offset += by_term ? term.size * term.history : term.size;
    largest = std::max(largest, term.size);
  }
  measured_.setZero(largest);
  vector_.setZero(descriptor.observation_size);
}

double SignalHistory::phase_cycle(const StepClock& clock, double offset_cycle) const noexcept {
  if (clock.at_rest_cycle && moving_frames_ == 0) return *clock.at_rest_cycle;
  const std::int64_t frames = clock.at_rest_cycle ? moving_frames_ - 1 : frames_;
  return static_cast<double>(frames) * period_s_ / clock.period_s + offset_cycle;
}

const Eigen::VectorXd& SignalHistory::measured(const SignalTerm& term, const model::RobotState& state,
                                               const Command& command, const Eigen::VectorXf& last_action) noexcept {
  switch (term.signal) {
    case Signal::kGyro:
      measured_.head<3>() = R_BI_ * state.gyro_rad_s;
      break;
    case Signal::kGravityDirection:
      measured_.head<3>() = R_BI_ * (state.orientation_WI.conjugate() * Eigen::Vector3d(0.0, 0.0, -1.0));
      break;
    case Signal::kCommand:
      for (std::size_t i = 0; i < kVelocityChannels; ++i) measured_[static_cast<Eigen::Index>(i)] = command.u[i];
      break;
    case Signal::kJointPosition:
      for (std::size_t i = 0; i < joints_.size(); ++i)
        measured_[static_cast<Eigen::Index>(i)] = state.q[joints_[i]] - default_rad_[i];
      break;
    case Signal::kJointVelocity:
      for (std::size_t i = 0; i < joints_.size(); ++i) measured_[static_cast<Eigen::Index>(i)] = state.dq[joints_[i]];
      break;
    case Signal::kLastAction:
      measured_.head(last_action.size()) = last_action.cast<double>();
      break;
    case Signal::kCommandLinear:
      measured_.head<2>() << command[kVx], command[kVy];
      break;
    case Signal::kCommandAngular:
      measured_[0] = command[kOmega];
      break;
    case Signal::kClockSin:
    case Signal::kClockCos:
      for (std::size_t i = 0; i < term.clock.offsets_cycle.size(); ++i) {
        const double angle = 2.0 * std::numbers::pi * phase_cycle(term.clock, term.clock.offsets_cycle[i]);
        measured_[static_cast<Eigen::Index>(i)] = term.signal == Signal::kClockSin ? std::sin(angle) : std::cos(angle);
      }
      break;
  }
  return measured_;
}

const Eigen::VectorXf& SignalHistory::assemble(const model::RobotState& state, const Command& command,
                                               const Eigen::VectorXf& last_action) noexcept {
  constexpr double kMoves = 0.01;  // [m/s, rad/s]: below it nobody asks for a step
  const bool moves = std::hypot(command[kVx], command[kVy]) >= kMoves || std::abs(command[kOmega]) >= kMoves;
  moving_frames_ = moves ? moving_frames_ + 1 : 0;
  for (Track& track : tracks_) {
    const SignalTerm& term = track.term;
    const Eigen::VectorXd& now = measured(term, state, command, last_action);
    const auto newest = static_cast<int>(frames_ % term.history);
    for (int i = 0; i < term.size; ++i) {
      const double value = term.scale[static_cast<std::size_t>(i)] * std::clamp(now[i], -term.clip, term.clip);
      track.ring(i, newest) = static_cast<float>(value);
      if (frames_ == 0) track.ring.row(i).setConstant(track.ring(i, newest));
    }
    for (int age = 0; age < term.history; ++age) {
      const int place = oldest_first_ ? term.history - 1 - age : age;
      vector_.segment(track.offset + place * track.stride, term.size) =
          track.ring.col((newest + term.history - age) % term.history);
    }
  }
  ++frames_;
  return vector_;
}

}  // namespace pmg::policy
