#include "can/roll_call.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <stdexcept>
#include <thread>

#include "can/can_hal.hpp"

namespace pmg::can {

namespace {

constexpr int kRounds = 10;  // of 20 ms: a drive that misses one frame is asked again
constexpr std::chrono::milliseconds kRound{20};
constexpr double kBeyondRange_rad =
    0.2;  // twice what the control thread takes for a fault: a limp joint may lie on its stop

void take(const drives::BusSetup& bus, Link& link, std::map<int, Answer>& answers) {
  std::array<Frame, 64> frames;
  while (const std::size_t count = link.receive(frames)) {
    for (const Frame& frame : std::span(frames).first(count)) {
      if (frame.extended || frame.id != kReplyId || frame.length != 8) continue;
      const int node = frame.data[0];
      Answer& answer = answers[node];
      answer.node = node;
      ++answer.count;
      const auto motor = std::ranges::find(bus.motors, node, &drives::MotorSetup::node);
      if (motor != bus.motors.end()) answer.reading = drives::MitProtocol(motor->ranges).reply(frame.bytes())->reading;
    }
  }
}

}  // namespace

std::vector<Answer> ask_bus(const drives::BusSetup& bus, Link& link, const std::function<bool()>& interrupted) {
  std::map<int, Answer> answers;
  std::map<int, Answer> ignored;
  take(bus, link, ignored);  // what is old
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Frame> frames;
    for (const drives::MotorSetup& motor : bus.motors) {
      if (!answers.contains(motor.node))
        frames.push_back(Frame::of(static_cast<std::uint32_t>(motor.node), drives::kMitDisable, bus.data_bitrate != 0));
    }
    if (frames.empty()) break;
    if (interrupted && interrupted()) throw std::runtime_error("interrupted while the drives were asked");
    link.send(frames);
    std::this_thread::sleep_for(kRound);
    take(bus, link, answers);
  }
  std::vector<Answer> list;
  for (const auto& [node, answer] : answers) list.push_back(answer);
  return list;
}

std::vector<std::string> problems(const drives::BusSetup& bus, const std::vector<Answer>& answers) {
  std::vector<std::string> found;
  for (const drives::MotorSetup& motor : bus.motors) {
    const std::string who = fmt::format("{} ({}, node {})", motor.joint, bus.name, motor.node);
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
    const drives::MotorReading& at = answer->reading;
    const double beyond = std::max(motor.limits.q_lower_rad - at.q_rad, at.q_rad - motor.limits.q_upper_rad);
    if (beyond > kBeyondRange_rad) {
      found.push_back(who + fmt::format(" is at {:.2f} rad; expected {:.2f} to {:.2f} rad at the motor: look at zero, "
                                        "direction, gear, lost turns",
                                        at.q_rad, motor.limits.q_lower_rad, motor.limits.q_upper_rad));
    }
  }
  for (const Answer& answer : answers) {
    if (std::ranges::find(bus.motors, answer.node, &drives::MotorSetup::node) != bus.motors.end()) continue;
    found.push_back(
        fmt::format("{}: somebody answers as node {}; expected only the nodes of robot.yaml", bus.name, answer.node));
  }
  return found;
}

void call_roll(const drives::DriveSetup& setup, const std::vector<std::unique_ptr<Link>>& links,
               const std::function<bool()>& interrupted) {
  std::vector<std::string> all;
  for (std::size_t b = 0; b < setup.buses.size(); ++b) {
    const std::vector<std::string> found = problems(setup.buses[b], ask_bus(setup.buses[b], *links[b], interrupted));
    all.insert(all.end(), found.begin(), found.end());
  }
  if (all.empty()) return;
  throw std::runtime_error(all.front() +
                           (all.size() > 1 ? fmt::format(" ({} more: pmg_bus scan)", all.size() - 1) : ""));
}

}  // namespace pmg::can
