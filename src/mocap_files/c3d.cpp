// C3D as https://www.c3d.org/HTML specifies it: a header block of 512 bytes, parameter blocks, then frames. Neither
// Debian 12 nor 13 packages a library for it (ezc3d, btk), so this reads the part that markers need.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <limits>
#include <map>

#include "mocap_files/bytes.hpp"
#include "mocap_files/motion.hpp"
#include "mocap_files/unit_name.hpp"

namespace pmg::mocap {
namespace {

constexpr std::size_t kC3dBlock_bytes = 512;

/// A byte of two's complement.
constexpr int with_sign(std::uint8_t byte) { return byte < 128 ? byte : byte - 256; }

/// Numbers as the processor wrote them that made the file.
class C3dNumbers {
 public:
  enum class Processor : std::uint8_t { kIntel = 84, kDec = 85, kMips = 86 };

  C3dNumbers(const Bytes& bytes, Processor processor) : bytes_(bytes), processor_(processor) {}

  std::uint16_t word(std::size_t offset, const std::string& expected) const {
    const std::uint16_t value = bytes_.u16(offset, expected);
    return processor_ == Processor::kMips ? static_cast<std::uint16_t>(value << 8 | value >> 8) : value;
  }
  double integer(std::size_t offset, const std::string& expected) const {
    return static_cast<std::int16_t>(word(offset, expected));
  }
  double real(std::size_t offset, const std::string& expected) const {
    const std::uint32_t low = word(offset, expected), high = word(offset + 2, expected);
    if (processor_ == Processor::kMips) return static_cast<double>(std::bit_cast<float>(low << 16 | high));
    if (processor_ == Processor::kIntel) return static_cast<double>(std::bit_cast<float>(high << 16 | low));
    return static_cast<double>(std::bit_cast<float>(low << 16 | high)) / 4.0;  // DEC: words swapped, exponent 2 higher
  }

