// One controller of a name: a lock on this computer, and a claim on the network.
#pragma once

#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "io/lcm_link.hpp"

namespace pmg::runtime {

/// Held by one program of this computer (network namespace) for a name and an address at a time. The kernel gives it
/// back when the program ends, however it ends. It is an abstract Unix socket: no file stays behind.
class NameLock {
 public:
  /// Throws std::runtime_error with one line when another program holds it: name, address, its process.
  NameLock(const std::string& name, const std::string& lcm_url);
  ~NameLock();
  NameLock(const NameLock&) = delete;
  NameLock& operator=(const NameLock&) = delete;

 private:
  int fd_ = -1;
};

/// Repeats a message on CLAIM, from a thread of its own, until it is destroyed: between the end of
/// Comms::listen_for_others() and the first STATUS the name must not look free.
class HeldClaim {
 public:
  static constexpr int kPeriod_ms = 20;
  HeldClaim(io::LcmLink& link, std::vector<std::uint8_t> claim);

 private:
  std::jthread thread_;
};

}  // namespace pmg::runtime
