// Who answers on the buses, asked of drives that are switched off.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "can/bus_setup.hpp"
#include "can/canopen_setup.hpp"
#include "can/link.hpp"
#include "can/other_frames.hpp"

namespace pmg::can {

/// One answer to the request to disable, which every drive gives without a torque; of a CANopen drive, what its objects
/// say.
struct Answer {
  int node = 0;
  int count = 0;                   ///< answers a request, over several; 2: two drives have this node
  drives::MotorReading reading{};  ///< at the drive's output shaft; zero for a node without a known kind of drive
  std::string problem{};           ///< of a CANopen drive: why it isn't the one of robot.yaml; empty: it is
  std::optional<std::uint32_t> device_type{};  ///< a CANopen node's object 0x1000
};

/// Asks every motor of the bus a few times, for some 0.1 s, 0.3 s if one is silent, and reads the CANopen drives that
/// answer. Answers that a delay holds back or bunches count as those of one drive. Answers by node,
/// those of strangers included. others: gets what else was heard; null: nobody wants to know.
std::vector<Answer> ask_bus(const BusSetup& bus, Link& link, const Wait& wait, const std::function<bool()>& interrupted,
                            OtherFrames* others = nullptr);

/// Asks each node that robot.yaml doesn't have and a protocol of this bus could, for some 0.4 s: with the message that
/// switches a drive off, where the protocol says that a drive that is off stays as it is. (CANopen's nodes are asked by
/// ask_bus(), which reads an object.) Identifiers with which somebody else sends are left out. Nobody is asked, but
/// `why_not` says why, where another program speaks on the bus, since it may drive what answers, where the bus isn't
/// well, and where the protocol has no such message.
struct Strangers {
  std::vector<Answer> answers;  ///< none of a node of robot.yaml
  int asked = 0;                ///< nodes
  std::string why_not;          ///< one line; empty: all were asked
};
Strangers ask_strangers(const BusSetup& bus, Link& link, const Wait& wait, const std::function<bool()>& interrupted,
                        OtherFrames* others = nullptr);

/// Of each motor of the bus, as its drive has it; nullopt: it didn't answer.
drives::Readings motor_readings(const BusSetup& bus, const std::vector<Answer>& answers);

/// What is wrong with these answers, one text a problem: a motor that doesn't answer, two drives of one node, a node
/// that robot.yaml doesn't have, a fault that a drive reports, a joint more than 0.2 rad beyond its range (a wrong
/// zero, direction or gear, or a lost turn; of a linkage, swapped motors, too).
std::vector<std::string> problems(const BusSetup& bus, const std::vector<Answer>& answers);

/// Disables and asks every motor of every CAN bus; drives that are EtherCAT slaves are left out. Throws
/// std::runtime_error with the first problem and the number of others.
void call_roll(const DriveSetup& setup, const std::vector<std::unique_ptr<Link>>& links, const Wait& wait,
               const std::function<bool()>& interrupted);

}  // namespace pmg::can
