// What one motor's drive is told and says in a cycle, message by message: the one place that knows its protocol's
// bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drives/message.hpp"
#include "drives/motor.hpp"

namespace pmg::drives {

/// Messages of one motor in one half of a cycle.
class Outbox {
 public:
  static constexpr std::size_t kMost = 4;
  /// More than kMost are dropped; no protocol has them.
  void put(const Message& message) noexcept {
    if (count_ < kMost) messages_[count_++] = message;
  }
  std::span<const Message> messages() const noexcept { return std::span(messages_).first(count_); }

 private:
  std::array<Message, kMost> messages_{};
  std::size_t count_ = 0;
};

/// How new the reading is from which a cycle's command is computed.
enum class Freshness : std::uint8_t { kFresh, kLate, kNone };

/// What a message says.
struct Heard {
  enum class What : std::uint8_t {
    kForeign,  ///< not this motor's
    kNoted,    ///< this motor's; more is to come, or it says nothing of the motion
    kReading,  ///< an answer is complete
    kPart,     ///< a part of an answer whose other part is missing
    kBootUp,   ///< the drive was powered anew
  } what = What::kForeign;
  MotorReading reading{};  ///< of kReading
};

/// One motor's. It has a state: an answer may take several messages, and switching a drive on several cycles. No heap
/// after construction, no lock, nothing throws. A cycle: order() or off(), answers into hear(), then follow_up().
class Protocol {
 public:
  virtual ~Protocol() = default;

  /// What makes the drive answer.
  enum class AskedBy : std::uint8_t {
    kItsMessages,  ///< each order() or off() whose messages go out
    kSync,         ///< the bus's SYNC
  };
  virtual AskedBy asked_by() const noexcept { return AskedBy::kItsMessages; }

  struct Order {
    MotorCommand command{};  ///< at the motor
    bool stiff = false;      ///< some motor of the robot is told a gain or a torque: no drive is switched on
    bool enabling = false;   ///< the drive doesn't follow yet, and is to be switched on: it is asked so in each cycle
    bool silent = false;     ///< it has not answered for MotorMonitor::kSilentCycles
  };
  /// The messages at a cycle's begin. Of a drive that its messages ask, all of them together are one request.
  virtual void order(const Order& order, Outbox& out) noexcept = 0;
  /// Switched off; the drive answers.
  virtual void off(Outbox& out) noexcept = 0;
  /// After the answers, from the newest reading that is believed.
  virtual void follow_up(const MotorReading& /*measured*/, Freshness /*freshness*/, Outbox& /*out*/) noexcept {}
  /// The present position becomes the drive's zero. False: this protocol has no message for it.
  virtual bool zero(Outbox& /*out*/) noexcept { return false; }

  /// What a message says, whoever asked for it.
  virtual Heard hear(const Message& message) noexcept = 0;

  /// The drive says in each reading whether it follows: a pause of this computer needs no guess.
  virtual bool tells_whether_it_follows() const noexcept { return false; }
  /// The last command has gains that the drive can't have.
  virtual bool refuses_gains() const noexcept { return false; }
  /// Error code of the drive's last emergency message; 0: none, or it is over.
  virtual std::uint16_t emergency() const noexcept { return 0; }
};

/// What this computer sends on a bus for all of its drives together.
struct NetworkMessage {
  std::uint32_t id = 0;
  const char* who = "";   ///< "CANopen's SYNC"
  int bytes = 0;          ///< at most
  bool in_cycle = false;  ///< a bus cycle may have it
};

/// What a bus carries for all of its drives together, beside each motor's own messages. One a bus; no heap after
/// construction, no lock.
class Network {
 public:
  virtual ~Network() = default;
  /// Every message that this computer sends for all of them, SYNC among them.
  virtual std::span<const NetworkMessage> messages() const noexcept = 0;
  /// Asks every drive that is asked by it (Protocol::AskedBy::kSync).
  virtual Message sync() const noexcept = 0;
  /// This computer lives: its drives stop by themselves when they miss this for long. cycles: since the last call.
  virtual void sign_of_life(int cycles, Outbox& out) noexcept = 0;
};

}  // namespace pmg::drives
