// Drives of the profile CiA 402 over CANopen as a kind: PDOs in the bus cycle, asked by SYNC.
#pragma once

#include "drive_protocols/cia402.hpp"
#include "drives/drive_type.hpp"

namespace pmg::drives {

class CanopenDrive final : public DriveType {
 public:
  explicit CanopenDrive(const Cia402Settings& settings) noexcept : settings_(settings) {}
  const Cia402Settings& settings() const noexcept { return settings_; }

  std::unique_ptr<Network> network() const override;
  std::unique_ptr<Protocol> protocol(int node, const MotorLimits& limits, bool fd) const override;
  void check_covers(const DriveNeeds& needs, const std::string& joint, const std::string& drive,
                    const files::ConfigReader& reader) const override;
  std::vector<MotorId> ids(int node) const override;
  std::optional<int> sender(const Message& message) const noexcept override;
  int messages_a_cycle() const noexcept override { return 3; }  // RPDO1, TPDO1, TPDO2
  LoopPlace loop() const noexcept override {
    return settings_.mode == Cia402Mode::kTorque ? LoopPlace::kBusThread : LoopPlace::kOwnGains;
  }
  bool tells_temperature() const noexcept override { return settings_.temperature_index != 0; }
  double torque_step_Nm() const noexcept override { return 1e-3 * settings_.rated_torque_Nm; }

 private:
  Cia402Settings settings_;
};

/// Reads an entry with `protocol: cia402`. Throws files::ConfigError.
Cia402Settings read_cia402(files::ConfigReader& reader);
DriveKind cia402_drive(const Cia402Settings& settings);
/// Null: not a CiA 402 drive.
const Cia402Settings* as_cia402(const DriveKind& kind) noexcept;

}  // namespace pmg::drives
