#include "can/other_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "can/bus_ids.hpp"
#include "drive_protocols/canopen.hpp"
#include "drive_protocols/mit_drive.hpp"

namespace pmg::can {

namespace {

constexpr std::uint8_t kMostFaultCode = 7;  // of the CubeMars dialect

const drives::MotorSetup* motor_of(const BusSetup& bus, int node) {
  const auto motor = std::ranges::find(bus.motors, node, &drives::MotorSetup::node);
  return motor == bus.motors.end() ? nullptr : &*motor;
}

/// A DaMiao's first byte: its state in the upper half, its node in the lower one.
const drives::MotorSetup* damiao_motor(const BusSetup& bus, std::uint8_t first) {
  const int state = first >> 4;
  return state == 1 || state >= 8 ? motor_of(bus, first & 0x0F) : nullptr;
}

/// robot.yaml's word for the motor's protocol.
std::string says(const drives::MotorSetup& motor) {
  const drives::MitDrive* mit = drives::as_mit(motor.drive);
  return mit == nullptr ? std::string("another protocol") : fmt::format("`protocol: {}`", mit->protocol_name());
}

/// "a DaMiao's answer of left_knee; robot.yaml has ..."; empty: it may be anything.
std::string guess(const BusSetup& bus, const drives::Message& frame, bool a_reply) {
  if (frame.extended)
    return "a protocol with 29-bit identifiers, as RobStride's, CyberGear's and CubeMars' servo mode have; robot.yaml "
           "has none of them";
  const std::uint32_t function = frame.id & ~drives::canopen::kNodeBits;
  if (function == drives::canopen::kHeartbeat && frame.length == 1)
    return fmt::format("a CANopen node's heartbeat, node {}; robot.yaml has no such drive here",
                       frame.id & drives::canopen::kNodeBits);
  if (frame.length == 0 || frame.length > 8) return {};
  const drives::MotorSetup* motor = motor_of(bus, frame.data[0]);
  const drives::MotorSetup* damiao = motor == nullptr ? damiao_motor(bus, frame.data[0]) : nullptr;
  if (damiao != nullptr && frame.length == 8)
    return fmt::format(
        "a DaMiao's answer of {}, whose first byte has a state besides the node; robot.yaml has {}: expected "
        "`protocol: "
        "damiao`",
        damiao->joint, says(*damiao));
  if (motor == nullptr) return {};
  if (frame.length == 6 || frame.length == 7)
    return fmt::format(
        "a Mini Cheetah's answer of {}, without a fault code; robot.yaml has {}: expected `protocol: mini_cheetah`",
        motor->joint, says(*motor));
  if (frame.length != 8) return {};
  if (!a_reply)
    return fmt::format("an answer of {} with another identifier; robot.yaml's `reply_id` should be 0x{:X}",
                       motor->joint, frame.id);
  return fmt::format(
      "a DaMiao's answer of {}, or a RobStride's: {} would be no fault code, but a temperature; robot.yaml has {}: "
      "expected `protocol: damiao` or `protocol: robstride`",
      motor->joint, frame.data[7], says(*motor));
}

}  // namespace

void OtherFrames::note(const drives::Message& frame) {
  Seen& seen = seen_[{frame.id, frame.extended, frame.fd, frame.length}];
  ++seen.count;
  seen.last = frame;
}

bool OtherFrames::heard(std::uint32_t id) const {
  return std::ranges::any_of(seen_, [id](const auto& one) {
    const auto& [seen, extended, fd, bytes] = one.first;
    return seen == id && !extended;
  });
}

std::vector<std::string> OtherFrames::lines(const BusSetup& bus) const {
  const std::vector<SentId> ids = sent_ids(bus);
  std::vector<std::string> lines;
  for (const auto& [key, seen] : seen_) {
    const drives::Message& frame = seen.last;
    const auto sent = std::ranges::find(ids, frame.id, &SentId::id);
    const bool ours = !frame.extended && sent != ids.end();
    const bool a_reply = ours && sent->shared_by != nullptr;
    if (ours && !a_reply) continue;
    if (a_reply && frame.length == 8 && frame.data[7] <= kMostFaultCode && motor_of(bus, frame.data[0])) continue;
    const std::string what = guess(bus, frame, a_reply);
    lines.push_back(fmt::format("{}: heard identifier 0x{:X}{} with {} bytes, {} times: {}", bus.name, frame.id,
                                frame.fd ? " (CAN FD)" : "", frame.length, seen.count,
                                what.empty() ? "no message of a drive that robot.yaml has" : what));
  }
  return lines;
}

std::string controller_line(const BusSetup& bus, const Link& link) {
  const LinkCounts& counts = link.counts();
  if (counts.error_frames == 0 && link.health() == BusHealth::kGood) return {};
  const char* state = link.health() == BusHealth::kOff       ? "bus-off"
                      : link.health() == BusHealth::kPassive ? "error-passive"
                                                             : "error-active";
  std::string text = fmt::format(
      "{}: this computer's CAN controller is {}, {} error reports, error counters {} sending and {} "
      "receiving; ",
      bus.name, state, counts.error_frames, counts.sending_errors, counts.receiving_errors);
  if (counts.ack_errors > 0) {
    text +=
        fmt::format("nobody acknowledged a frame {} times: no drive has power or the cable is off", counts.ack_errors);
  } else {
    text += fmt::format("expected that all have {} bit/s{}", bus.bitrate,
                        bus.data_bitrate == 0
                            ? std::string(", classic frames (an FD frame is an error to a classic controller)")
                            : fmt::format(" and {} bit/s, and take CAN FD (to a classic drive its frames are errors)",
                                          bus.data_bitrate));
  }
  return text;
}

}  // namespace pmg::can
