// The controller's modes and what operators may send: both plain data that fits a mailbox.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

#include "pmg/command.hpp"

namespace pmg::control {

/// In the order of climbing; the numbers are those of pmg_msgs::mode_t.
enum class Mode : std::uint8_t {
  kPassive = 0,  ///< drives without torque
  kDamping = 1,  ///< drives brake the joints, no position
  kStand = 2,    ///< reference at rest in the standing posture; commands are ignored
  kWalk = 3,     ///< reference follows all six command channels
  kFault = 4,    ///< damping, latched until reset
};

constexpr const char* to_string(Mode mode) {
  constexpr std::array names = {"passive", "damping", "stand", "walk", "fault"};
  return names[static_cast<std::size_t>(mode)];
}

/// The drives hold positions: Stand and Walk.
constexpr bool upright(Mode mode) { return mode == Mode::kStand || mode == Mode::kWalk; }

/// Who sends: a name and a number that differs at every start of that sender.
struct Source {
  std::array<char, 24> name{};  ///< zero-terminated
  std::int64_t session = 0;

  /// Longer names are cut.
  static constexpr Source make(std::string_view name, std::int64_t session) {
    Source source;
    const std::size_t length = name.size() < source.name.size() ? name.size() : source.name.size() - 1;
    for (std::size_t i = 0; i < length; ++i) source.name[i] = name[i];
    source.session = session;
    return source;
  }
  friend bool operator==(const Source&, const Source&) = default;

  /// Whose source this is: the name up to its first point, which with keys is the name of the key that sealed it.
  constexpr std::string_view operator_name() const {
    const std::string_view text(name.data());
    return text.substr(0, text.find('.'));
  }
};

/// SHA-256.
using Digest = std::array<std::uint8_t, 32>;

/// The six-channel command of one source (pmg_msgs::command_t).
struct DriveMessage {
  Source source;
  std::int64_t sequence = 0;     ///< increases with every message of a session
  std::int64_t stamp_ns = 0;     ///< by the sender's clock
  std::int64_t received_ns = 0;  ///< by the receiver's
  double lease_s = 0.0;          ///< how long the source keeps driving after this message
  Command command;
};

/// A request for a mode (pmg_msgs::mode_t).
struct ModeRequest {
  Source source;
  std::int64_t sequence = 0;
  std::int64_t stamp_ns = 0;
  std::int64_t received_ns = 0;
  /// Stamp of the newest STATUS that the sender had heard, by the receiver's clock: what it could know. At most
  /// received_ns; without a network everything is known.
  std::int64_t heard_ns = std::numeric_limits<std::int64_t>::max();
  Mode mode = Mode::kDamping;
  bool reset_fault = false;
  /// False: a stop that anybody may have sent, in any name. It stops, and changes nothing that is remembered.
  bool sealed = true;
  Digest digest{};  ///< of the message as it was sent; the answer repeats it

  /// What anyone may ask for at any time.
  bool stops() const noexcept { return !reset_fault && (mode == Mode::kPassive || mode == Mode::kDamping); }
};

/// What became of a mode request; the numbers are those of pmg_msgs::ack_t.
enum class Verdict : std::uint8_t {
  kTaken = 0,
  kNotYours = 1,
  kOutOfOrder = 2,
  kLate = 3,
  kNoMode = 4,
  kNoKey = 5,  ///< no tick's answer: its gate's
  kTilted = 6,
};

/// The tick's answer to one request.
struct ModeAck {
  Source source;
  std::int64_t sequence = 0;
  Verdict verdict = Verdict::kTaken;
  Mode mode = Mode::kPassive;  ///< after the tick that took it
  Digest digest{};             ///< the request's
};

}  // namespace pmg::control
