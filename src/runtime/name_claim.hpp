// One controller of a name: a lock on this computer, and a claim on the network.
#pragma once

#include <functional>
#include <string>
#include <thread>

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

/// Calls answer() again and again, from a thread of its own, until it is destroyed: between the end of
/// Comms::listen_for_others() and the first step the name must not look free.
class HeldClaim {
 public:
  static constexpr int kWait_ms = 5;  ///< for which answer() waits at most
  explicit HeldClaim(std::function<void()> answer);

 private:
  std::jthread thread_;
};

}  // namespace pmg::runtime
