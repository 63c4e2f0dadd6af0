// The kernel's preemption, and what it grants to real-time threads.
#include <fmt/format.h>

#include <charconv>
#include <cstring>
#include <sstream>
#include <string_view>

#include "doctor/checks.hpp"

namespace pmg::doctor {

namespace {

constexpr unsigned kCapIpcLock = 14, kCapSysNice = 23;  // <linux/capability.h>

constexpr const char* kLimitsFile =
    "write into /etc/security/limits.d/pmg.conf, and log in again: `{} - {} {}` (or run as root)";

/// How kernel code lets a real-time thread in: "rt", "full", "lazy", "voluntary", "none"; empty: not told.
std::string preemption(const Host& host) {
  const std::string version = host.text("proc/version").value_or("");
  if (host.text("sys/kernel/realtime") == "1" || version.find("PREEMPT_RT") != std::string::npos) return "rt";
  if (const auto modes = host.text("sys/kernel/debug/sched/preempt")) {
    const std::size_t open = modes->find('('), close = modes->find(')');  // "none voluntary (full) lazy"
    if (open != std::string::npos && close > open) return modes->substr(open + 1, close - open - 1);
  }
  std::istringstream words(host.text("proc/cmdline").value_or(""));
  for (std::string word; words >> word;) {
    if (word.starts_with("preempt=")) return word.substr(std::strlen("preempt="));
  }
  if (version.find("PREEMPT_DYNAMIC") != std::string::npos) return "";
  if (version.find("PREEMPT") != std::string::npos) return "full";
  return version.empty() ? "" : "none";
}

/// The soft limit that stands in /proc/self/limits; nullopt: unlimited.
std::optional<std::uint64_t> soft_limit(const Host& host, std::string_view name) {
  std::istringstream lines(host.text("proc/self/limits").value_or(""));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(name)) continue;
    std::istringstream columns(line.substr(name.size()));
    std::string soft;
    columns >> soft;
    if (soft == "unlimited") return std::nullopt;
    std::uint64_t value = 0;
    std::from_chars(soft.data(), soft.data() + soft.size(), value);
    return value;
  }
  return 0;
}

bool has_capability(const Host& host, unsigned capability) {
  const std::string status = host.text("proc/self/status").value_or("");
  constexpr std::string_view kKey = "CapEff:\t";
  const std::size_t at = status.find(kKey);
  std::uint64_t mask = 0;
  if (at == std::string::npos) return false;
  std::from_chars(status.data() + at + kKey.size(), status.data() + status.size(), mask, 16);
  return (mask >> capability & 1U) != 0;
}

Finding priority_finding(const Host& host, int priority) {
  const std::string check = "real-time priority";
  const auto limit = soft_limit(host, "Max realtime priority");
  const bool capable = has_capability(host, kCapSysNice);
  if (!capable && limit && *limit < static_cast<std::uint64_t>(priority)) {
    return fail(check,
                fmt::format("RLIMIT_RTPRIO is {} and CAP_SYS_NICE is missing; expected {} or more", *limit, priority),
                fmt::format(fmt::runtime(kLimitsFile), "USER", "rtprio", 90));
  }
  if (const int error = host.try_fifo(priority); error != 0) {
    return fail(check, fmt::format("SCHED_FIFO with priority {} is refused: {}", priority, std::strerror(error)),
                "give the container or control group CAP_SYS_NICE and a real-time budget (cpu.rt_runtime_us)");
  }
  return ok(check, fmt::format("SCHED_FIFO with priority {} is granted", priority));
}

Finding memory_finding(const Host& host) {
  const auto limit = soft_limit(host, "Max locked memory");
  if (has_capability(host, kCapIpcLock) || !limit) return ok("locked memory", "all memory may be locked");
  return fail("locked memory",
              fmt::format("RLIMIT_MEMLOCK is {} kB and CAP_IPC_LOCK is missing; expected no limit", *limit / 1024),
              fmt::format(fmt::runtime(kLimitsFile), "USER", "memlock", "unlimited"));
}

Finding throttling_finding(const Host& host) {
  const std::string check = "real-time throttling", mend = "sysctl -w kernel.sched_rt_runtime_us=950000";
  const auto number = [&host](const char* path) -> std::optional<long> {
    const auto text = host.text(path);
    long value = 0;
    if (!text || std::from_chars(text->data(), text->data() + text->size(), value).ec != std::errc())
      return std::nullopt;
    return value;
  };
  const auto runtime_us = number("proc/sys/kernel/sched_rt_runtime_us");
  const long period_us = number("proc/sys/kernel/sched_rt_period_us").value_or(1'000'000);
  if (!runtime_us)
    return warn(check, "/proc/sys/kernel/sched_rt_runtime_us can't be read", "mount /proc, or ask as root");
  if (*runtime_us == 0) return fail(check, "kernel.sched_rt_runtime_us is 0: no real-time thread ever runs", mend);
  const double share =
      *runtime_us < 0 || period_us <= 0 ? 1.0 : static_cast<double>(*runtime_us) / static_cast<double>(period_us);
  const std::string found = fmt::format("real-time threads may have {:.0f} % of a CPU", 100.0 * share);
  // The bus thread waits most of its cycle; the kernel's own 95 % leave both threads room, half of it need not.
  return share >= 0.9 ? ok(check, found) : warn(check, found + "; expected 90 % or more", mend);
}

}  // namespace

Findings check_kernel(const Host& host) {
  const std::string check = "kernel", mode = preemption(host);
  const std::string rt = "install a kernel with PREEMPT_RT (Debian: apt install linux-image-rt-amd64) and reboot";
  if (mode == "rt") return {ok(check, "PREEMPT_RT")};
  if (mode == "none") {
    return {fail(check, "no preemption: kernel code delays a bus cycle by many milliseconds",
                 rt + "; or boot with preempt=full on the kernel's command line")};
  }
  if (mode == "full")
    return {warn(check, "preemptible, but not PREEMPT_RT: drivers delay a bus cycle now and then", rt)};
  return {warn(check,
               (mode.empty() ? "its preemption isn't told" : "preemption is " + mode) + ", and it isn't PREEMPT_RT",
               rt + "; or boot with preempt=full on the kernel's command line")};
}

Findings check_realtime_rights(const Host& host, int priority) {
  return {priority_finding(host, priority), memory_finding(host), throttling_finding(host)};
}

}  // namespace pmg::doctor
