// An Xsens MTi behind a pseudo terminal, without a thread: it answers in step().
#pragma once

#include <fcntl.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "imu/mti_messages.hpp"

namespace pmg::test {

class MtiEmulator {
 public:
  MtiEmulator() : master_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0) throw std::runtime_error("no pseudo terminal");
    device = ptsname(master_);
    termios line{};
    tcgetattr(master_, &line);
    cfmakeraw(&line);
    tcsetattr(master_, TCSANOW, &line);
  }
  ~MtiEmulator() { ::close(master_); }
  MtiEmulator(const MtiEmulator&) = delete;
  MtiEmulator& operator=(const MtiEmulator&) = delete;

  std::string device;
  imu::MtiSample sample = at_rest();
  std::uint16_t passed = 0x1FF;       ///< result of the self-test
  bool mute = false, dumb = false;    ///< answers nothing; sends no samples
  bool refuses = false;               ///< answers a new configuration with an error
  int deaf_requests = 0;              ///< so many requests are overheard
  std::vector<std::uint8_t> outputs;  ///< the configuration that it keeps
  int configured = 0;                 ///< how often it was written
  bool measuring = true;              ///< as after power-on

  static imu::MtiSample at_rest() {
    imu::MtiSample sample;
    sample.acceleration_m_s2 = {0.0, 0.0, 9.81};
    return sample;
  }

  /// Answers what came; sends a sample.
  void step() {
    std::array<std::uint8_t, 512> heard{};
    for (ssize_t got = ::read(master_, heard.data(), heard.size()); got > 0;
         got = ::read(master_, heard.data(), heard.size())) {
      framer_.hear(imu::Bytes(heard).first(static_cast<std::size_t>(got)));
      while (const auto message = framer_.next()) answer(*message);
    }
    if (measuring && !dumb) send_sample();
  }
  void send_sample() {
    ++sample.counter;
    send(imu::mti_message(imu::MtiId::kData, imu::encode_mti_sample(sample)));
  }
  void send(const std::vector<std::uint8_t>& bytes) {
    if (::write(master_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
      throw std::runtime_error("the pseudo terminal is full");
  }

 private:
  void answer(const imu::MtiMessage& message) {
    if (mute || deaf_requests-- > 0) return;
    const auto acknowledge = [&](imu::Bytes data = {}) {
      send(imu::mti_message(static_cast<imu::MtiId>(static_cast<int>(message.id) + 1), data));
    };
    switch (message.id) {
      case imu::MtiId::kGoToConfig:
        measuring = false;
        return acknowledge();
      case imu::MtiId::kGoToMeasurement:
        measuring = true;
        return acknowledge();
      case imu::MtiId::kRunSelfTest:
        return acknowledge(
            std::array{static_cast<std::uint8_t>(passed >> 8U), static_cast<std::uint8_t>(passed & 0xFFU)});
      case imu::MtiId::kOutputConfiguration:
        if (!message.data.empty() && refuses)
          return send(imu::mti_message(imu::MtiId::kError, std::array<std::uint8_t, 1>{4}));
        if (!message.data.empty()) {
          outputs.assign(message.data.begin(), message.data.end());
          ++configured;
        }
        return acknowledge(outputs);
      default:
        return;
    }
  }

  int master_;
  imu::MtiFramer framer_;
};

}  // namespace pmg::test
