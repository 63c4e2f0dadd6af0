// test/data/policies/linear.onnx: one random linear layer with the metadata of a trained policy, adapted to a test's
// clips and variant. training/tests/make_linear_policy.py writes it again when robot or layout change.
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
inline const std::string kNoClips(64, '0');  ///< the clip library named in its metadata

/// A copy of the file that lives as long as this object. Replaced texts keep their length, so the surrounding protobuf
/// stays valid.
class LinearPolicyFile {
 public:
  LinearPolicyFile() {
    std::ifstream in(kLinearPolicy, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(in), {});
    save();
  }
  /// As if trained on these clips: a controller with them accepts it.
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
  /// `size` bytes from the beginning of this text.
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
