#include "policy/onnx_network.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <onnxruntime_cxx_api.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "files/bounded_file.hpp"

namespace pmg::policy {

namespace {

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

/// name_at(i, allocator): of input or output i.
template <typename NameAt>
std::vector<std::string> names(std::size_t count, const NameAt& name_at) {
  const Ort::AllocatorWithDefaultOptions allocator;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) names.emplace_back(name_at(i, allocator).get());
  return names;
}

void expect_tensor(const char* role, const std::string& found_name, const Ort::TypeInfo& type,
                   const TensorExpected& expected) {
  if (!expected.name.empty() && found_name != expected.name) {
    refuse(fmt::format("the network's {} is called {}; expected {}", role, found_name, expected.name));
  }
  if (type.GetONNXType() != ONNX_TYPE_TENSOR) refuse(fmt::format("the network's {} is no tensor", role));
  const auto tensor = type.GetTensorTypeAndShapeInfo();
  std::vector<std::int64_t> shape = tensor.GetShape();
  const std::vector<std::int64_t> found = shape;
  if (!shape.empty() && shape.front() == -1) shape.front() = 1;  // any number of samples: one
  const std::vector<std::int64_t> one_sample = {1, expected.size};
  if (tensor.GetElementType() != ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT || shape != one_sample) {
    refuse(fmt::format("the network's {} has shape [{}]; expected single-precision [1, {}]", role,
                       fmt::join(found, ", "), expected.size));
  }
}

}  // namespace

struct OnnxNetwork::Session {
  explicit Session(const std::filesystem::path& file)
      : session(environment, file.c_str(), session_options()), binding(session) {}

  Ort::Env environment{ORT_LOGGING_LEVEL_ERROR, "pmg"};
  Ort::Session session;
  Ort::Value input_tensor{nullptr}, output_tensor{nullptr};
  Ort::IoBinding binding;
  Ort::RunOptions run_options;
};

OnnxNetwork::OnnxNetwork(const std::filesystem::path& file) {
  files::expect_bounded_file(file, files::kLargestPolicy_bytes, "an ONNX policy");
  try {
    session_ = std::make_unique<Session>(file);
  } catch (const Ort::Exception& error) {
    const bool network = error.GetOrtErrorCode() != ORT_INVALID_PROTOBUF &&
                         std::string_view(error.what()).find("does not have a graph") == std::string_view::npos;
    if (network) throw;
    refuse("isn't an ONNX network, or not a whole one; expected an ONNX policy");
  }
}

OnnxNetwork::~OnnxNetwork() = default;

std::optional<std::string> OnnxNetwork::metadata(const char* key) const {
  const Ort::AllocatorWithDefaultOptions allocator;
  const Ort::AllocatedStringPtr text =
      session_->session.GetModelMetadata().LookupCustomMetadataMapAllocated(key, allocator);
  if (!text) return std::nullopt;
  if (const std::size_t bytes = std::strlen(text.get()); bytes > kLargestMetadata_bytes) {
    refuse(fmt::format("its metadata {} has {} bytes; expected {} at most", key, bytes, kLargestMetadata_bytes));
  }
  return text.get();
}

void OnnxNetwork::bind(const TensorExpected& input, const TensorExpected& output) {
  const Ort::Session& session = session_->session;
  const std::vector<std::string> inputs = names(session.GetInputCount(),
                                                std::bind_front(&Ort::Session::GetInputNameAllocated, &session)),
                                 outputs = names(session.GetOutputCount(),
                                                 std::bind_front(&Ort::Session::GetOutputNameAllocated, &session));
  if (inputs.size() != 1 || outputs.size() != 1) {
    refuse(fmt::format("the network has {} inputs ({}) and {} outputs ({}); expected one of each", inputs.size(),
                       fmt::join(inputs, ", "), outputs.size(), fmt::join(outputs, ", ")));
  }
  expect_tensor("input", inputs[0], session.GetInputTypeInfo(0), input);
  expect_tensor("output", outputs[0], session.GetOutputTypeInfo(0), output);
  input_.setZero(input.size);
  output_.setZero(output.size);
  const auto memory = Ort::MemoryInfo::CreateCpu(OrtArenaAllocator, OrtMemTypeDefault);
  const auto tensor = [&memory](Eigen::VectorXf& buffer) {
    const std::array<std::int64_t, 2> shape = {1, buffer.size()};
    return Ort::Value::CreateTensor<float>(memory, buffer.data(), static_cast<std::size_t>(buffer.size()), shape.data(),
                                           shape.size());
  };
  session_->input_tensor = tensor(input_);
  session_->output_tensor = tensor(output_);
  session_->binding.BindInput(inputs[0].c_str(), session_->input_tensor);
  session_->binding.BindOutput(outputs[0].c_str(), session_->output_tensor);
}

bool OnnxNetwork::run() noexcept {
  bool ran = input_.allFinite();
  try {
    if (ran) session_->session.Run(session_->run_options, session_->binding);
  } catch (const Ort::Exception&) {
    ran = false;
  }
  if (!ran) output_.setConstant(std::numeric_limits<float>::quiet_NaN());
  return output_.allFinite();
}

}  // namespace pmg::policy
