// The layers of an exported policy, read from its ONNX file without a library: the floor must compute the same network.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace pmg::test {

/// Protocol buffers' wire format, as far as ONNX needs it: each field is a key, then a number or a number of bytes.
class ProtobufFields {
 public:
  explicit ProtobufFields(std::string_view message) : message_(message) {}

  /// The next field; false at the end. bytes is empty for plain numbers.
  bool next() {
    if (at_ >= message_.size()) return false;
    const std::uint64_t key = varint();
    field = static_cast<int>(key >> 3U);
    bytes = {};
    switch (key & 7U) {
      case 0:
        number = varint();
        return true;
      case 1:
        at_ += 8;
        return true;
      case 2:
        number = varint();
        bytes = message_.substr(at_, number);
        at_ += number;
        return true;
      case 5:
        at_ += 4;
        return true;
      default:
        throw std::runtime_error("no protocol buffer");
    }
  }

  int field = 0;
  std::uint64_t number = 0;
  std::string_view bytes;

 private:
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; at_ < message_.size() && shift < 64; shift += 7) {
      const auto byte = static_cast<unsigned char>(message_[at_++]);
      value |= static_cast<std::uint64_t>(byte & 0x7FU) << shift;
      if (byte < 0x80U) return value;
    }
    throw std::runtime_error("no protocol buffer");
  }
  std::string_view message_;
  std::size_t at_ = 0;
};

/// clip(normalised observation) through layers of ELU, the last one linear and clamped, as training/pmg_train/export.py
/// writes it: constants mean, scale, low, high, w0, b0, w1, ..., action_low, action_high.
struct OnnxNetwork {
  explicit OnnxNetwork(const std::filesystem::path& file) {
    constexpr int kGraph = 7, kInitializer = 5;
    std::ifstream in(file, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(in), {});
    for (ProtobufFields model(bytes); model.next();) {
      if (model.field != kGraph) continue;
      for (ProtobufFields graph(model.bytes); graph.next();) {
        if (graph.field == kInitializer) add_constant(graph.bytes);
      }
    }
    for (int layer = 0; constants_.contains(named('w', layer)); ++layer) {
      const Eigen::VectorXf &w = constant(named('w', layer)), &b = constant(named('b', layer));
      using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      weight.emplace_back(Eigen::Map<const RowMajor>(w.data(), b.size(), w.size() / b.size()));
      bias.push_back(b);
    }
    mean = constant("mean");
    scale = constant("scale");
    input_limit = constant("high")[0];
    action_limit = constant("action_high")[0];
  }

  std::vector<Eigen::MatrixXf> weight;
  std::vector<Eigen::VectorXf> bias;
  Eigen::VectorXf mean, scale;
  float input_limit = 0.0F, action_limit = 0.0F;

 private:
  static std::string named(char kind, int layer) { return std::string(1, kind).append(std::to_string(layer)); }
  void add_constant(std::string_view tensor) {
    constexpr int kName = 8, kRawData = 9;
    std::string name;
    Eigen::VectorXf values;
    for (ProtobufFields fields(tensor); fields.next();) {
      if (fields.field == kName) name = fields.bytes;
      if (fields.field != kRawData) continue;
      values.resize(static_cast<Eigen::Index>(fields.bytes.size() / sizeof(float)));
      std::memcpy(values.data(), fields.bytes.data(), fields.bytes.size());
    }
    constants_[name] = std::move(values);
  }
  const Eigen::VectorXf& constant(const std::string& name) const {
    const auto found = constants_.find(name);
    if (found == constants_.end() || found->second.size() == 0)
      throw std::runtime_error("the policy has no constant " + name);
    return found->second;
  }
  std::map<std::string, Eigen::VectorXf> constants_;
};

}  // namespace pmg::test
