#include "imu/mti_messages.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace pmg::imu {

namespace {

constexpr std::uint8_t kPreamble = 0xFA, kMaster = 0xFF, kExtended = 0xFF;
constexpr std::size_t kHead = 4, kTail = 1;

/// Bits of the status word that make a sample uncertain: no valid filter (bit 1 is 0), or clipping (bits 8 to 16).
constexpr std::uint32_t kFilterValid = 1U << 1U, kClipping = 0x1FFU << 8U;

constexpr double kMostRate_rad_s = 100.0, kMostAcceleration_m_s2 = 1000.0;  // five times what MTi devices measure

std::uint16_t word(Bytes bytes) noexcept { return static_cast<std::uint16_t>(bytes[0] << 8U | bytes[1]); }

std::uint32_t long_word(Bytes bytes) noexcept {
  return static_cast<std::uint32_t>(word(bytes)) << 16U | word(bytes.subspan(2));
}

/// N floats; false: another length.
template <int N>
bool read(Bytes bytes, Eigen::Matrix<double, N, 1>& values) noexcept {
  if (bytes.size() != 4U * N) return false;
  for (int i = 0; i < N; ++i) {
    values[i] = static_cast<double>(std::bit_cast<float>(long_word(bytes.subspan(4U * static_cast<std::size_t>(i)))));
  }
  return true;
}

/// So many bytes of a number, high byte first.
void append(std::vector<std::uint8_t>& to, std::uint32_t number, unsigned bytes) {
  for (unsigned left = bytes; left > 0; --left)
    to.push_back(static_cast<std::uint8_t>(number >> 8U * (left - 1) & 0xFFU));
}

/// Identifier, length, floats.
template <typename Values>
void append_item(std::vector<std::uint8_t>& to, std::uint16_t id, const Values& values) {
  append(to, id, 2);
  append(to, static_cast<std::uint32_t>(4 * values.size()), 1);
  for (Eigen::Index i = 0; i < values.size(); ++i)
    append(to, std::bit_cast<std::uint32_t>(static_cast<float>(values[i])), 4);
}

}  // namespace

std::vector<std::uint8_t> mti_message(MtiId id, Bytes data) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(kHead + data.size() + kTail);
  for (const std::uint8_t byte :
       {kPreamble, kMaster, static_cast<std::uint8_t>(id), static_cast<std::uint8_t>(data.size())})
    bytes.push_back(byte);
  for (const std::uint8_t byte : data) bytes.push_back(byte);
  std::uint8_t sum = 0;
  for (const std::uint8_t byte : Bytes(bytes).subspan(1)) sum = static_cast<std::uint8_t>(sum + byte);
  bytes.push_back(static_cast<std::uint8_t>(-sum));
  return bytes;
}

std::size_t MtiFramer::hear(Bytes bytes) noexcept {
  if (begin_ > 0) {
    std::memmove(bytes_.data(), bytes_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  const std::size_t count = std::min(bytes.size(), bytes_.size() - end_);
  std::memcpy(bytes_.data() + end_, bytes.data(), count);
  end_ += count;
  return count;
}

std::optional<MtiMessage> MtiFramer::next() noexcept {
  while (begin_ < end_) {
    const Bytes rest = Bytes(bytes_).subspan(begin_, end_ - begin_);
    // An extended length belongs to messages of 255 bytes and more, which this program asks no device for.
    const bool head =
        rest[0] == kPreamble && (rest.size() < 2 || rest[1] == kMaster) && (rest.size() < 4 || rest[3] != kExtended);
    if (head) {
      if (rest.size() < kHead || rest.size() < kHead + rest[3] + kTail) return std::nullopt;  // more is to come
      const std::size_t size = kHead + rest[3] + kTail;
      std::uint8_t sum = 0;
      for (const std::uint8_t byte : rest.subspan(1, size - 1)) sum = static_cast<std::uint8_t>(sum + byte);
      if (sum == 0) {
        begin_ += size;
        return MtiMessage{.id = MtiId{rest[2]}, .data = rest.subspan(kHead, size - kHead - kTail)};
      }
      ++checksum_errors_;
    }
    // What looked like the beginning of a message is none: a true one may begin at the next byte.
    ++begin_;
    ++skipped_;
  }
  return std::nullopt;
}

std::optional<MtiSample> believed_sample(const Eigen::Vector4d& q_wxyz, const Eigen::Vector3d& gyro_rad_s,
                                         const Eigen::Vector3d& acceleration_m_s2) noexcept {
  const double norm = q_wxyz.norm();
  if (!(std::abs(norm - 1.0) < 0.01) || !(gyro_rad_s.norm() <= kMostRate_rad_s) ||
      !(acceleration_m_s2.norm() <= kMostAcceleration_m_s2))
    return std::nullopt;
  MtiSample sample;
  sample.orientation_WI = Eigen::Quaterniond(q_wxyz[0] / norm, q_wxyz[1] / norm, q_wxyz[2] / norm, q_wxyz[3] / norm);
  sample.gyro_rad_s = gyro_rad_s;
  sample.acceleration_m_s2 = acceleration_m_s2;
  return sample;
}

std::optional<MtiSample> decode_mti_sample(Bytes data) noexcept {
  std::uint16_t counter = 0;
  bool certain = true;
  Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero(), acceleration_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector4d q = Eigen::Vector4d::Zero();
  bool has_q = false, has_rate = false, has_acceleration = false;
  while (!data.empty()) {
    constexpr std::size_t kItemHead = 3;
    if (data.size() < kItemHead || data.size() < kItemHead + data[2]) return std::nullopt;
    const std::uint16_t id = word(data);
    const Bytes value = data.subspan(kItemHead, data[2]);
    data = data.subspan(kItemHead + value.size());
    if (id == kQuaternion) has_q = read<4>(value, q);
    if (id == kRateOfTurn) has_rate = read<3>(value, gyro_rad_s);
    if (id == kAcceleration) has_acceleration = read<3>(value, acceleration_m_s2);
    if (id == kPacketCounter && value.size() == 2) counter = word(value);
    if (id == kStatusWord && value.size() == 4) {
      const std::uint32_t status = long_word(value);
      certain = (status & kFilterValid) != 0 && (status & kClipping) == 0;
    }
  }
  if (!has_q || !has_rate || !has_acceleration) return std::nullopt;
  std::optional<MtiSample> sample = believed_sample(q, gyro_rad_s, acceleration_m_s2);
  if (sample) {
    sample->counter = counter;
    sample->certain = certain;
  }
  return sample;
}

std::vector<std::uint8_t> encode_mti_sample(const MtiSample& sample) {
  const Eigen::Quaterniond& q = sample.orientation_WI;
  std::vector<std::uint8_t> data;
  append(data, kPacketCounter, 2);
  append(data, 2, 1);
  append(data, sample.counter, 2);
  append_item(data, kQuaternion, Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()));
  append_item(data, kAcceleration, sample.acceleration_m_s2);
  append_item(data, kRateOfTurn, sample.gyro_rad_s);
  append(data, kStatusWord, 2);
  append(data, 4, 1);
  append(data, sample.certain ? kFilterValid : 0, 4);
  return data;
}

}  // namespace pmg::imu
