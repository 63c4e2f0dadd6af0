// The serial line of an IMU.
#include <fmt/format.h>

#include "doctor/checks.hpp"

namespace pmg::doctor {

Findings check_serial_imu(const Host& host, const model::SerialImuModel& imu) {
  const std::string check = "IMU line", device = host.resolved(imu.device);
  if (device.empty())
    return {fail(check, fmt::format("there is no {}", imu.device),
                 "plug the IMU in, or correct `imu.serial.device` in robot.yaml (ls /dev/serial/by-id)")};
  if (!host.may_use(imu.device))
    return {fail(check, fmt::format("this user may not use {}", device),
                 "as root: usermod -aG dialout USER; then log in again")};
  Findings findings = {ok(check, device == imu.device ? device : fmt::format("{} ({})", imu.device, device))};
  const std::string file =
      fmt::format("sys/bus/usb-serial/devices/{}/latency_timer", device.substr(device.rfind('/') + 1));
  const auto latency_ms = host.text(file);
  const std::string also = "IMU line latency";
  if (!latency_ms) {
    findings.push_back(ok(also, "no USB adapter"));
  } else if (*latency_ms == "1" || *latency_ms == "0") {
    findings.push_back(ok(also, *latency_ms + " ms"));
  } else {
    findings.push_back(
        warn(also, fmt::format("the adapter may hold bytes for {} ms, and after 10 ms the IMU is late", *latency_ms),
             fmt::format("as root: echo 1 > /{} (pmg_controller asks the driver for it, too)", file)));
  }
  return findings;
}

}  // namespace pmg::doctor
