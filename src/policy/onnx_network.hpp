// One network in ONNX Runtime with one input and one output, both single precision, bound to buffers of its own.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace pmg::policy {

/// What a network's input or output must be: its name (empty: any) and its elements, of one sample.
struct TensorExpected {
  std::string name;
  Eigen::Index size = 0;
};

class OnnxNetwork {
 public:
  /// Reads the file. Throws files::ConfigError when it is missing or too large, Ort::Exception when it is no network.
  explicit OnnxNetwork(const std::filesystem::path& file);
  ~OnnxNetwork();
  OnnxNetwork(const OnnxNetwork&) = delete;  ///< the runtime has the buffers' addresses
  OnnxNetwork& operator=(const OnnxNetwork&) = delete;

  /// The text of a metadata entry; nullopt without it. Throws std::invalid_argument when it is implausibly long.
  std::optional<std::string> metadata(const char* key) const;

  /// Checks shapes and makes the buffers; once, before the first run(). Throws std::invalid_argument saying what
  /// differs.
  void bind(const TensorExpected& input, const TensorExpected& output);

  Eigen::VectorXf& input() noexcept { return input_; }    ///< its size stays as bound
  Eigen::VectorXf& output() noexcept { return output_; }  ///< of the last run()

  /// (input) => (output). False when the runtime fails or a value isn't finite; a network that didn't run leaves no
  /// number in its output. One thread, no lock; ONNX Runtime makes the same number of heap allocations in each call.
  bool run() noexcept;

 private:
  struct Session;
  std::unique_ptr<Session> session_;
  Eigen::VectorXf input_, output_;
};

}  // namespace pmg::policy
