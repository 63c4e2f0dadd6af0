#include "doctor/linux_host.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <linux/ethtool.h>
#include <linux/sockios.h>
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/statvfs.h>
#include <sys/timex.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <exception>
#include <fstream>
#include <iterator>
#include <limits>
#include <thread>
#include <vector>

#include "io/lcm_url.hpp"

namespace pmg::doctor {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestText = 1 << 20;    // /proc/interrupts of a computer with 100 CPUs has half of that
constexpr std::size_t kWritten_bytes = 8 << 20;  // half of what a fault's log has; a slow eMMC needs a second
constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr std::int64_t kCloseReadings_ns = 100'000;  // a hundredth of the jump that counts
constexpr int kClockTries = 50;

std::int64_t now_ns(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return now.tv_sec * kNanosecondsPerSecond + now.tv_nsec;
}

fs::path nearest_folder(fs::path folder) {
  std::error_code error;
  folder = fs::absolute(folder, error);
  while (!fs::is_directory(folder, error) && folder != folder.parent_path()) folder = folder.parent_path();
  return folder;
}

}  // namespace

std::optional<std::string> LinuxHost::text(const std::string& path) const {
  std::error_code error;
  if (!fs::is_regular_file(root_ / path, error)) return std::nullopt;
  std::ifstream file(root_ / path, std::ios::binary);
  std::string text(kLargestText, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!file.is_open() || file.bad() || (file.gcount() == 0 && !file.eof())) return std::nullopt;
  text.resize(static_cast<std::size_t>(file.gcount()));
  while (text.ends_with('\n')) text.pop_back();
  return text;
}

std::vector<std::string> LinuxHost::names(const std::string& folder) const {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(root_ / folder, error), end; !error && entry != end; entry.increment(error)) {
    names.push_back(entry->path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

int LinuxHost::try_fifo(int priority) const {
  int error = 0;
  std::thread([&error, priority] {
    const sched_param parameters{.sched_priority = priority};
    if (sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters) != 0) error = errno;
  }).join();
  return error;
}

std::optional<Coalescing> LinuxHost::coalescing(const std::string& interface) const {
  ifreq ask{};
  if (interface.size() >= sizeof ask.ifr_name) return std::nullopt;
  std::memcpy(static_cast<char*>(ask.ifr_name), interface.data(), interface.size());
  ethtool_coalesce answer{};
  answer.cmd = ETHTOOL_GCOALESCE;
  ask.ifr_data = reinterpret_cast<char*>(&answer);
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return std::nullopt;
  const bool told = ioctl(socket, SIOCETHTOOL, &ask) == 0;
  ::close(socket);
  if (!told) return std::nullopt;
  return Coalescing{.receive_us = answer.rx_coalesce_usecs, .adaptive = answer.use_adaptive_rx_coalesce != 0};
}

std::vector<std::string> LinuxHost::addresses(const std::string& interface) const {
  std::vector<std::string> found;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return found;
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    if (entry->ifa_addr == nullptr || interface != entry->ifa_name) continue;
    std::array<char, INET6_ADDRSTRLEN> text{};
    const int family = entry->ifa_addr->sa_family;
    const void* address = nullptr;
    if (family == AF_INET) address = &reinterpret_cast<const sockaddr_in*>(entry->ifa_addr)->sin_addr;
    if (family == AF_INET6) address = &reinterpret_cast<const sockaddr_in6*>(entry->ifa_addr)->sin6_addr;
    if (address != nullptr && inet_ntop(family, address, text.data(), text.size()) != nullptr)
      found.emplace_back(text.data());
  }
  freeifaddrs(list);
  return found;
}

std::optional<CanLink> LinuxHost::can_link(const std::string& interface, int& error) const {
  return ask_can_link(interface, error);
}

std::string LinuxHost::resolved(const std::string& device) const {
  std::error_code error;
  const fs::path found = fs::canonical(device, error);
  return error ? std::string() : found.string();
}

bool LinuxHost::may_use(const std::string& device) const { return ::access(device.c_str(), R_OK | W_OK) == 0; }

ClockReading LinuxHost::clock() const {
  timex state{};
  const int kernel = adjtimex(&state);
  ClockReading reading;
  // A process that loses its CPU between two of the three readings would see a jump that no clock made: of several
  // tries the closest counts.
  std::int64_t closest_ns = std::numeric_limits<std::int64_t>::max();
  for (int left = kClockTries; left > 0 && closest_ns > kCloseReadings_ns; --left) {
    const std::int64_t before_ns = now_ns(CLOCK_MONOTONIC), realtime_ns = now_ns(CLOCK_REALTIME),
                       apart_ns = now_ns(CLOCK_MONOTONIC) - before_ns;
    if (apart_ns >= closest_ns) continue;
    closest_ns = apart_ns;
    reading.realtime_ns = realtime_ns;
    reading.monotonic_ns = before_ns + apart_ns / 2;
  }
  reading.synchronised = kernel >= 0 && kernel != TIME_ERROR && (state.status & STA_UNSYNC) == 0;
  return reading;
}

DiskSpace LinuxHost::disk_space(const std::string& folder) const {
  const fs::path nearest = nearest_folder(folder);
  struct statvfs state {};
  if (statvfs(nearest.c_str(), &state) != 0) return {.free_bytes = 0, .folder = nearest.string()};
  return {.free_bytes = std::uint64_t{state.f_bavail} * state.f_frsize, .folder = nearest.string()};
}

WriteSpeed LinuxHost::write_speed(const std::string& folder) const {
  std::string path = (nearest_folder(folder) / ".pmg_doctor_XXXXXX").string();
  const int file = mkostemp(path.data(), O_CLOEXEC);
  if (file < 0) return {.problem = std::strerror(errno)};
  ::unlink(path.c_str());  // so that nothing remains, however this program ends
  const std::vector<char> block(1 << 20, 'p');
  const auto start = std::chrono::steady_clock::now();
  WriteSpeed speed;
  for (std::size_t written = 0; written < kWritten_bytes && speed.problem.empty(); written += block.size()) {
    if (::write(file, block.data(), block.size()) != static_cast<ssize_t>(block.size()))
      speed.problem = errno == 0 ? "a write was cut short" : std::strerror(errno);
  }
  if (speed.problem.empty() && fdatasync(file) != 0) speed.problem = std::strerror(errno);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  ::close(file);
  speed.bytes_per_s = static_cast<double>(kWritten_bytes) / std::max(took.count(), 1e-6);
  return speed;
}

std::string LinuxHost::multicast_problem(const std::string& url) const {
  try {
    io::checked_lcm_url(url);
    return {};
  } catch (const std::exception& error) {
    return error.what();
  }
}

}  // namespace pmg::doctor
