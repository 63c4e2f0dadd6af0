// A network interface as the way to EtherCAT slaves: a packet socket, which needs CAP_NET_RAW.
#pragma once

#include <string>

#include "ethercat/wire.hpp"

namespace pmg::ethercat {

class PacketWire final : public Wire {
 public:
  /// Throws std::runtime_error, one line: no such interface, it is down, or no permission.
  explicit PacketWire(const std::string& interface);
  ~PacketWire() override;
  PacketWire(const PacketWire&) = delete;
  PacketWire& operator=(const PacketWire&) = delete;

  bool send(std::span<const std::uint8_t> frame) noexcept override;
  std::size_t receive(std::span<std::uint8_t> frame, std::int64_t wait_ns) noexcept override;

 private:
  int socket_ = -1;
};

}  // namespace pmg::ethercat
