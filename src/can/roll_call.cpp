#include "can/roll_call.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <utility>

#include "can/bus_ids.hpp"
#include "can/linked_wiggle.hpp"
#include "drive_protocols/canopen.hpp"
#include "drive_protocols/canopen_drive.hpp"

namespace pmg::can {

namespace {

constexpr int kRounds = 10;         // a drive that misses one frame is asked again
constexpr int kRoundWaits = 20;     // of some 1 ms
constexpr int kCounted = 3;         // requests whose answers are counted
constexpr std::size_t kBatch = 16;  // requests that an interface's queue takes
constexpr int kQuietWaits = 50;     // in which another program that drives something has sent, at 20 Hz or more
constexpr int kStrangerRounds = 2, kBatchWaits = 10, kLateWaits = 60;
constexpr double kBeyondRange_rad =
    0.2;  // twice what the control thread takes for a fault: a limp joint may lie on its stop

using Answers = std::map<int, Answer>;

/// A drive that the bus isn't to have and that answers as those do that their messages ask.
std::optional<int> asked_stranger(const BusSetup& bus, const drives::Message& frame) {
  for (const drives::MotorSetup& motor : bus.motors) {
    if (drives::as_cia402(motor.drive) != nullptr) continue;
    const auto node = motor.drive->sender(frame);
    if (node && std::ranges::find(bus.motors, *node, &drives::MotorSetup::node) == bus.motors.end()) return node;
  }
  return std::nullopt;
}

/// A motor whose drive its messages ask, and its way to speak.
struct Asked {
  const drives::MotorSetup* setup;
  std::unique_ptr<drives::Protocol> protocol;
};

/// What has arrived from such drives, strangers' too.
void take_asked(const BusSetup& bus, const std::vector<Asked>& motors, Link& link, Answers& answers,
                OtherFrames* others) {
  const auto count_one = [&](int node) -> Answer& {
    Answer& answer = answers[node];
    answer.node = node;
    ++answer.count;
    return answer;
  };
  std::array<drives::Message, 64> frames;
  while (const std::size_t count = link.receive(frames)) {
    for (const drives::Message& frame : std::span(frames).first(count)) {
      bool fault_code = false;
      if (const auto node = asked_stranger(bus, frame)) count_one(*node);
      for (const Asked& motor : motors) {
        const drives::Heard heard = motor.protocol->hear(frame);
        fault_code = fault_code || heard.what == drives::Heard::What::kNoted;
        if (heard.what != drives::Heard::What::kReading) continue;
        count_one(motor.setup->node).reading = heard.reading;
        fault_code = heard.reading.fault != drives::DriveFault::kOther;
      }
      if (others != nullptr && !fault_code) others->note(frame);
    }
  }
}

/// What has arrived from SDO servers.
void take_canopen(Link& link, Answers& answers, OtherFrames* others) {
  std::array<drives::Message, 64> frames;
  while (const std::size_t count = link.receive(frames)) {
    for (const drives::Message& frame : std::span(frames).first(count)) {
      const std::uint32_t node = frame.id & drives::canopen::kNodeBits;
      if (frame.extended || frame.id - node != drives::canopen::kSdoAnswer || !drives::canopen::sdo_answer(frame)) {
        if (others != nullptr) others->note(frame);
        continue;
      }
      Answer& answer = answers[static_cast<int>(node)];
      answer.node = static_cast<int>(node);
      ++answer.count;
      const auto said = drives::canopen::sdo_answer(frame);
      if (said->upload && said->id.index == drives::object::kDeviceType.index) answer.device_type = said->value;
    }
  }
}

/// A way to ask nodes that are switched off, and to hear them.
struct Roll {
  Link& link;
  const Wait& wait;
  std::function<void(int node, std::vector<drives::Message>& frames)> request;
  std::function<void(Answers&)> take;

