// A serial line of Linux, as bytes without any meaning of the terminal's.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace pmg::imu {

class SerialPort {
 public:
  /// Throws std::runtime_error, one line: no such device, no permission, in use, not a serial line, or a rate that it
  /// doesn't have. Nobody else can open it from then on.
  SerialPort(const std::string& device, int baud);
  ~SerialPort();
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  /// Neither waits. 0: nothing there, or the line is dead.
  std::size_t read(std::span<std::uint8_t> bytes) noexcept;
  bool write(std::span<const std::uint8_t> bytes) noexcept;  ///< false: not all of it

 private:
  int descriptor_ = -1;
};

}  // namespace pmg::imu
