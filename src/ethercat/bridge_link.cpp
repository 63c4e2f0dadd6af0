#include "ethercat/bridge_link.hpp"

#include <algorithm>

namespace pmg::ethercat {

std::size_t put_frames(std::span<const drives::Message> frames, std::span<std::uint8_t> block) noexcept {
  if (block.size() < kBlockHeader) return 0;
  const std::size_t room = (block.size() - kBlockHeader) / kFrameBytes, count = std::min(frames.size(), room);
  for (std::size_t i = 0; i < count; ++i) {
    const drives::Message& frame = frames[i];
    const std::uint32_t id = frame.id | (frame.extended ? 0x80000000U : 0U);
    std::uint8_t* at = &block[kBlockHeader + i * kFrameBytes];
    for (std::size_t k = 0; k < 4; ++k) at[k] = static_cast<std::uint8_t>(id >> 8U * k);
    at[4] = std::min<std::uint8_t>(frame.length, 8);
    std::copy_n(frame.data.begin(), 8, at + 5);
  }
  block[2] = static_cast<std::uint8_t>(count);
  return count;
}

std::size_t BridgeLink::send(std::span<const drives::Message> frames) noexcept {
  std::size_t taken = 0;
  for (; taken < frames.size() && out_count_ < kRoom && !frames[taken].fd && frames[taken].length <= 8; ++taken)
    out_[out_count_++] = frames[taken];
  counts_.not_sent += frames.size() - taken;
  return taken;
}

std::size_t BridgeLink::receive(std::span<drives::Message> frames) noexcept {
  const std::size_t count = std::min(frames.size(), in_count_ - in_first_);
  std::copy_n(in_.begin() + static_cast<std::ptrdiff_t>(in_first_), count, frames.begin());
  in_first_ += count;
  counts_.received += count;
  return count;
}

bool BridgeLink::take(std::span<const std::uint8_t> inputs) noexcept {
  if (inputs.size() < kBlockHeader) return false;
  health_ = inputs[3] == 0 ? can::BusHealth::kGood : (inputs[3] == 1 ? can::BusHealth::kPassive : can::BusHealth::kOff);
  if (inputs[0] == taken_) return false;
  taken_ = inputs[0];
  // What nobody fetched stays before it, as long as there is room.
  std::copy(in_.begin() + static_cast<std::ptrdiff_t>(in_first_), in_.begin() + static_cast<std::ptrdiff_t>(in_count_),
            in_.begin());
  in_count_ -= in_first_;
  in_first_ = 0;
  for_frames(inputs, [this](const drives::Message& frame) {
    if (in_count_ < kRoom) in_[in_count_++] = frame;
  });
  return inputs[2] >= (inputs.size() - kBlockHeader) / kFrameBytes;
}

void BridgeLink::fill(std::span<std::uint8_t> outputs) noexcept {
  if (outputs.size() < kBlockHeader) return;
  const std::size_t count = put_frames(std::span(out_).first(out_count_), outputs);
  counts_.sent += count;
  counts_.not_sent += out_count_ - count;
  out_count_ = 0;
  outputs[0] = ++sequence_;
  outputs[1] = taken_;
  outputs[3] = 0;
}

}  // namespace pmg::ethercat
