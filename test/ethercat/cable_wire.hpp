// A cable between two network interfaces of this namespace, ecat0 and ecat1, in lockstep: the slaves of a MemoryWire
// serve each frame behind the kernel. test/ethercat/cablerun makes the interfaces.
#pragma once

#include <array>
#include <cstdlib>

#include "ethercat/memory_wire.hpp"
#include "ethercat/packet_wire.hpp"

namespace pmg::test {

/// PMG_ETHERCAT_CABLE=1 in the environment: over these interfaces; otherwise over memory.
inline bool over_cable() { return std::getenv("PMG_ETHERCAT_CABLE") != nullptr; }

class CableWire final : public ethercat::Wire {
 public:
  explicit CableWire(MemoryWire& slaves) : slaves_(slaves) {}

  bool send(std::span<const std::uint8_t> frame) noexcept override {
    if (slaves_.cut) return true;
    if (!host_.send(frame)) return false;
    const std::size_t bytes = far_.receive(frame_, kPatience_ns);
    slaves_.pass_slaves(std::span(frame_).first(bytes));
    awaited_ = bytes > 0 && far_.send(std::span(frame_).first(bytes));
    return true;
  }
  std::size_t receive(std::span<std::uint8_t> frame, std::int64_t) noexcept override {
    if (!awaited_) return 0;
    awaited_ = false;
    return host_.receive(frame, kPatience_ns);
  }

 private:
  static constexpr std::int64_t kPatience_ns =
      1'000'000'000;  // a loaded kernel delivers later; in lockstep no time passes
  MemoryWire& slaves_;
  ethercat::PacketWire host_{"ecat0"}, far_{"ecat1"};
  std::array<std::uint8_t, ethercat::kMostFrame> frame_{};
  bool awaited_ = false;
};

}  // namespace pmg::test
