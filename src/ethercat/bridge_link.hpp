// A slave that bridges CAN, as the way to one CAN bus: its process data carry several CAN frames a cycle in both
// directions.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "can/link.hpp"

namespace pmg::ethercat {

/// A channel's process data, the same in both directions: sequence (1 byte, another one with each new batch of frames),
/// taken (1 byte: sequence of the last batch that the sender of this block took), count (1 byte), health (1 byte, from
/// the bridge: 0 good, 1 error-passive, 2 bus-off), then room for frames of 13 bytes: identifier (4 bytes, low byte
/// first, bit 31: 29 bits), length (1 byte), data (8 bytes).
inline constexpr std::size_t kBlockHeader = 4, kFrameBytes = 13;
constexpr std::size_t block_bytes(int frames) { return kBlockHeader + kFrameBytes * static_cast<std::size_t>(frames); }

/// Classic frames into a block, as many as there is room for; returns how many.
std::size_t put_frames(std::span<const drives::Message> frames, std::span<std::uint8_t> block) noexcept;
/// Calls hear(frame) for each frame of a block that has the form of one.
template <typename Hear>
void for_frames(std::span<const std::uint8_t> block, Hear&& hear) noexcept {
  if (block.size() < kBlockHeader) return;
  const std::size_t room = (block.size() - kBlockHeader) / kFrameBytes;
  for (std::size_t i = 0; i < std::min<std::size_t>(block[2], room); ++i) {
    const std::uint8_t* at = &block[kBlockHeader + i * kFrameBytes];
    if (at[4] > 8) continue;
    const std::uint32_t id = static_cast<std::uint32_t>(at[0]) | static_cast<std::uint32_t>(at[1]) << 8U |
                             static_cast<std::uint32_t>(at[2]) << 16U | static_cast<std::uint32_t>(at[3]) << 24U;
    drives::Message frame = drives::Message::of(id & 0x1FFFFFFFU, std::span(at + 5, at[4]));
    frame.extended = (id & 0x80000000U) != 0;
    hear(frame);
  }
}

/// Frames wait here for the cycle's process data. No heap.
class BridgeLink final : public can::Link {
 public:
  /// Frames: while drives are asked one by one, nobody fetches for 20 exchanges, in each of which an IMU sends three.
  static constexpr std::size_t kRoom = 128;

  std::size_t send(std::span<const drives::Message> frames) noexcept override;
  std::size_t receive(std::span<drives::Message> frames) noexcept override;
  can::BusHealth health() const noexcept override { return health_; }
  const can::LinkCounts& counts() const noexcept override { return counts_; }

  /// The bridge's block of this cycle: a batch that was seen before gives nothing. True: a new batch without room left,
  /// so the bridge may have more.
  bool take(std::span<const std::uint8_t> inputs) noexcept;
  /// What was sent since the last call, as the block to the bridge. Frames beyond its room are counted as not sent.
  void fill(std::span<std::uint8_t> outputs) noexcept;

 private:
  std::array<drives::Message, kRoom> out_{}, in_{};
  std::size_t out_count_ = 0, in_first_ = 0, in_count_ = 0;
  std::uint8_t sequence_ = 0, taken_ = 0;
  can::BusHealth health_ = can::BusHealth::kGood;
  can::LinkCounts counts_;
};

}  // namespace pmg::ethercat
