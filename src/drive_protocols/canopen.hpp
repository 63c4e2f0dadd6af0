// Messages of CANopen (CiA 301): identifiers, network management, SYNC, heartbeat, emergencies, expedited SDO
// transfers.
#pragma once

#include <cstdint>
#include <optional>

#include "drive_protocols/cia402_objects.hpp"
#include "drives/message.hpp"

namespace pmg::drives::canopen {

/// This computer's node number, which its heartbeat carries.
inline constexpr std::uint32_t kHostNode = 127;

/// An identifier is one of these plus a node number (the predefined connection set).
enum Function : std::uint32_t {
  kNetworkManagement = 0x000,
  kSync = 0x080,  ///< without a node number; with one: an emergency
  kEmergency = 0x080,
  kTransmit1 = 0x180,  ///< TPDO1: status word, position, torque
  kReceive1 = 0x200,   ///< RPDO1: control word, target position, target torque
  kTransmit2 = 0x280,  ///< TPDO2: velocity, error code, temperature if robot.yaml has its object
  kSdoAnswer = 0x580,
  kSdoRequest = 0x600,
  kHeartbeat = 0x700,
};
inline constexpr std::uint32_t kNodeBits = 0x7F;

/// The time without this computer's heartbeat after which the drives stop by themselves [ms], and the bus cycles
/// between two heartbeats: three may be lost.
inline constexpr std::uint32_t kHeartbeatTimeout_ms = 30;
inline constexpr int kHeartbeatCycles = 4;

enum class NodeCommand : std::uint8_t { kStart = 0x01, kStop = 0x02, kPreOperational = 0x80, kResetNode = 0x81 };
inline constexpr std::uint8_t kBootUp = 0x00, kOperational = 0x05;  // states in a heartbeat

/// The node whose message of the bus cycle this is: TPDO1, TPDO2, an emergency or a heartbeat.
std::optional<int> sender(const Message& message) noexcept;

Message node_command(NodeCommand command, int node) noexcept;
Message sync() noexcept;
Message heartbeat() noexcept;  ///< this computer's, operational

/// An SDO answer, as its request's sender needs it.
struct SdoAnswer {
  ObjectId id;  ///< bytes: of an upload's value
  bool aborted = false, upload = false;
  bool expedited = true;    ///< false: a segmented transfer, of more than 4 bytes
  std::uint32_t value = 0;  ///< of an upload; the abort code if aborted
};
inline constexpr std::uint32_t kAbortNoObject = 0x06020000, kAbortNoSubindex = 0x06090011;

Message sdo_read(int node, const ObjectId& id) noexcept;
Message sdo_write(int node, const ObjectId& id, std::uint32_t value) noexcept;
/// Nullopt: not 8 bytes, or no answer to a read or write.
std::optional<SdoAnswer> sdo_answer(const Message& message) noexcept;

Message targets_frame(int node, const Cia402Targets& targets) noexcept;  ///< RPDO1
/// Take a TPDO's values into inputs. False: another length.
bool take_transmit1(const Message& message, Cia402Inputs& inputs) noexcept;
bool take_transmit2(const Message& message, Cia402Inputs& inputs) noexcept;

}  // namespace pmg::drives::canopen
