#include "ethercat/process_data_imu.hpp"

#include <algorithm>
#include <bit>

namespace pmg::ethercat {

namespace {

std::uint16_t word(std::span<const std::uint8_t> bytes) noexcept {
  return static_cast<std::uint16_t>(bytes[0] | bytes[1] << 8U);
}

/// 32-bit floats, low byte first.
template <int N>
Eigen::Matrix<double, N, 1> floats(std::span<const std::uint8_t> bytes) noexcept {
  Eigen::Matrix<double, N, 1> values;
  for (std::size_t i = 0; i < static_cast<std::size_t>(N); ++i) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 4; ++k) bits |= static_cast<std::uint32_t>(bytes[4 * i + k]) << 8U * k;
    values[static_cast<Eigen::Index>(i)] = static_cast<double>(std::bit_cast<float>(bits));
  }
  return values;
}

}  // namespace

void ProcessDataImu::begin_cycle() noexcept { age_ = std::min(age_ + 1, kNever); }

void ProcessDataImu::take(std::span<const std::uint8_t> inputs) noexcept {
  if (inputs.size() < static_cast<std::size_t>(setup_.input_bytes)) return;
  const auto at = [&](int offset) { return inputs.subspan(static_cast<std::size_t>(offset)); };
  const std::uint16_t counter = word(at(setup_.counter_at));
  if (counter_ == counter) return;
  counter_ = counter;
  status_ = setup_.status_at < 0 ? std::uint16_t{0} : word(at(setup_.status_at));
  auto sample = imu::believed_sample(floats<4>(at(setup_.quaternion_at)), floats<3>(at(setup_.rate_of_turn_at)),
                                     floats<3>(at(setup_.acceleration_at)));
  if (status_ != 0 || !sample) {
    ++not_believed_;
    return;
  }
  sample_ = *sample;
  sample_.counter = counter;
  age_ = 0;
}

}  // namespace pmg::ethercat
