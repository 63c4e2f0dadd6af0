// test/data/policies/linear.onnx, one random linear layer with the metadata of a trained policy, fitted to the clips
// and the variant that a test needs. training/tests/make_linear_policy.py makes it anew when robot or layout change.
#pragma once

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "model/bundle.hpp"
#include "pmg/variant.hpp"

namespace pmg::test {

inline const std::filesystem::path kLinearPolicy = PMG_SOURCE_DIR "/test/data/policies/linear.onnx";
inline const std::string kNoClips(64, '0');  ///< the clip library that it names

/// A copy of it that lives as long as this object. Texts are exchanged for others of the same length, so that the
/// protobuf around them stays whole.
class LinearPolicyFile {
 public:
  LinearPolicyFile() {
    std::ifstream in(kLinearPolicy, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(in), {});
    save();
  }
  /// As if trained on these clips, which the controller then accepts.
  LinearPolicyFile(const std::filesystem::path& clips, Variant variant) : LinearPolicyFile() {
    exchange(kNoClips, model::clip_library_sha256(clips));
    const std::string longest = "\"single_gait\"";
    std::string name = "\"" + std::string(to_string(variant)) + "\"";
    name.resize(longest.size(), ' ');
    std::string now = "\"pmg\"";
    now.resize(longest.size(), ' ');
    exchange("\"variant\": " + now, "\"variant\": " + name);
  }
  ~LinearPolicyFile() { std::filesystem::remove(file_); }
  LinearPolicyFile(const LinearPolicyFile&) = delete;
  LinearPolicyFile& operator=(const LinearPolicyFile&) = delete;

  void exchange(const std::string& text, const std::string& instead) {
    const std::size_t at = bytes_.find(text);
    if (text.size() != instead.size() || at == std::string::npos) {
      throw std::invalid_argument(text + " for " + instead);
    }
    bytes_.replace(at, text.size(), instead);
    save();
  }
  /// So many bytes from where this text begins.
  std::string text_at(const std::string& text, std::size_t size) const {
    return bytes_.substr(bytes_.find(text), size);
  }
  const std::filesystem::path& file() const { return file_; }

 private:
  void save() const { std::ofstream(file_, std::ios::binary) << bytes_; }
  static std::string unique_name() {
    static std::atomic<int> made{0};
    return "pmg_linear_policy_" + std::to_string(getpid()) + "_" + std::to_string(made++) + ".onnx";
  }

  std::filesystem::path file_ = std::filesystem::temp_directory_path() / unique_name();
  std::string bytes_;
};

}  // namespace pmg::test
