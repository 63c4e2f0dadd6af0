// test/data/policies/linear.onnx: one random linear layer with the metadata of a trained policy, adapted to a test's
// clips and variant. training/tests/make_linear_policy.py writes it again when robot or layout change.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "folders.hpp"
#include "model/bundle.hpp"
#include "pmg/variant.hpp"
#include "temporary_folder.hpp"

namespace pmg::test {

inline const std::filesystem::path kLinearPolicy = pmg::test::project_folder() + "/test/data/policies/linear.onnx";
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
  /// One more key and value of the ONNX metadata: field 14 of ModelProto, whose field 1 is the key and field 2 the
  /// value.
  void append_metadata(const std::string& key, const std::string& value) {
    const auto field = [](char tag, const std::string& content) {
      std::string bytes(1, tag);
      std::size_t size = content.size();
      for (; size >= 0x80; size >>= 7) bytes += static_cast<char>((size & 0x7f) | 0x80);
      return bytes + static_cast<char>(size) + content;
    };
    bytes_ += field('\x72', field('\x0a', key) + field('\x12', value));
    save();
  }
  /// `size` bytes from the beginning of this text.
  std::string text_at(const std::string& text, std::size_t size) const {
    return bytes_.substr(bytes_.find(text), size);
  }
  const std::filesystem::path& file() const { return file_; }

 private:
  void save() const { std::ofstream(file_, std::ios::binary) << bytes_; }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.file("linear.onnx");
  std::string bytes_;
};

}  // namespace pmg::test
