// LCM messages from a UDP multicast group, without liblcm and without a thread: a socket and an LcmAssembler.
#pragma once

#include <netinet/in.h>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/lcm_assembler.hpp"
#include "io/lcm_url.hpp"

namespace pmg::io {

/// For one thread. Bound to the group's own address, so a datagram to another address of this computer isn't heard.
/// With TTL 0 it hears this computer's programs only.
class MulticastReceiver {
 public:
  /// Throws std::runtime_error with one line: this computer can't hear the group.
  MulticastReceiver(const std::string& url, const UdpmAddress& address);
  ~MulticastReceiver();
  MulticastReceiver(const MulticastReceiver&) = delete;
  MulticastReceiver& operator=(const MulticastReceiver&) = delete;

  std::size_t want(std::string channel) { return assembler_.want(std::move(channel)); }

  /// True when a datagram waits, or comes within this time.
  bool wait(int timeout_ms) noexcept;

  /// Takes one waiting datagram. False: none waits, or the network failed (counted). message: the one that it
  /// completed, if any, valid until the next call.
  bool take(std::optional<LcmMessage>& message) noexcept;

  const LcmAssembler::Counts& counts() const noexcept { return assembler_.counts(); }
  std::int64_t from_elsewhere() const noexcept { return from_elsewhere_; }  ///< with TTL 0: other computers' datagrams
  std::int64_t errors() const noexcept { return errors_; }

 private:
  bool from_here(const in_addr& sender) noexcept;

  int fd_ = -1;
  bool this_computer_only_;
  in_addr group_;
  std::vector<std::uint32_t> addresses_;  // of this computer, network byte order
  std::int64_t addresses_read_ns_ = 0;
  LcmAssembler assembler_;
  std::int64_t from_elsewhere_ = 0, errors_ = 0;
  std::array<std::uint8_t, 65536> datagram_{};
};

}  // namespace pmg::io
