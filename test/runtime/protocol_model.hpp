// The controller's receiving part as it is, in memory and on a clock of its own, and who writes to it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "control/command_intake.hpp"
#include "pmg_msgs/command_t.hpp"
#include "pmg_msgs/hoist_t.hpp"
#include "pmg_msgs/mode_t.hpp"
#include "runtime/hoist_gate.hpp"
#include "runtime/operator_gate.hpp"
#include "seal/asked_request.hpp"
#include "seal/operator_seal.hpp"
#include "sequence_search.hpp"

namespace pmg::runtime::model {

using Packet = std::vector<std::uint8_t>;

/// One operator's program.
struct Sender {
  explicit Sender(std::string name) {
    mode.version = pmg_msgs::mode_t::VERSION;
    command.version = pmg_msgs::command_t::VERSION;
    hoist.version = pmg_msgs::hoist_t::VERSION;
    mode.robot = command.robot = hoist.robot = "z1";
    mode.session = command.session = hoist.session = 1;
    mode.source = command.source = hoist.source = std::move(name);
    command.lease_s = 0.5;
  }
  pmg_msgs::mode_t mode{};
  pmg_msgs::command_t command{};
  pmg_msgs::hoist_t hoist{};
  seal::AskedRequest asked;
  seal::Peer peer;
};

/// What became of one request (source and number).
struct Fate {
  int carried_out = 0;
  bool refused = false, taken = false;
};

class World {
 public:
  World() {
    gate.emplace(inbox, "z1", clock, seal, order);
    hoist_gate.emplace("z1", clock, seal, order);
    hoist_gate->work(&hoist_line);
    pass_ms(1000);
    for (Sender* sender : {&anna, &bob}) hear_status(*sender);
  }

  void pass_ms(std::int64_t ms) { clock.advance_to(clock.now_ns() + ms * kMillisecond_ns); }
  void hear_status(Sender& sender) {
    sender.peer.boot = seal.boot();
    sender.peer.heard_ns = clock.now_ns();
  }
  template <typename Message>
  Packet sealed(const char* channel, const Message& message, const Sender& sender) {
    const io::Bytes bytes = operators.seal(channel, message, &sender.peer);
    return {bytes.begin(), bytes.end()};
  }
  template <typename Message>
  static Packet bare(const Message& message) {
    Packet bytes;
    seal::append(bytes, message);
    return bytes;
  }

  /// A message with the present wish and number of the sender.
  Packet request(Sender& sender) {
    sender.mode.stamp_ns = clock.now_ns();
    const seal::Digest digest = seal::digest_of(bare(sender.mode));
    sender.asked.sent(digest);
    made_ns[digest] = clock.now_ns();
    return sealed("MODE", sender.mode, sender);
  }
  Packet new_request(Sender& sender, std::int8_t mode) {
    ++sender.mode.sequence;
    sender.mode.mode = mode;
    sender.asked.begin();
    return request(sender);
  }
  Packet drive(Sender& sender) {
    ++sender.command.sequence;
    sender.command.stamp_ns = clock.now_ns();
    return sealed("COMMAND", sender.command, sender);
  }

  /// A control tick, as far as operators' messages go.
  void tick() {
    const std::int64_t now_ns = clock.now_ns();
    const bool stop = stop_line.pulls() != pulls;
    pulls = stop_line.pulls();
    if (stop) {
      intake.stop(now_ns);
      stopped_ns = now_ns;
    }
    for (control::DriveMessage message; inbox.take(message);) {
      ++commands[message.source.name.data()];
      intake.accept(message, now_ns);
    }
    for (control::ModeRequest message; inbox.take(message);) judge(message, now_ns);
  }

  io::SimulationClock clock;
  hal::StopLine stop_line;
  hal::HoistLine hoist_line;
  control::OperatorInbox inbox{stop_line};
  control::CommandIntake intake;
  seal::ControllerSeal seal;
  seal::OperatorSeal operators;
  DatagramOrder order;
  std::optional<OperatorGate> gate;
  std::optional<HoistGate> hoist_gate;
  Sender anna{"anna.1"}, bob{"bob.1"};

  std::string violation;  ///< what should never be; empty: all is well
  std::map<std::string, int> commands, requests;
  std::map<seal::Digest, std::int64_t> made_ns;
  std::map<seal::Digest, int> judged;
  std::map<std::pair<std::string, std::int64_t>, Fate> fates;
  std::int64_t stopped_ns = -1;
  std::uint32_t pulls = 0;

 private:
  void judge(const control::ModeRequest& message, std::int64_t now_ns) {
    const std::string name = message.source.name.data();
    if (message.sealed) ++requests[name];
    const auto judgement = intake.judge(message, now_ns);
    const bool taken = judgement.verdict == control::Verdict::kTaken;
    if (!message.stops()) {
      if (judged[message.digest]++ > 0) violation = "a datagram is looked at twice";
      Fate& fate = fates[{name, message.sequence}];
      if (judgement.fresh && fate.refused) violation = "what was refused is carried out later";
      if (judgement.fresh && fate.carried_out++ > 0) violation = "a request is carried out twice";
      if (judgement.fresh && made_ns.at(message.digest) <= stopped_ns)
        violation = "made before a stop, carried out after it";
      fate.refused = fate.refused || !taken;
      fate.taken = fate.taken || taken;
    }
    pmg_msgs::ack_t ack{};
    std::ranges::copy(message.digest, ack.digest);
    ack.source = name;
    ack.session = message.source.session;
    ack.sequence = message.sequence;
    const auto& own = fates[{anna.mode.source, anna.mode.sequence}];
    if (taken && anna.asked.answered_by(ack) && anna.mode.mode == pmg_msgs::mode_t::STAND && !own.taken) {
      violation = "an acknowledgement of something else is believed";
    }
  }
};

}  // namespace pmg::runtime::model
