// What the doctor asks of the computer. Tests answer in the computer's place.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "doctor/can_link.hpp"

namespace pmg::doctor {

/// How long a network card may collect received frames before it interrupts (ethtool's rx-usecs).
struct Coalescing {
  std::uint32_t receive_us = 0;
  bool adaptive = false;
};

struct ClockReading {
  std::int64_t realtime_ns = 0;   ///< since 1970
  std::int64_t monotonic_ns = 0;  ///< taken at the same moment
  bool synchronised = false;      ///< the kernel says so (adjtimex): NTP or PTP steers the clock
};

struct DiskSpace {
  std::uint64_t free_bytes = 0;  ///< for this user
  std::string folder;            ///< the nearest one that exists
};

struct WriteSpeed {
  double bytes_per_s = 0.0;
  std::string problem;  ///< why nothing could be written; empty: it was
};

class Host {
 public:
  virtual ~Host() = default;
  /// The text of a file of /proc or /sys, its newline at the end left out; path: without the first slash. Nullopt: it
  /// isn't there or can't be read.
  virtual std::optional<std::string> text(const std::string& path) const = 0;
  virtual std::vector<std::string> names(const std::string& folder) const = 0;  ///< in a folder; sorted; empty: none
  /// Asks for SCHED_FIFO with this priority, in a thread of its own. 0, or the error's number.
  virtual int try_fifo(int priority) const = 0;
  virtual std::optional<Coalescing> coalescing(const std::string& interface) const = 0;  ///< nullopt: not told
  virtual std::vector<std::string> addresses(const std::string& interface) const = 0;    ///< IPv4 and IPv6, as text
  virtual std::optional<CanLink> can_link(const std::string& interface, int& error) const = 0;  ///< nullopt: error
  virtual std::string resolved(const std::string& device) const = 0;  ///< /dev/... without links; empty: it isn't there
  virtual bool may_use(const std::string& device) const = 0;          ///< this user may read and write it
  virtual ClockReading clock() const = 0;
  virtual DiskSpace disk_space(const std::string& folder) const = 0;
  virtual WriteSpeed write_speed(const std::string& folder) const = 0;      ///< of a file that is synced and removed
  virtual std::string multicast_problem(const std::string& url) const = 0;  ///< of an LCM address; empty: none
};

}  // namespace pmg::doctor
