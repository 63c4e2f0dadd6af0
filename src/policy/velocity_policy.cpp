#include "policy/velocity_policy.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "files/config_error.hpp"
#include "policy/onnx_network.hpp"
#include "policy/signal_history.hpp"

namespace pmg::policy {

struct VelocityPolicy::Impl {
  Impl(const PolicyDescriptor& told, const model::RobotModel& robot, double control_rate_Hz)
      : descriptor(told),
        network(told.network),
        history(told, robot),
        stand_rad(robot.q_stand()),
        ticks_an_inference(static_cast<int>(std::lround(control_rate_Hz / told.rate_Hz))) {
    const auto actions = static_cast<Eigen::Index>(told.joints.size());
    network.bind({told.input, told.observation_size}, {told.output, actions});
    replay_golden_pairs(network, told.golden, told.golden_tolerance);
    for (std::size_t i = 0; i < told.joints.size(); ++i) stand_rad[told.joints[i]] = told.default_rad[i];
    action.setZero(actions);
    no_action.setZero(actions);
    target = stand_rad;
  }

  PolicyDescriptor descriptor;
  OnnxNetwork network;
  SignalHistory history;
  JointVector stand_rad;
  int ticks_an_inference, ticks_until_inference = 0;
  Eigen::VectorXf action, no_action;
  bool sent = false;  // the last action
  JointVector target;
};

VelocityPolicy::VelocityPolicy(const std::filesystem::path& descriptor, const model::RobotModel& robot,
                               double control_rate_Hz) {
  try {
    const PolicyDescriptor told = read_policy_descriptor(descriptor, robot, control_rate_Hz);
    try {
      impl_ = std::make_unique<Impl>(told, robot, control_rate_Hz);
    } catch (const files::ConfigError&) {
      throw;
    } catch (const std::exception& error) {
      throw std::invalid_argument(fmt::format("{}: {}", told.network.string(), error.what()));
    }
  } catch (const files::ConfigError& error) {  // it names the file
    throw std::invalid_argument(error.what());
  }
}

VelocityPolicy::~VelocityPolicy() = default;

const PolicyDescriptor& VelocityPolicy::descriptor() const { return impl_->descriptor; }

std::optional<DriveGains> VelocityPolicy::gains() const { return impl_->descriptor.gains; }

std::optional<double> VelocityPolicy::action_bound_rad() const { return impl_->descriptor.action_bound_rad; }

const JointVector& VelocityPolicy::stand_rad() const { return impl_->stand_rad; }

void VelocityPolicy::reset() noexcept {
  impl_->history.reset();
  impl_->sent = false;
  impl_->ticks_until_inference = 0;
}

void VelocityPolicy::unsent() noexcept { impl_->sent = false; }

Status VelocityPolicy::act(const model::RobotState& state, const Reference& reference, const Command& observed,
                           JointVector& q_des) noexcept {
  Impl& impl = *impl_;
  if (impl.ticks_until_inference == 0) {
    impl.ticks_until_inference = impl.ticks_an_inference;
    impl.network.input() = impl.history.assemble(state, observed, impl.sent ? impl.action : impl.no_action);
    if (!impl.network.run()) return Status::kNotFinite;
    impl.action = impl.network.output();
    if (impl.descriptor.action_limit) {
      const auto limit = static_cast<float>(*impl.descriptor.action_limit);
      impl.action = impl.action.cwiseMax(-limit).cwiseMin(limit);
    }
    for (std::size_t i = 0; i < impl.descriptor.joints.size(); ++i) {
      impl.target[impl.descriptor.joints[i]] =
          impl.descriptor.default_rad[i] +
          impl.descriptor.action_scale_rad[i] * static_cast<double>(impl.action[static_cast<Eigen::Index>(i)]);
    }
  }
  --impl.ticks_until_inference;
  impl.sent = true;
  q_des = reference.q;
  for (const int joint : impl.descriptor.joints) q_des[joint] = impl.target[joint];
  return Status::kOk;
}

}  // namespace pmg::policy
