#include "policy/onnx_policy.hpp"

#include <fmt/format.h>
#include <onnxruntime_cxx_api.h>

#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>
#include <vector>

#include "files/bounded_file.hpp"
#include "files/config_error.hpp"
#include "policy/observation.hpp"

namespace pmg::policy {

namespace {

constexpr const char* kInput = "observation";
constexpr const char* kOutput = "action";
constexpr const char* kMetadataKey = "pmg_policy";
constexpr std::size_t kLargestMetadata_bytes = 4 << 20;  // ours has 0.1 MiB

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

/// One thread, because ONNX Runtime's pool keeps a core spinning beside the real-time threads. Without memory arena and
/// memory patterns an inference takes no lock and costs the same time. 35 small heap allocations remain, the same in
/// every inference.
Ort::SessionOptions session_options() {
  Ort::SessionOptions options;
  options.SetIntraOpNumThreads(1);
  options.SetInterOpNumThreads(1);
  options.SetExecutionMode(ExecutionMode::ORT_SEQUENTIAL);
  options.SetGraphOptimizationLevel(GraphOptimizationLevel::ORT_ENABLE_ALL);
  options.DisableCpuMemArena();
  options.DisableMemPattern();
  return options;
}

std::string metadata_text(const Ort::Session& session) {
  const Ort::AllocatorWithDefaultOptions allocator;
  const Ort::AllocatedStringPtr text =
      session.GetModelMetadata().LookupCustomMetadataMapAllocated(kMetadataKey, allocator);
  if (!text) refuse(fmt::format("it has no metadata {}; expected a policy exported by training", kMetadataKey));
  if (const std::size_t bytes = std::strlen(text.get()); bytes > kLargestMetadata_bytes) {
    refuse(
        fmt::format("its metadata {} has {} bytes; expected {} at most", kMetadataKey, bytes, kLargestMetadata_bytes));
  }
  return text.get();
}

void expect_tensor(const char* name, const std::string& found_name, const Ort::TypeInfo& type, std::int64_t size) {
  if (found_name != name) refuse(fmt::format("the network's {} is called {}", name, found_name));
  const auto tensor = type.GetTensorTypeAndShapeInfo();
  const std::vector<std::int64_t> expected = {1, size};
  if (tensor.GetElementType() != ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT || tensor.GetShape() != expected) {
    refuse(fmt::format("the network's {} has shape [{}]; expected single-precision [1, {}]", name,
                       fmt::join(tensor.GetShape(), ", "), size));
  }
}

}  // namespace

struct OnnxPolicy::Impl {
  Impl(const std::filesystem::path& file, const model::RobotModel& robot, const std::string& clip_library_sha256,
       double control_rate_Hz)
      : session(environment, file.c_str(), session_options()),
        metadata(parse_policy_metadata(metadata_text(session), robot, clip_library_sha256, control_rate_Hz)),
        observation(robot),
        binding(session) {
    const auto& layout = observation.layout();
    input.resize(static_cast<std::size_t>(layout.size()));
    action.setZero(static_cast<Eigen::Index>(layout.action_joints().size()));
    for (const std::string& name : layout.action_joints()) action_joints.push_back(robot.joint_index.at(name));
    expect_shapes();
    bind();
    replay_golden_pairs();
  }

  void expect_shapes() const {
    if (session.GetInputCount() != 1 || session.GetOutputCount() != 1) {
      refuse(fmt::format("the network has {} inputs and {} outputs; expected one of each", session.GetInputCount(),
                         session.GetOutputCount()));
    }
    const Ort::AllocatorWithDefaultOptions allocator;
    expect_tensor(kInput, session.GetInputNameAllocated(0, allocator).get(), session.GetInputTypeInfo(0),
                  static_cast<std::int64_t>(input.size()));
    expect_tensor(kOutput, session.GetOutputNameAllocated(0, allocator).get(), session.GetOutputTypeInfo(0),
                  action.size());
  }

  void bind() {
    const auto memory = Ort::MemoryInfo::CreateCpu(OrtArenaAllocator, OrtMemTypeDefault);
    const std::array<std::int64_t, 2> input_shape = {1, static_cast<std::int64_t>(input.size())};
    const std::array<std::int64_t, 2> output_shape = {1, action.size()};
    input_tensor = Ort::Value::CreateTensor<float>(memory, input.data(), input.size(), input_shape.data(), 2);
    output_tensor = Ort::Value::CreateTensor<float>(memory, action.data(), static_cast<std::size_t>(action.size()),
                                                    output_shape.data(), 2);
    binding.BindInput(kInput, input_tensor);
    binding.BindOutput(kOutput, output_tensor);
  }

  void replay_golden_pairs() {
    for (std::size_t k = 0; k < metadata.golden.size(); ++k) {
      const GoldenPair& pair = metadata.golden[k];
      input = pair.observation;  // same size: the bound buffer keeps its address
      session.Run(run_options, binding);
      for (std::size_t i = 0; i < pair.action.size(); ++i) {
        const float computed = action[static_cast<Eigen::Index>(i)];
        if (!(std::abs(static_cast<double>(computed - pair.action[i])) <= metadata.golden_tolerance)) {
          refuse(fmt::format("golden pair {}, action {}: the network gives {}, training had {} (tolerance {})", k, i,
                             computed, pair.action[i], metadata.golden_tolerance));
        }
      }
    }
    action.setZero();
  }

  Ort::Env environment{ORT_LOGGING_LEVEL_ERROR, "pmg"};
  Ort::Session session;
  PolicyMetadata metadata;
  Observation observation;
  std::vector<float> input;
  Eigen::VectorXf action;  // the network's output; also an input of the next tick
  std::vector<int> action_joints;
  Ort::Value input_tensor{nullptr}, output_tensor{nullptr};
  Ort::IoBinding binding;
  Ort::RunOptions run_options;
};

OnnxPolicy::OnnxPolicy(const std::filesystem::path& file, const model::RobotModel& robot,
                       const std::string& clip_library_sha256, double control_rate_Hz) {
  try {
    files::expect_bounded_file(file, files::kLargestPolicy_bytes, "an ONNX policy");
  } catch (const files::ConfigError& error) {  // it names the file
    throw std::invalid_argument(error.what());
  }
  try {
    impl_ = std::make_unique<Impl>(file, robot, clip_library_sha256, control_rate_Hz);
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

Status OnnxPolicy::act(const model::RobotState& state, const Reference& reference, const Command& observed,
                       JointVector& q_des) noexcept {
  Impl& impl = *impl_;
  const Eigen::VectorXf& seen = impl.observation.assemble(state, reference, observed, impl.action);
  if (!seen.allFinite()) return Status::kNotFinite;
  std::copy_n(seen.data(), seen.size(), impl.input.data());
  try {
    impl.session.Run(impl.run_options, impl.binding);
  } catch (const Ort::Exception&) {
    return Status::kNotFinite;
  }
  if (!impl.action.allFinite()) return Status::kNotFinite;
  q_des = reference.q;
  for (std::size_t i = 0; i < impl.action_joints.size(); ++i) {
    q_des[impl.action_joints[i]] +=
        impl.metadata.action_scale * static_cast<double>(impl.action[static_cast<Eigen::Index>(i)]);
  }
  return Status::kOk;
}

}  // namespace pmg::policy