 private:
  const Bytes& bytes_;
  Processor processor_;
};

struct C3dParameter {
  int type = 0;  ///< -1: characters, 1: bytes, 2: integers, 4: reals
  std::vector<std::size_t> dimensions;
  std::size_t offset = 0;  ///< of the data
  std::size_t count() const {
    std::size_t n = 1;
    for (const std::size_t d : dimensions) n *= d;
    return n;
  }
};

using C3dParameters = std::map<std::string, C3dParameter>;  // by "GROUP:NAME"

std::string upper_case(std::string_view text) {
  std::string upper;
  for (const char c : text) upper += c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
  return upper;
}

/// Groups and parameters are one chain of records. The way from one to the next is positive, so the chain ends.
C3dParameters c3d_parameters(const Bytes& bytes, const C3dNumbers& numbers, std::size_t start) {
  std::map<int, std::string> groups;
  std::map<std::pair<int, std::string>, C3dParameter> found;
  const std::string expected = "a record of the parameter section";
  for (std::size_t at = start + 4;;) {
    const auto length = static_cast<std::size_t>(std::abs(with_sign(bytes.u8(at, expected))));
    const int id = with_sign(bytes.u8(at + 1, expected));
    if (length == 0 || id == 0) break;
    const std::string name = upper_case(bytes.at(at + 2, length, expected));
    const std::size_t after_name = at + 2 + length;
    const std::size_t step = numbers.word(after_name, expected);
    if (id < 0) {
      groups[-id] = name;
    } else {
      C3dParameter parameter;
      parameter.type = with_sign(bytes.u8(after_name + 2, expected));
      const std::size_t dimensions = bytes.u8(after_name + 3, expected);
      if (dimensions > 7) bytes.fail(after_name + 3, fmt::format("has {} dimensions", dimensions), "7 at most");
      for (std::size_t d = 0; d < dimensions; ++d)
        parameter.dimensions.push_back(bytes.u8(after_name + 4 + d, expected));
      parameter.offset = after_name + 4 + dimensions;
      const std::size_t width = static_cast<std::size_t>(std::abs(parameter.type));
      if (width != 1 && width != 2 && width != 4)
        bytes.fail(after_name + 2, fmt::format("is the type {}", parameter.type), "-1, 1, 2 or 4");
      if (parameter.count() > bytes.size())
        bytes.fail(after_name + 4, "is larger than the file", "the parameter's dimensions");
      bytes.at(parameter.offset, parameter.count() * width, expected);
      found[{id, name}] = parameter;
    }
    if (step == 0) break;
    at = after_name + step;
  }
  C3dParameters named;
  for (const auto& [key, parameter] : found) named[groups[key.first] + ":" + key.second] = parameter;
  return named;
}

std::vector<std::string> c3d_strings(const Bytes& bytes, const C3dParameters& parameters, const std::string& key) {
  std::vector<std::string> strings;
  const auto found = parameters.find(key);
  if (found == parameters.end() || found->second.type != -1 || found->second.dimensions.empty()) return strings;
  const std::size_t length = found->second.dimensions[0];
  for (std::size_t i = 0; length > 0 && i < found->second.count() / length; ++i) {
    std::string text(bytes.at(found->second.offset + i * length, length, key));
    const std::size_t end = text.find_last_not_of(std::string(" \0", 2));
    strings.push_back(end == std::string::npos ? "" : text.substr(0, end + 1));
  }
  return strings;
}

/// A number of the parameters, or else this one.
double c3d_number(const C3dNumbers& numbers, const C3dParameters& parameters, const std::string& key,
                  double otherwise) {
  const auto found = parameters.find(key);
  if (found == parameters.end() || found->second.count() == 0) return otherwise;
  if (found->second.type == 4) return numbers.real(found->second.offset, key);
  if (found->second.type == 2) return static_cast<double>(numbers.word(found->second.offset, key));
  return otherwise;
}

/// The markers' names, from LABELS, LABELS2, ...; "marker N" where there is none.
void c3d_labels(const Bytes& bytes, const C3dParameters& parameters, std::size_t points, Motion& motion) {
  std::vector<std::string> labels;
  for (int part = 1; part < 100 && labels.size() < points; ++part) {
    const auto more = c3d_strings(bytes, parameters, part == 1 ? "POINT:LABELS" : fmt::format("POINT:LABELS{}", part));
    if (more.empty()) break;
    labels.insert(labels.end(), more.begin(), more.end());
  }
  for (std::size_t i = 0; i < points; ++i) {
    const bool named = i < labels.size() && !labels[i].empty();
    motion.points.push_back({named ? labels[i] : fmt::format("marker {}", i + 1), -1, {}, {}});
  }
}

}  // namespace

Motion parse_c3d(const std::string& file, const std::string& content) {
  const Bytes bytes(file, content);
  if (bytes.u8(1, "0x50, the mark of a C3D file") != 0x50)
    bytes.fail(1, fmt::format("is {:#x}", bytes.u8(1, "")), "0x50, the mark of a C3D file");
  const std::size_t first_block = bytes.u8(0, "the number of the first parameter block");
  if (first_block < 2)
    bytes.fail(0, fmt::format("is {}", first_block), "the number of the first parameter block, 2 or more");
  const std::size_t parameters_at = (first_block - 1) * kC3dBlock_bytes;
  const int processor = bytes.u8(parameters_at + 3, "the processor type");
  if (processor < 84 || processor > 86)
    bytes.fail(parameters_at + 3, fmt::format("is {}", processor), "a processor type: 84, 85 or 86");
  const C3dNumbers numbers(bytes, static_cast<C3dNumbers::Processor>(processor));
  const C3dParameters parameters = c3d_parameters(bytes, numbers, parameters_at);

  Motion motion;
  motion.format = "C3D";
  motion.markers = true;
  const std::size_t points = numbers.word(2, "the number of points");
  const std::size_t analog = numbers.word(4, "the number of analog values a frame");
  std::size_t frames =
      static_cast<std::size_t>(numbers.word(8, "the last frame") - numbers.word(6, "the first frame") + 1) & 0xffff;
  frames = std::max(
      frames, static_cast<std::size_t>(std::clamp(c3d_number(numbers, parameters, "POINT:FRAMES", 0.0), 0.0, 1e6)));
  const double scale = c3d_number(numbers, parameters, "POINT:SCALE", numbers.real(12, "the scale factor"));
  const double start = c3d_number(numbers, parameters, "POINT:DATA_START", numbers.word(16, "the first data block"));
  const double rate_hz = c3d_number(numbers, parameters, "POINT:RATE", numbers.real(20, "the frame rate"));
  if (points == 0 || frames == 0) bytes.fail(2, "the file has no points or no frames", "recorded markers");
  if (!(rate_hz > 0.1 && rate_hz < 1e5)) bytes.fail(20, fmt::format("the frame rate is {}", rate_hz), "0.1 to 1e5 Hz");
  if (!std::isfinite(scale) || scale == 0.0) bytes.fail(12, "the scale factor is not a number, or zero", "a number");
  if (!(start >= 2.0 && start < 65536.0)) bytes.fail(16, fmt::format("the first data block is {}", start), "2 or more");
  motion.rate_hz = rate_hz;
  expect_bounded_samples(file + ": byte 2", frames, points);  // the header's counts
  c3d_labels(bytes, parameters, points, motion);
  const std::vector<std::string> units = c3d_strings(bytes, parameters, "POINT:UNITS");
  if (!units.empty()) {
    motion.unit_name = units[0];
    motion.unit_m = unit_of_name(units[0]);
  }
  const std::size_t width = scale < 0.0 ? 4 : 2;
  const std::size_t frame_bytes = width * (4 * points + analog);
  const std::size_t data = (static_cast<std::size_t>(start) - 1) * kC3dBlock_bytes;
  const std::size_t there = data < bytes.size() ? (bytes.size() - data) / frame_bytes : 0;
  if (there < frames && there + 1 < frames)
    motion.notes.push_back(fmt::format("the file states {} frames and has {}", frames, there));
  frames = std::min(frames, there);
  if (frames == 0) bytes.fail(data, fmt::format("the file ends at byte {}", bytes.size()), "the first frame");
  const auto value = [&](std::size_t at) {
    return width == 4 ? numbers.real(at, "a coordinate") : scale * numbers.integer(at, "a coordinate");
  };
  for (std::size_t f = 0; f < frames; ++f) {
    for (std::size_t p = 0; p < points; ++p) {
      const std::size_t at = data + f * frame_bytes + p * 4 * width;
      const double residual = width == 4 ? numbers.real(at + 12, "a residual") : numbers.integer(at + 6, "a residual");
      Eigen::Vector3d position(value(at), value(at + width), value(at + 2 * width));
      if (residual < 0.0 || !position.allFinite() || position.isZero(0.0))
        position.setConstant(std::numeric_limits<double>::quiet_NaN());
      motion.points[p].position.push_back(position);
    }
  }
  motion.frames = frames;
  return motion;
}

}  // namespace pmg::mocap