  void ask(const std::vector<int>& nodes, Answers& answers) const {
    for (std::size_t at = 0; at < nodes.size(); at += kBatch) {
      std::vector<drives::Message> frames;
      const auto batch = std::span(nodes).subspan(at, std::min(kBatch, nodes.size() - at));
      for (const int node : batch) request(node, frames);
      const int all = heard(answers) + static_cast<int>(batch.size());
      link.send(frames);
      listen(answers, all);
    }
  }
  /// For a round, or until so many answers were heard.
  void listen(Answers& answers, int all) const {
    for (int k = 0; k < kRoundWaits && heard(answers) < all; ++k) {
      wait();
      take(answers);
    }
  }
  /// Until each of these nodes has answered as often as it was asked and a round brings nothing more; for all rounds
  /// where a node has not. What a delay holds back arrives late, and bunched.
  void listen_to_the_end(const std::vector<int>& nodes, const std::map<int, int>& asked, Answers& answers) const {
    const auto even = [&](int node) { return answers.at(node).count == asked.at(node); };
    for (int round = 0; round < kRounds; ++round) {
      const int before = heard(answers);
      listen(answers, std::numeric_limits<int>::max());
      if (heard(answers) == before && std::ranges::all_of(nodes, even)) return;
    }
  }
  static int heard(const Answers& answers) {
    int sum = 0;
    for (const auto& [node, answer] : answers) sum += answer.count;
    return sum;
  }
};

/// Finds who answers, then counts the drives of each node. Of answers that a delay bunches, a single round has several
/// of one drive, so the sum over some requests decides: one drive answers as often as it is asked, two answer twice as
/// often. A lost or duplicated frame changes neither.
void find_and_count(const Roll& roll, const std::vector<int>& nodes, const std::function<void()>& check,
                    Answers& answers) {
  Answers old;
  roll.take(old);
  std::map<int, int> asked;
  const auto ask = [&](const std::vector<int>& some) {
    check();
    for (const int node : some) ++asked[node];
    roll.ask(some, answers);
  };
  std::vector<int> found, silent = nodes;
  for (int round = 0; round < kRounds && !silent.empty(); ++round) {
    ask(silent);
    std::erase_if(silent, [&](int node) { return answers.contains(node); });
  }
  std::ranges::copy_if(nodes, std::back_inserter(found), [&](int node) { return answers.contains(node); });
  roll.listen_to_the_end(found, asked, answers);
  asked.clear();
  for (auto& [node, answer] : answers) answer.count = 0;
  for (int k = 0; k < kCounted; ++k) ask(found);
  roll.listen_to_the_end(found, asked, answers);
  for (auto& [node, answer] : answers)
    answer.count = std::max(1, static_cast<int>(std::lround(static_cast<double>(answer.count) / kCounted)));
}

/// " (CANopen device type 0x00020192: profile 402)"
std::string kind_of(const Answer& answer) {
  if (!answer.device_type) return {};
  constexpr std::uint32_t kProfile = 0xFFFF;  // bits of it
  return fmt::format(" (CANopen device type 0x{:08X}: profile {})", *answer.device_type,
                     *answer.device_type & kProfile);
}

/// Switches the drive off and reads it.
void read_node(const BusSetup& bus, const drives::MotorSetup& motor, Link& link, const Wait& wait, Answer& answer) {
  const auto& settings = *drives::as_cia402(motor.drive);
  try {
    const drives::Message quiet =
        drives::canopen::node_command(drives::canopen::NodeCommand::kPreOperational, motor.node);
    link.send(std::span(&quiet, 1));
    SdoClient node(motor.node, link, wait);
    node.write(drives::object::kControlWord, 0);
    answer.reading = drives::read_drive(node, settings);
    drives::check_drive(node, settings);
  } catch (const std::runtime_error& error) {
    answer.problem = name_of(bus, motor) + ": " + error.what();
  }
}

void ask_canopen(const BusSetup& bus, Link& link, const Wait& wait, const std::function<void()>& check,
                 Answers& answers, OtherFrames* others) {
  const Roll roll{.link = link,
                  .wait = wait,
                  .request =
                      [](int node, std::vector<drives::Message>& frames) {
                        frames.push_back(drives::canopen::sdo_read(node, drives::object::kDeviceType));
                      },
                  .take = [&](Answers& into) { take_canopen(link, into, others); }};
  std::vector<int> own, strangers;
  for (int node = 1; node <= static_cast<int>(drives::canopen::kHostNode); ++node) {  // nobody may have this computer's
    const auto motor = std::ranges::find(bus.motors, node, &drives::MotorSetup::node);
    if (motor == bus.motors.end()) {
      strangers.push_back(node);
    } else if (drives::as_cia402(motor->drive) != nullptr) {
      own.push_back(node);
    }
  }
  Answers nodes;
  roll.ask(strangers, nodes);
  find_and_count(roll, own, check, nodes);
  for (const drives::MotorSetup& motor : bus.motors) {
    if (drives::as_cia402(motor.drive) == nullptr || !nodes.contains(motor.node)) continue;
    check();
    read_node(bus, motor, link, wait, nodes[motor.node]);
  }
  answers.merge(nodes);
}

/// What switches each node off that these kinds may have, robot.yaml hasn't, and nobody sends as. nodes: their number.
std::vector<drives::Message> off_messages(const BusSetup& bus, const std::vector<drives::DriveKind>& kinds,
                                          const std::function<bool(std::uint32_t id)>& sent_by_others, int& nodes) {
  const auto taken = [&](int node) {
    return std::ranges::find(bus.motors, node, &drives::MotorSetup::node) != bus.motors.end();
  };
  std::map<std::pair<std::uint32_t, std::vector<std::uint8_t>>, drives::Message> messages;  // each once
  std::set<int> asked;
  for (const drives::DriveKind& kind : kinds) {
    for (int node = 1; node <= kind->most_node(); ++node) {
      if (taken(node)) continue;
      drives::Outbox out;
      kind->protocol(node, {}, bus.data_bitrate != 0)->off(out);
      for (const drives::Message& message : out.messages()) {
        if (sent_by_others(message.id)) continue;
        messages[{message.id, {message.bytes().begin(), message.bytes().end()}}] = message;
        asked.insert(node);
      }
    }
  }
  nodes = static_cast<int>(asked.size());
  std::vector<drives::Message> all;
  for (const auto& [key, message] : messages) all.push_back(message);
  return all;
}

/// Cranks whose angles belong to no posture, or to one beyond a joint's range.
std::vector<std::string> linkage_problems(const BusSetup& bus, const drives::Readings& motors) {
  std::vector<std::string> found;
  const drives::Readings joints = drives::joint_readings(bus, motors);
  const auto look = [&](const auto& linkages) {
    for (const auto& linked : linkages) {
      const auto silent = [&](std::size_t m) { return !motors[m]; };
      if (std::ranges::any_of(linked.motors, silent)) continue;
      std::vector<std::string> names;
      std::vector<double> cranks_rad, joints_rad;
      bool within = true;
      for (std::size_t i = 0; i < linked.motors.size(); ++i) {
        const std::size_t m = linked.motors[i];
        names.push_back(bus.motors[m].joint);
        cranks_rad.push_back(bus.motors[m].transmission.to_joint(*motors[m]).q_rad);
        if (!joints[m]) continue;
        joints_rad.push_back(joints[m]->q_rad);
        within = within && joints[m]->q_rad >= linked.joints[i].q_lower_rad - kBeyondRange_rad &&
                 joints[m]->q_rad <= linked.joints[i].q_upper_rad + kBeyondRange_rad;
      }
      if (within && !joints_rad.empty()) continue;
      const std::string other = arranged_within_ranges(bus, bus.motors[linked.motors[0]], cranks_rad);
      found.push_back(fmt::format(
          "{} ({}): {}; expected angles within their ranges: {}", fmt::join(names, " and "), bus.name,
          joints_rad.empty()
              ? fmt::format("no angles of theirs belong to their cranks' ({:.2f} rad)", fmt::join(cranks_rad, " and "))
              : fmt::format("their cranks' angles put them at {:.2f} rad", fmt::join(joints_rad, " and ")),
          other.empty() ? "look at zeros, directions, gears, lost turns" : "it is as if " + other));
    }
  };
  look(bus.four_bars);
  look(bus.parallel);
  return found;
}

}  // namespace

drives::Readings motor_readings(const BusSetup& bus, const std::vector<Answer>& answers) {
  drives::Readings readings;
  for (const drives::MotorSetup& motor : bus.motors) {
    const auto answer = std::ranges::find(answers, motor.node, &Answer::node);
    readings.push_back(answer == answers.end() ? std::nullopt : std::optional(answer->reading));
  }
  return readings;
}

std::vector<Answer> ask_bus(const BusSetup& bus, Link& link, const Wait& wait, const std::function<bool()>& interrupted,
                            OtherFrames* others) {
  const auto check = [&] {
    if (interrupted && interrupted()) throw std::runtime_error("interrupted while the drives were asked");
  };
  std::vector<int> nodes;
  std::vector<Asked> motors;
  for (const drives::MotorSetup& motor : bus.motors) {
    auto protocol = motor.drive->protocol(motor.node, motor.limits, bus.data_bitrate != 0);
    if (protocol->asked_by() != drives::Protocol::AskedBy::kItsMessages) continue;
    nodes.push_back(motor.node);
    motors.push_back({.setup = &motor, .protocol = std::move(protocol)});
  }
  const auto off = [&motors](int node, std::vector<drives::Message>& frames) {
    const auto motor = std::ranges::find(motors, node, [](const Asked& asked) { return asked.setup->node; });
    drives::Outbox out;
    motor->protocol->off(out);
    frames.insert(frames.end(), out.messages().begin(), out.messages().end());
  };
  const Roll roll{.link = link, .wait = wait, .request = off, .take = [&](Answers& into) {
                    take_asked(bus, motors, link, into, others);
                  }};
  Answers answers;
  find_and_count(roll, nodes, check, answers);
  if (bus.has_canopen()) ask_canopen(bus, link, wait, check, answers, others);
  std::vector<Answer> list;
  for (const auto& [node, answer] : answers) list.push_back(answer);
  return list;
}

Strangers ask_strangers(const BusSetup& bus, Link& link, const Wait& wait, const std::function<bool()>& interrupted,
                        OtherFrames* others) {
  std::vector<drives::DriveKind> kinds;  // whose drives answer to their own messages
  Strangers result;
  for (const drives::MotorSetup& motor : bus.motors) {
    const auto protocol = motor.drive->protocol(motor.node, motor.limits, bus.data_bitrate != 0);
    if (protocol->asked_by() != drives::Protocol::AskedBy::kItsMessages) continue;
    if (!motor.drive->off_is_harmless()) {
      result.why_not =
          fmt::format("{}'s protocol has no message that is known to be harmless to any drive", motor.joint);
      return result;
    }
    kinds.push_back(motor.drive);
  }
  if (kinds.empty()) return result;
  if (link.health() != BusHealth::kGood) {
    result.why_not = "the bus isn't well";
    return result;
  }
  const std::vector<std::uint32_t> awaited = awaited_ids(bus);
  const auto sent_by_others = [&](std::uint32_t id) {
    return std::ranges::find(awaited, id) != awaited.end() || (others != nullptr && others->heard(id));
  };
  const auto listen = [&](const std::function<void(const drives::Message&)>& take) {
    if (interrupted && interrupted()) throw std::runtime_error("interrupted while the drives were asked");
    wait();
    std::array<drives::Message, 64> frames;
    while (const std::size_t count = link.receive(frames)) {
      for (const drives::Message& frame : std::span(frames).first(count)) take(frame);
    }
  };
  for (int k = 0; k < kQuietWaits && result.why_not.empty(); ++k) {
    listen([&](const drives::Message& frame) {
      if (frame.extended || frame.id == 0 || frame.id > drives::canopen::kNodeBits || sent_by_others(frame.id)) return;
      result.why_not = fmt::format("something else sends 0x{:X} there and may drive them", frame.id);
    });
  }
  if (!result.why_not.empty()) return result;

  std::map<int, Answer> found;
  const auto take = [&](const drives::Message& frame) {
    for (const drives::DriveKind& kind : kinds) {
      const auto node = kind->sender(frame);
      if (!node) continue;
      if (std::ranges::find(bus.motors, *node, &drives::MotorSetup::node) == bus.motors.end())
        found[*node] = {.node = *node, .count = 1};
      return;
    }
    if (others != nullptr) others->note(frame);
  };
  const std::vector<drives::Message> requests = off_messages(bus, kinds, sent_by_others, result.asked);
  for (int round = 0; round < kStrangerRounds; ++round) {
    for (std::size_t at = 0; at < requests.size(); at += kBatch) {
      link.send(std::span(requests).subspan(at, std::min(kBatch, requests.size() - at)));
      for (int k = 0; k < kBatchWaits; ++k) listen(take);
    }
  }
  for (int k = 0; k < kLateWaits; ++k) listen(take);
  for (const auto& [node, answer] : found) result.answers.push_back(answer);
  return result;
}

std::vector<std::string> problems(const BusSetup& bus, const std::vector<Answer>& answers) {
  std::vector<std::string> found;
  for (const drives::MotorSetup& motor : bus.motors) {
    const std::string who = name_of(bus, motor);
    const auto answer = std::ranges::find(answers, motor.node, &Answer::node);
    if (answer == answers.end()) {
      found.push_back(who + " does not answer; expected a powered drive with this node number");
      continue;
    }
    if (answer->count > 1)
      found.push_back(who + fmt::format(" answers {} times; expected one drive of each node number", answer->count));
    if (answer->reading.fault != drives::DriveFault::kNone) {
      found.push_back(who + " reports " + drives::to_string(answer->reading.fault) + "; expected no fault");
    }
    if (!answer->problem.empty()) {
      found.push_back(answer->problem);
      continue;
    }
    const drives::MotorReading& at = answer->reading;
    const double beyond = std::max(motor.limits.q_lower_rad - at.q_rad, at.q_rad - motor.limits.q_upper_rad);
    if (beyond > kBeyondRange_rad) {
      found.push_back(who + fmt::format(" is at {:.2f} rad; expected {:.2f} to {:.2f} rad at the motor: look at zero, "
                                        "direction, gear, lost turns",
                                        at.q_rad, motor.limits.q_lower_rad, motor.limits.q_upper_rad));
    }
  }
  for (const std::string& problem : linkage_problems(bus, motor_readings(bus, answers))) found.push_back(problem);
  for (const Answer& answer : answers) {
    if (std::ranges::find(bus.motors, answer.node, &drives::MotorSetup::node) != bus.motors.end()) continue;
    found.push_back(fmt::format("{}: somebody answers as node {}{}; expected only the nodes of robot.yaml", bus.name,
                                answer.node, kind_of(answer)));
  }
  return found;
}

void call_roll(const DriveSetup& setup, const std::vector<std::unique_ptr<Link>>& links, const Wait& wait,
               const std::function<bool()>& interrupted) {
  std::vector<std::string> all;
  for (std::size_t b = 0; b < setup.buses.size(); ++b) {
    if (!setup.buses[b].on_can) continue;
    const std::vector<std::string> found =
        problems(setup.buses[b], ask_bus(setup.buses[b], *links[b], wait, interrupted));
    all.insert(all.end(), found.begin(), found.end());
  }
  if (all.empty()) return;
  throw std::runtime_error(all.front() +
                           (all.size() > 1 ? fmt::format(" ({} more: pmg_bus scan)", all.size() - 1) : ""));
}

}  // namespace pmg::can
