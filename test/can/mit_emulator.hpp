// A drive of the MIT protocol, in the dialect of its kind.
#pragma once

#include <algorithm>

#include "can/drive_emulator.hpp"
#include "drive_protocols/mit_drive.hpp"
#include "drive_protocols/mit_protocol.hpp"

namespace pmg::test {

class MitEmulator final : public DriveEmulator {
 public:
  explicit MitEmulator(const drives::MotorSetup& setup) : DriveEmulator(setup), type_(drives::as_mit(setup.drive)) {}

  int hear(const drives::Message& frame, Replies& replies) noexcept override {
    if (silent || frame.extended || frame.id != static_cast<std::uint32_t>(setup().node) || frame.length != 8) return 0;
    silent_cycles_ = 0;
    ++heard;
    drives::MitFrame bytes{};
    std::copy_n(frame.data.begin(), 8, bytes.begin());
    if (bytes == drives::kMitEnable) {
      enabled_ = fault == drives::DriveFault::kNone;
      tripped_ = false;
      command_ = {};
    } else if (bytes == drives::kMitDisable) {
      enabled_ = false;
    } else if (type_->clearing() != nullptr && bytes == *type_->clearing()) {
      if (fault_passed) fault = drives::DriveFault::kNone;
    } else if (bytes == drives::kMitZero) {
      set_zero();
    } else if (enabled_) {
      command_ = *type_->codec().command(bytes);
    }
    replies[0] = reply(shown(), frame.fd);
    if (!twice) return 1;
    drives::MotorReading second = shown();
    second.q_rad += 0.01;
    replies[1] = reply(second, frame.fd);
    return 2;
  }

  void tick() noexcept override {
    if (++silent_cycles_ <= patience * kWatchdogCycles || !enabled_) return;
    enabled_ = false;
    tripped_ = true;
    if (type_->clearing() == nullptr) return;
    fault = drives::DriveFault::kCommunication;  // such drives keep it as a fault
    fault_passed = true;
  }

  bool enabled() const noexcept override { return enabled_; }
  bool tripped() const noexcept override { return tripped_; }

 private:
  drives::MotorCommand told() const noexcept override {
    if (tripped_) return {.kd_Nm_s_per_rad = kBrake_Nm_s_per_rad};
    return enabled_ && fault == drives::DriveFault::kNone ? command_ : drives::MotorCommand{};
  }
  drives::Message reply(drives::MotorReading reading, bool fd) const noexcept {
    reading.follows = enabled_ ? drives::Follows::kYes : drives::Follows::kNo;
    drives::Message frame = type_->reply({type_->named(node), reading});
    frame.fd = fd;
    return frame;
  }

  const drives::MitDrive* type_;
  drives::MotorCommand command_;
  bool enabled_ = false, tripped_ = false;
  int silent_cycles_ = 0;
};

}  // namespace pmg::test
