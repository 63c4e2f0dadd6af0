#include "imu/serial_port.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/serial.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace pmg::imu {

namespace {

constexpr std::array<std::pair<int, speed_t>, 8> kSpeeds = {{{57600, B57600},
                                                             {115200, B115200},
                                                             {230400, B230400},
                                                             {460800, B460800},
                                                             {921600, B921600},
                                                             {2000000, B2000000},
                                                             {3500000, B3500000},
                                                             {4000000, B4000000}}};

std::string advice(int error) {
  if (error == ENOENT || error == ENXIO || error == ENODEV)
    return "expected the IMU's serial line (ls /dev/serial/by-id)";
  if (error == EACCES || error == EPERM)
    return "expected a user of the group dialout (usermod -aG dialout USER, and log in again)";
  if (error == EBUSY) return "expected a line that no other program has open";
  return "expected a serial line";
}

[[noreturn]] void refuse(const std::string& device, int error) {
  throw std::runtime_error(fmt::format("IMU on {}: {}; {}", device, std::strerror(error), advice(error)));
}

/// Returns the number of an error; 0: none.
int make_raw(int descriptor, speed_t speed) {
  termios line{};
  if (tcgetattr(descriptor, &line) != 0) return errno;
  cfmakeraw(&line);
  line.c_cflag |= CLOCAL | CREAD;
  line.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS | CSTOPB);
  line.c_cc[VMIN] = 0;
  line.c_cc[VTIME] = 0;
  if (cfsetspeed(&line, speed) != 0 || tcsetattr(descriptor, TCSANOW, &line) != 0) return errno;
  termios now{};
  if (tcgetattr(descriptor, &now) != 0) return errno;
  return cfgetispeed(&now) == speed ? 0 : EINVAL;
}

/// USB adapters collect bytes for 16 ms unless they are told not to. Lines that can't be told have no such delay.
void ask_for_low_latency(int descriptor) {
  serial_struct settings{};
  if (ioctl(descriptor, TIOCGSERIAL, &settings) != 0) return;
  settings.flags |= ASYNC_LOW_LATENCY;
  ioctl(descriptor, TIOCSSERIAL, &settings);
}

}  // namespace

SerialPort::SerialPort(const std::string& device, int baud) {
  const auto* const speed = std::ranges::find(kSpeeds, baud, &std::pair<int, speed_t>::first);
  if (speed == kSpeeds.end())
    throw std::invalid_argument(fmt::format("IMU on {}: {} baud isn't a rate of serial lines", device, baud));
  descriptor_ = ::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0) refuse(device, errno);
  int error = ioctl(descriptor_, TIOCEXCL) == 0 ? 0 : errno;
  if (error == 0) error = make_raw(descriptor_, speed->second);
  if (error != 0) {
    ::close(descriptor_);
    refuse(device, error);
  }
  ask_for_low_latency(descriptor_);
  tcflush(descriptor_, TCIOFLUSH);
}

SerialPort::~SerialPort() { ::close(descriptor_); }

std::size_t SerialPort::read(std::span<std::uint8_t> bytes) noexcept {
  ssize_t got = -1;
  do {
    got = ::read(descriptor_, bytes.data(), bytes.size());
  } while (got < 0 && errno == EINTR);
  return got > 0 ? static_cast<std::size_t>(got) : 0;
}

bool SerialPort::write(std::span<const std::uint8_t> bytes) noexcept {
  return ::write(descriptor_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
}

}  // namespace pmg::imu
