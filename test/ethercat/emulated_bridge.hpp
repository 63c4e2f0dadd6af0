// An emulated slave that bridges one CAN bus, as docs/reference/file-formats.md describes its process data.
#pragma once

#include "can/memory_link.hpp"
#include "ethercat/emulated_slave.hpp"

namespace pmg::test {

class EmulatedBridge final : public EmulatedSlave {
 public:
  EmulatedBridge(int frames_out, int frames_in, std::unique_ptr<MemoryLink> can, bool clock = false)
      : EmulatedSlave(
            {.name = "Bridge", .output_bytes = 4 + 13 * frames_out, .input_bytes = 4 + 13 * frames_in, .clock = clock}),
        can_(std::move(can)) {}

  void power_up() override {
    EmulatedSlave::power_up();
    taken_ = sequence_ = count_ = 0;
  }
  std::uint8_t health = 0;  ///< of its CAN controller

 private:
  /// A new batch of the master's frames goes out on CAN.
  void take(std::span<const std::uint8_t> block) override {
    if (block[0] == taken_) return;
    taken_ = block[0];
    for (std::size_t i = 0; i < block[2] && 4 + 13 * (i + 1) <= block.size(); ++i) {
      const std::span<const std::uint8_t> at = block.subspan(4 + 13 * i, 13);
      const drives::Message frame = drives::Message::of(static_cast<std::uint32_t>(at[0] | at[1] << 8),
                                                        at.subspan(5, std::min<std::size_t>(at[4], 8)));
      can_->send(std::span(&frame, 1));
    }
  }
  /// A batch is replaced when the master has taken it.
  void give(std::span<std::uint8_t> block, std::span<const std::uint8_t> outputs) override {
    block[1] = taken_;
    block[3] = health;
    if (sequence_ == outputs[1]) {
      std::array<drives::Message, 64> frames;
      const std::size_t count = can_->receive(std::span(frames).first((block.size() - 4) / 13));
      for (std::size_t i = 0; i < count; ++i) {
        const std::span<std::uint8_t> at = block.subspan(4 + 13 * i, 13);
        at[0] = static_cast<std::uint8_t>(frames[i].id);
        at[1] = static_cast<std::uint8_t>(frames[i].id >> 8U);
        at[2] = at[3] = 0;
        at[4] = frames[i].length;
        std::copy_n(frames[i].data.begin(), 8, at.begin() + 5);
      }
      if (count > 0) {
        count_ = static_cast<std::uint8_t>(count);
        ++sequence_;
      }
    }
    block[0] = sequence_;
    block[2] = count_;
  }

  std::unique_ptr<MemoryLink> can_;
  std::uint8_t taken_ = 0, sequence_ = 0, count_ = 0;
};

}  // namespace pmg::test
