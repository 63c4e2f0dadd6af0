// Clocks, and the disk of the log.
#include <fmt/format.h>

#include <cmath>
#include <ctime>

#include "doctor/checks.hpp"

namespace pmg::doctor {

namespace {

constexpr double kMega = 1e6;

int year_of(std::int64_t realtime_ns) {
  const std::time_t seconds = realtime_ns / 1'000'000'000;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  return utc.tm_year + 1900;
}

Finding source_finding(const Host& host) {
  const std::string check = "clock source";
  const std::string source = host.text("sys/devices/system/clocksource/clocksource0/current_clocksource").value_or("");
  const std::string remedy =
      "boot with tsc=reliable on the kernel's command line, if the CPU's time stamp counter is sound";
  if (source == "jiffies") return fail(check, "jiffies: time goes in steps of milliseconds", remedy);
  if (source == "hpet" || source == "acpi_pm")
    return warn(check, source + ": each reading of the clock costs microseconds; expected tsc", remedy);
  return source.empty() ? warn(check, "isn't told", "mount /sys") : ok(check, source);
}

Finding set_finding(const ClockReading& now, const Limits& limits) {
  const std::string check = "clock set",
                    remedy = "set it, and keep it set: timedatectl set-ntp true (or chrony, or PTP)";
  const int year = year_of(now.realtime_ns);
  if (year < limits.oldest_year)
    return fail(check, fmt::format("it is the year {} here: logs get wrong names and stamps", year), remedy);
  if (!now.synchronised)
    return warn(check, "nothing synchronises it: this computer's logs can't be laid beside another's", remedy);
  return ok(check, "synchronised");
}

/// change of (realtime - monotonic)
Finding jump_finding(const ClockReading& began, const ClockReading& now, const Limits& limits) {
  const double jump_s =
      1e-9 * static_cast<double>((now.realtime_ns - began.realtime_ns) - (now.monotonic_ns - began.monotonic_ns));
  const std::string check = "clock jumps";
  if (std::abs(jump_s) > limits.clock_jump_s) {
    return fail(check, fmt::format("it jumped by {:+.3f} s while the doctor looked: logs' stamps would, too", jump_s),
                "let one program alone set it, and by slewing (chrony: no makestep after the start), then try again");
  }
  return ok(check, "none while the doctor looked");
}

}  // namespace

Findings check_clock(const Host& host, const ClockReading& began, const ClockReading& now, const Limits& limits) {
  return {source_finding(host), set_finding(now, limits), jump_finding(began, now, limits)};
}

Findings check_disk(const Host& host, const std::filesystem::path& log, const Limits& limits) {
  const std::string remedy = "remove old logs, or name another disk: pmg_controller --log FOLDER";
  const DiskSpace space = host.disk_space(log.string());
  const double free_MB = static_cast<double>(space.free_bytes) / kMega;
  const std::string found = fmt::format("{:.0f} MB free in {}", free_MB, space.folder);
  Findings findings;
  if (space.free_bytes < limits.least_free_bytes) {
    findings.push_back(fail(
        "disk space",
        found + fmt::format("; a log needs {:.0f} MB", static_cast<double>(limits.least_free_bytes) / kMega), remedy));
  } else if (space.free_bytes < limits.full_log_bytes) {
    findings.push_back(warn(
        "disk space",
        found + fmt::format("; a full log folder has {:.0f} MB", static_cast<double>(limits.full_log_bytes) / kMega),
        remedy));
  } else {
    findings.push_back(ok("disk space", found));
  }
  const WriteSpeed speed = host.write_speed(log.string());
  const double ratio = speed.bytes_per_s / limits.log_bytes_per_s;
  const std::string fast = fmt::format("{:.1f} MB/s", speed.bytes_per_s / kMega);
  if (!speed.problem.empty()) {
    findings.push_back(fail("disk speed", fmt::format("{} can't be written: {}", space.folder, speed.problem),
                            "give the folder to the user that runs pmg_controller, or name another: --log FOLDER"));
  } else if (ratio < limits.slow_disk) {
    findings.push_back(fail(
        "disk speed",
        fast + fmt::format("; a log needs {:.1f} MB/s", limits.slow_disk * limits.log_bytes_per_s / kMega), remedy));
  } else if (ratio < limits.fast_disk) {
    findings.push_back(warn("disk speed",
                            fast + fmt::format("; below {:.0f} MB/s the seconds around a fault are written slowly",
                                               limits.fast_disk * limits.log_bytes_per_s / kMega),
                            remedy));
  } else {
    findings.push_back(ok("disk speed", fast));
  }
  return findings;
}

}  // namespace pmg::doctor
