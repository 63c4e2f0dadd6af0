#include "policy/onnx_policy.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <vector>

#include "files/config_error.hpp"
#include "policy/golden_pairs.hpp"
#include "policy/observation.hpp"
#include "policy/onnx_network.hpp"

namespace pmg::policy {

namespace {

constexpr const char* kInput = "observation";
constexpr const char* kOutput = "action";
constexpr const char* kMetadataKey = "pmg_policy";

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

std::string metadata_text(const OnnxNetwork& network) {
  const std::optional<std::string> text = network.metadata(kMetadataKey);
  if (!text) {
    refuse(
        fmt::format("it has no metadata {}; expected a policy exported by training, or a descriptor beside a policy "
                    "of another project (scripts/import-policy)",
                    kMetadataKey));
  }
  return *text;
}

}  // namespace

struct OnnxPolicy::Impl {
  Impl(const std::filesystem::path& file, const model::RobotModel& robot, const std::string& clip_library_sha256,
       double control_rate_Hz)
      : network(file),
        metadata(parse_policy_metadata(metadata_text(network), robot, clip_library_sha256, control_rate_Hz)),
        observation(robot) {
    const auto& layout = observation.layout();
    for (const std::string& name : layout.action_joints()) action_joints.push_back(robot.joint_index.at(name));
    const auto actions = static_cast<Eigen::Index>(action_joints.size());
    action.setZero(actions);
    network.bind({kInput, layout.size()}, {kOutput, actions});
    replay_golden_pairs(network, metadata.golden, metadata.golden_tolerance);
  }

  OnnxNetwork network;
  PolicyMetadata metadata;
  Observation observation;
  Eigen::VectorXf action;  // the network's last output; an input of the next tick
  std::vector<int> action_joints;
};

OnnxPolicy::OnnxPolicy(const std::filesystem::path& file, const model::RobotModel& robot,
                       const std::string& clip_library_sha256, double control_rate_Hz) {
  try {
    impl_ = std::make_unique<Impl>(file, robot, clip_library_sha256, control_rate_Hz);
  } catch (const files::ConfigError& error) {  // it names the file
    throw std::invalid_argument(error.what());
  } catch (const std::exception& error) {
    throw std::invalid_argument(fmt::format("{}: {}", file.string(), error.what()));
  }
}

OnnxPolicy::~OnnxPolicy() = default;

const PolicyMetadata& OnnxPolicy::metadata() const { return impl_->metadata; }

Variant OnnxPolicy::variant() const { return impl_->metadata.variant; }

std::optional<DriveGains> OnnxPolicy::gains() const { return impl_->metadata.gains; }

std::optional<double> OnnxPolicy::action_bound_rad() const {
  constexpr double kSaturated = 0.95;  // a network at its clamp has left the motion that it was trained on
  return kSaturated * impl_->metadata.action_limit * impl_->metadata.action_scale;
}

void OnnxPolicy::reset() noexcept {
  impl_->observation.reset();
  impl_->action.setZero();
}

void OnnxPolicy::unsent() noexcept { impl_->action.setZero(); }

Status OnnxPolicy::act(const model::RobotState& state, const Reference& reference, const Command& observed,
                       JointVector& q_des) noexcept {
  Impl& impl = *impl_;
  impl.network.input() = impl.observation.assemble(state, reference, observed, impl.action);
  if (!impl.network.run()) return Status::kNotFinite;
  impl.action = impl.network.output();
  q_des = reference.q;
  for (std::size_t i = 0; i < impl.action_joints.size(); ++i) {
    q_des[impl.action_joints[i]] +=
        impl.metadata.action_scale * static_cast<double>(impl.action[static_cast<Eigen::Index>(i)]);
  }
  return Status::kOk;
}

}  // namespace pmg::policy
