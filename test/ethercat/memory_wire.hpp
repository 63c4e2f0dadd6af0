// A cable without a kernel: each frame has passed the slaves when send() returns.
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "ethercat/emulated_slave.hpp"
#include "ethercat/wire.hpp"
#include "io/clock.hpp"

namespace pmg::test {

/// Runs a frame through the slaves of a cable, in place. Bytes that aren't a frame pass unchanged.
inline void pass(std::span<std::uint8_t> frame, std::span<const std::unique_ptr<EmulatedSlave>> slaves) {
  if (frame.size() < 28 || frame[12] != 0x88 || frame[13] != 0xA4) return;
  for (std::size_t at = 16; at + 12 <= frame.size();) {
    const std::size_t length = static_cast<std::size_t>(frame[at + 6] | (frame[at + 7] & 0x07) << 8);
    if (at + 12 + length > frame.size()) return;
    std::uint8_t* end = &frame[at + 10 + length];
    auto counter = static_cast<std::uint16_t>(end[0] | end[1] << 8);
    for (const auto& slave : slaves) slave->serve(frame[at], &frame[at + 2], frame.subspan(at + 10, length), counter);
    end[0] = static_cast<std::uint8_t>(counter);
    end[1] = static_cast<std::uint8_t>(counter >> 8U);
    if ((frame[at + 7] & 0x80U) == 0) return;
    at += 12 + length;
  }
}

class MemoryWire final : public ethercat::Wire {
 public:
  bool send(std::span<const std::uint8_t> frame) noexcept override {
    if (cut) return true;
    before_ = frame_;
    before_size_ = sent_;
    sent_ = frame.size();
    std::copy(frame.begin(), frame.end(), frame_.begin());
    size_ = frame.size();
    pass_slaves(std::span(frame_).first(size_));
    return true;
  }
  void pass_slaves(std::span<std::uint8_t> frame) noexcept {
    pass(frame, slaves);
    if (spoil) spoil(frame);
  }
  std::size_t receive(std::span<std::uint8_t> frame, std::int64_t wait_ns) noexcept override {
    if (held_up && wait_ns > 0) {
      const io::WallClock clock;
      for (const std::int64_t end_ns = clock.now_ns() + wait_ns; clock.now_ns() < end_ns;) {
      }
      return 0;
    }
    if (late > 0) {
      --late;
      std::copy_n(before_.begin(), std::min(before_size_, frame.size()), frame.begin());
      return std::min(before_size_, frame.size());
    }
    const std::size_t size = std::min(size_, frame.size());
    std::copy_n(frame_.begin(), size, frame.begin());
    size_ = 0;
    return size;
  }
  std::vector<std::unique_ptr<EmulatedSlave>> slaves;
  int late = 0;          ///< so many frames that were given up come before the next answer
  bool cut = false;      ///< frames are lost
  bool held_up = false;  ///< whoever waits for a frame is held up until that time is over; the frame is there then
  void (*spoil)(std::span<std::uint8_t>) = nullptr;  ///< what happens to each frame on its way back

 private:
  std::array<std::uint8_t, ethercat::kMostFrame> frame_{}, before_{};
  std::size_t size_ = 0, sent_ = 0, before_size_ = 0;
};

}  // namespace pmg::test
