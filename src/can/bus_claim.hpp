// One program drives a bus; others watch.
#pragma once

#include <stdexcept>
#include <string>

namespace pmg::can {

/// Says who drives it.
class BusIsDriven : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A network interface is this program's until this object or the program ends. Programs of one network namespace see
/// each other's claims, whoever runs them; a program that doesn't ask isn't kept away.
class BusClaim {
 public:
  /// Throws BusIsDriven, one line: another program has it; std::runtime_error: the system refuses.
  explicit BusClaim(const std::string& interface);
  ~BusClaim();
  BusClaim(const BusClaim&) = delete;
  BusClaim& operator=(const BusClaim&) = delete;
  BusClaim(BusClaim&& other) noexcept;
  BusClaim& operator=(BusClaim&&) = delete;

 private:
  int socket_ = -1;
};

}  // namespace pmg::can
