// (bytes from the network) => (operators' inbox). It lets pass whole messages of our version, for our robot, from a
// source with a name, with a good seal, each datagram once, up to a rate. It counts and ignores all others. A stop
// passes without a seal, and passes even a flood.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "control/operator_inbox.hpp"
#include "io/clock.hpp"
#include "io/lcm_link.hpp"
#include "runtime/datagram_order.hpp"
#include "runtime/source_rates.hpp"
#include "seal/controller_seal.hpp"

namespace pmg::runtime {

/// Messages that were ignored before any tick saw them (pmg_msgs::link_t).
struct GateCounts {
  std::int64_t malformed = 0;
  std::int64_t other_version = 0;
  std::int64_t other_robot = 0;
  std::int64_t not_fresh = 0;
  std::int64_t no_key = 0;
  std::int64_t flooded = 0;
  std::int64_t out_of_order = 0;
  std::int64_t no_hoist = 0;
  friend GateCounts operator+(const GateCounts& a, const GateCounts& b) noexcept {
    return {a.malformed + b.malformed,
            a.other_version + b.other_version,
            a.other_robot + b.other_robot,
            a.not_fresh + b.not_fresh,
            a.no_key + b.no_key,
            a.flooded + b.flooded,
            a.out_of_order + b.out_of_order,
            a.no_hoist + b.no_hoist};
  }
  /// Counts what is not good.
  bool good(seal::ControllerSeal::Judgement judgement) noexcept {
    using Judgement = seal::ControllerSeal::Judgement;
    if (judgement == Judgement::kNotFresh) ++not_fresh;
    if (judgement == Judgement::kNoKey) ++no_key;
    return judgement == Judgement::kGood;
  }
  friend bool operator==(const GateCounts&, const GateCounts&) = default;
};

/// A name that fits Source and can be shown on a terminal: 1 to 23 printable ASCII characters.
bool presentable(const std::string& name);

/// The inbox's one writer. CommandIntake judges finiteness, order, age, lease, and who drives.
class OperatorGate {
 public:
  /// Keeps references. robot: the controller's name. order: of all operators' messages, HOIST too.
  OperatorGate(control::OperatorInbox& inbox, std::string robot, const io::Clock& clock,
               const seal::ControllerSeal& seal, DatagramOrder& order);

  void take_command(io::Bytes message);  ///< channel COMMAND
  void take_mode(io::Bytes message);     ///< channel MODE
  void take_arms(io::Bytes message);     ///< channel ARMS

  const GateCounts& counts() const noexcept { return counts_; }

  /// Answers to requests without a good key, which no tick sees: no more than strangers' rate allows. The mode is not
  /// set.
  std::vector<control::ModeAck> take_refusals() { return std::exchange(refusals_, {}); }

 private:
  void take_stop(control::ModeRequest request, io::Bytes message);
  /// A whole message with a good seal goes to the inbox if it is new and within its operator's rate.
  template <typename Message>
  void let_through(const Message& message, Stream stream, MessageKind kind);

  control::OperatorInbox& inbox_;
  std::string robot_;
  const io::Clock& clock_;
  const seal::ControllerSeal& seal_;
  DatagramOrder& order_;
  SourceRates rates_;
  GateCounts counts_;
  std::vector<control::ModeAck> refusals_;
};

}  // namespace pmg::runtime
