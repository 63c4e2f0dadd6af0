// The objects of a CiA 402 drive: which values prove that robot.yaml describes it, and which it is set to before it is
// switched on. CANopen's SDO and EtherCAT's CoE reach the same objects.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drive_protocols/cia402.hpp"

namespace pmg::drives {

/// Address and type of an object.
struct ObjectId {
  std::uint16_t index = 0;
  std::uint8_t subindex = 0;
  std::uint8_t bytes = 4;  ///< 1, 2 or 4
  bool operator==(const ObjectId&) const = default;
};

namespace object {
inline constexpr ObjectId kDeviceType{0x1000, 0, 4}, kVendor{0x1018, 1, 4}, kProduct{0x1018, 2, 4};
inline constexpr ObjectId kErrorCode{0x603F, 0, 2}, kControlWord{0x6040, 0, 2}, kStatusWord{0x6041, 0, 2};
inline constexpr ObjectId kMode{0x6060, 0, 1}, kModeShown{0x6061, 0, 1}, kSupportedModes{0x6502, 0, 4};
inline constexpr ObjectId kPosition{0x6064, 0, 4}, kVelocity{0x606C, 0, 4}, kTorque{0x6077, 0, 2};
inline constexpr ObjectId kTargetPosition{0x607A, 0, 4}, kTargetTorque{0x6071, 0, 2};
inline constexpr ObjectId kRatedTorque{0x6076, 0, 4}, kMostTorque{0x6072, 0, 2};
inline constexpr ObjectId kEncoderCounts{0x608F, 1, 4}, kEncoderTurns{0x608F, 2, 4};
inline constexpr ObjectId kGearMotorTurns{0x6091, 1, 4}, kGearShaftTurns{0x6091, 2, 4};
inline constexpr ObjectId kVelocityUnit{0x60A9, 0, 4};
inline constexpr ObjectId kAbortOption{0x6007, 0, 2}, kQuickStopOption{0x605A, 0, 2};
inline constexpr ObjectId kCycleValue{0x60C2, 1, 1}, kCycleExponent{0x60C2, 2, 1};
}  // namespace object

/// "0x608F:1"
std::string to_string(const ObjectId& id);

/// A way to a drive's objects. Both throw std::runtime_error, one line without the motor's name, when nobody answers or
/// the drive refuses; read and write of an object that the drive doesn't have give nullopt and false.
class ObjectDictionary {
 public:
  virtual ~ObjectDictionary() = default;
  virtual std::optional<std::uint32_t> read(const ObjectId& id) = 0;
  virtual bool write(const ObjectId& id, std::uint32_t value) = 0;
};

/// Reads what robot.yaml claims of the drive: device type, identity, mode, rated torque, counts per turn, gear, unit of
/// the velocity. Throws std::runtime_error with object and both values at the first difference.
void check_drive(ObjectDictionary& dictionary, const Cia402Settings& settings);

/// Switches the drive off and sets its mode, largest torque, cycle time, and what it does when the bus falls silent: a
/// quick stop along its ramp, then off. Throws std::runtime_error when an object that must be there can't be set, or
/// reads another value afterwards.
void set_up_drive(ObjectDictionary& dictionary, const Cia402Settings& settings, const MotorLimits& limits);

/// What a drive that is off says of itself.
MotorReading read_drive(ObjectDictionary& dictionary, const Cia402Settings& settings);

}  // namespace pmg::drives
