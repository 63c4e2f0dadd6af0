// A kind of drives, as an entry of robot.yaml's `drives` describes it: what its protocol can carry, and how to speak
// it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drives/motor.hpp"
#include "drives/protocol.hpp"
#include "files/config_reader.hpp"

namespace pmg::drives {

/// What a joint asks of its drive, at the drive's output shaft.
struct DriveNeeds {
  MotorLimits limits;
  MotorCommand gains;  ///< kp and kd
};

/// An identifier that a motor's messages have.
struct MotorId {
  std::uint32_t id = 0;
  const char* what = "";  ///< "commands", "replies"
  bool answer = false;    ///< the drive sends it
  const char* shared_by =
      nullptr;  ///< drives of this protocol may share it: `mark` tells them apart; null: it is alone
  int mark = 0;
};

/// Where a position loop is closed.
enum class LoopPlace : std::uint8_t {
  kDrive,      ///< in the drive, with the gains of each command
  kBusThread,  ///< in this computer, once a bus cycle
  kOwnGains,   ///< in the drive, with gains of its own
};

class DriveType;
using DriveKind = std::shared_ptr<const DriveType>;

/// Immutable; motors share it.
class DriveType {
 public:
  virtual ~DriveType() = default;

  /// One motor's way to speak. node: its number. fd: its bus has CAN FD.
  virtual std::unique_ptr<Protocol> protocol(int node, const MotorLimits& limits, bool fd) const = 0;

  /// What a bus with such a drive carries for all of them; null: nothing.
  virtual std::unique_ptr<Network> network() const { return nullptr; }

  /// Throws files::ConfigError at reader's `bus` when the drive doesn't cover these needs: a field of its messages is
  /// too short, its torque too small, or its own loop has other gains. drive: its name in `drives`.
  virtual void check_covers(const DriveNeeds& needs, const std::string& joint, const std::string& drive,
                            const files::ConfigReader& reader) const = 0;
  /// The same kind, whose replies have another identifier; null: the node gives it.
  virtual DriveKind replying_as(std::uint32_t /*id*/) const { return nullptr; }

  /// Every identifier of a motor: commands first.
  virtual std::vector<MotorId> ids(int node) const = 0;
  /// The node of the drive of this kind that sent this message; nullopt: none of this kind does.
  virtual std::optional<int> sender(const Message& message) const noexcept = 0;
  /// Messages of a motor in a cycle, both ways, at the most bytes each.
  virtual int messages_a_cycle() const noexcept { return 2; }
  virtual int most_node() const noexcept { return 127; }  ///< the largest node number
  /// Protocol::off() leaves a drive that is off as it is, and makes it answer: a node may be asked that robot.yaml
  /// doesn't have. False: nobody knows what the message does to a drive that nobody described.
  virtual bool off_is_harmless() const noexcept { return false; }

  virtual LoopPlace loop() const noexcept { return LoopPlace::kDrive; }
  virtual bool tells_temperature() const noexcept { return true; }
  virtual double torque_step_Nm() const noexcept = 0;  ///< of its torque reading
};

/// A value that a joint needs and a drive covers.
struct Cover {
  const char *field, *what;
  double needs, covers;
};
/// Throws files::ConfigError at reader's `bus` when it doesn't.
void check_cover(const Cover& cover, const std::string& joint, const std::string& drive,
                 const files::ConfigReader& reader);

}  // namespace pmg::drives
