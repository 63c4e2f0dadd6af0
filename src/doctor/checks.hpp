// What the doctor looks at. Each function: (host, what is wanted) => one finding for each thing that it looked at.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "can/bus_setup.hpp"
#include "control/control_setup.hpp"
#include "doctor/can_link.hpp"
#include "doctor/finding.hpp"
#include "doctor/host.hpp"

namespace pmg::doctor {

/// The limits that the doctor judges by.
struct Limits {
  /// CiA 301 recommends 87.5 % up to 500 kbit/s, 80 % up to 800 kbit/s, 75 % above; so does the kernel. A controller
  /// with 20 time quanta a bit sets a sample point in steps of 5 %, so that is no difference.
  double sample_point_step = 0.05;
  /// The bus thread waits 500 us for answers. A card that holds frames for a tenth of that costs part of it, one that
  /// holds them for half makes answers late.
  std::uint32_t coalescing_warn_us = 50, coalescing_fail_us = 250;
  double clock_jump_s = 0.01;                ///< one control tick: a log's stamps are in order within that
  std::int64_t oldest_year = 2024;           ///< the project is younger: a clock before that was never set
  double log_bytes_per_s = 0.45e6;           ///< 256 MiB in ten minutes with 31 joints (recording/recorder.hpp)
  double slow_disk = 2.0, fast_disk = 20.0;  ///< times that: below the first ticks are lost; above the second a fault's
                                             ///< 31 s are written within 2 s
  std::uint64_t least_free_bytes = (256 + 64) << 20;  ///< one log file and the recorder's spare room
  std::uint64_t full_log_bytes = std::uint64_t{8 * 256 + 16 * 14 + 64} << 20;  ///< all files that a log folder may have
};

/// CPUs of the two real-time threads; -1: any.
struct RealtimeCpus {
  int bus = -1, control = -1;
};

Findings check_kernel(const Host& host);
/// Priority, locked memory, and the share of a CPU that real-time threads may have. priority: the highest that is asked
/// for.
Findings check_realtime_rights(const Host& host, int priority);
/// CPUs without other work, and their frequency.
Findings check_cpus(const Host& host, const RealtimeCpus& cpus);

/// A card that EtherCAT has for itself: up, linked, without address, prompt, its interrupts away from the control
/// thread.
Findings check_card(const Host& host, const std::string& interface, const RealtimeCpus& cpus, const Limits& limits);
/// The bit rates of an interface whose kind is "can".
Finding bitrate_finding(const can::BusSetup& bus, const CanLink& link);
Findings check_can_bus(const Host& host, const can::BusSetup& bus, const Limits& limits);

/// The line of an IMU of its own.
Findings check_serial_imu(const Host& host, const model::SerialImuModel& imu);

/// cards: interfaces that must not carry messages.
Findings check_multicast(const Host& host, const std::string& lcm_url, const std::vector<std::string>& cards);
/// As load_controller_seal takes them.
Findings check_keys(const std::string& folder, const std::string& lcm_url, bool insecure);

/// began, now: readings at the beginning and the end of an examination.
Findings check_clock(const Host& host, const ClockReading& began, const ClockReading& now, const Limits& limits);
Findings check_disk(const Host& host, const std::filesystem::path& log, const Limits& limits);

/// robot.yaml and URDF, drives, clips, policy, bundle. bundle: the first digits of the one that is expected; empty:
/// any.
Findings check_robot_files(const control::ControlSetup& setup, const std::string& bundle, bool drives);

/// What one drive said when asked for its firmware.
struct DriveAnswer {
  std::string motor;                      ///< "left_knee (can0, node 4)"
  std::string kind;                       ///< its entry in robot.yaml's `drives`
  std::optional<std::uint32_t> revision;  ///< CiA 301's object 0x1018:3; nullopt: its protocol has no such question
  std::string problem;                    ///< why it didn't say; empty: it did, or can't
};
/// Drives of one kind are to have one firmware. Nullopt: nobody was asked.
Findings check_firmware(const std::optional<std::vector<DriveAnswer>>& answers);

}  // namespace pmg::doctor
