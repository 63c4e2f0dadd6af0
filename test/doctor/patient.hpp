// A computer that a test makes ill, one thing at a time. As made, every line of the doctor is ok.
#pragma once

#include <cerrno>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "doctor/checks.hpp"

namespace pmg::test {

inline constexpr doctor::RealtimeCpus kReserved = {.bus = 2, .control = 3};

class Patient final : public doctor::Host {
 public:
  std::map<std::string, std::string> files = {
      {"sys/kernel/realtime", "1"},
      {"proc/version", "Linux version 6.12.0-rt-amd64 #1 SMP PREEMPT_RT"},
      {"proc/cmdline", "quiet"},
      {"proc/self/limits",
       "Limit                     Soft Limit           Hard Limit           Units     \n"
       "Max locked memory         unlimited            unlimited            bytes     \n"
       "Max realtime priority     90                   90                             \n"},
      {"proc/self/status", "Name:\tpmg_doctor\nCapEff:\t0000000000000000\n"},
      {"proc/sys/kernel/sched_rt_runtime_us", "950000"},
      {"proc/sys/kernel/sched_rt_period_us", "1000000"},
      {"sys/devices/system/cpu/online", "0-3"},
      {"sys/devices/system/cpu/isolated", "2-3"},
      {"sys/devices/system/cpu/nohz_full", "2-3"},
      {"sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance"},
      {"sys/devices/system/cpu/cpu3/cpufreq/scaling_governor", "performance"},
      {"proc/interrupts",
       "            CPU0       CPU1       CPU2       CPU3\n"
       "  24:          1          0          0          0   PCI-MSI   ahci\n"
       "  39:          5          0          0          0   PCI-MSI   eth1-TxRx-0\n"
       " LOC:         10         10          1          1   Local timer interrupts\n"},
      {"proc/irq/24/effective_affinity_list", "0"},
      {"proc/irq/39/effective_affinity_list", "1"},
      {"sys/class/net/eth1/flags", "0x1003"},
      {"sys/class/net/eth1/carrier", "1"},
      {"sys/class/net/can0/flags", "0x40081"},
      {"sys/class/net/can0/type", "280"},
      {"sys/class/net/can0/tx_queue_len", "64"},
      {"sys/bus/usb-serial/devices/ttyUSB0/latency_timer", "1"},
      {"sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc"},
      {"proc/net/route",
       "Iface\tDestination\tGateway \tFlags\tRefCnt\tUse\tMetric\tMask\t\tMTU\tWindow\tIRTT\n"
       "eth0\t00000000\t010200C0\t0003\t0\t0\t0\t00000000\t0\t0\t0\n"
       "lo\t000000E0\t00000000\t0001\t0\t0\t0\t000000F0\t0\t0\t0\n"},
  };
  std::map<std::string, std::vector<std::string>> folders = {{"sys/class/net", {"can0", "eth1", "lo"}}};
  int fifo_error = 0;
  std::optional<doctor::Coalescing> coalesces = doctor::Coalescing{};
  std::vector<std::string> has_addresses;
  std::optional<doctor::CanLink> can = doctor::CanLink{
      .kind = "can", .arbitration = {1'000'000, 750}, .data = {5'000'000, 750}, .state = 0, .restart_ms = 100};
  int can_error = ENODEV;
  std::string device = "/dev/ttyUSB0";
  bool usable = true;
  doctor::ClockReading now = {.realtime_ns = 1'800'000'000'000'000'000, .monotonic_ns = 1000, .synchronised = true};
  doctor::DiskSpace space = {.free_bytes = std::uint64_t{100} << 30, .folder = "/data"};
  doctor::WriteSpeed speed = {.bytes_per_s = 100e6, .problem = {}};
  std::string multicast;

  std::optional<std::string> text(const std::string& path) const override {
    const auto found = files.find(path);
    return found == files.end() ? std::nullopt : std::optional(found->second);
  }
  std::vector<std::string> names(const std::string& folder) const override {
    const auto found = folders.find(folder);
    return found == folders.end() ? std::vector<std::string>{} : found->second;
  }
  int try_fifo(int /*priority*/) const override { return fifo_error; }
  std::optional<doctor::Coalescing> coalescing(const std::string& /*interface*/) const override { return coalesces; }
  std::vector<std::string> addresses(const std::string& /*interface*/) const override { return has_addresses; }
  std::optional<doctor::CanLink> can_link(const std::string& /*interface*/, int& error) const override {
    error = can_error;
    return can;
  }
  std::string resolved(const std::string& /*device*/) const override { return device; }
  bool may_use(const std::string& /*device*/) const override { return usable; }
  doctor::ClockReading clock() const override { return now; }
  doctor::DiskSpace disk_space(const std::string& /*folder*/) const override { return space; }
  doctor::WriteSpeed write_speed(const std::string& /*folder*/) const override { return speed; }
  std::string multicast_problem(const std::string& /*url*/) const override { return multicast; }
};

}  // namespace pmg::test
