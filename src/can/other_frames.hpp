// What is on a bus besides the answers of its drives, and what that may be: for who brings a robot up.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "can/bus_setup.hpp"
#include "can/link.hpp"

namespace pmg::can {

class OtherFrames {
 public:
  /// A frame that no drive of the bus answers with, or one whose last byte can't be a fault code.
  void note(const drives::Message& frame);
  bool heard(std::uint32_t id) const;  ///< of 11 bits
  /// One line for each identifier and length: how often, and what it may be. Ours are not among them: the IMU's
  /// messages and what CANopen drives of this bus send.
  std::vector<std::string> lines(const BusSetup& bus) const;

 private:
  struct Seen {
    int count = 0;
    drives::Message last;
  };
  std::map<std::tuple<std::uint32_t, bool, bool, int>, Seen> seen_;  // identifier, extended, fd, bytes
};

/// What the CAN controller of this computer says of a bus on which drives were asked; empty: nothing is wrong with it.
std::string controller_line(const BusSetup& bus, const Link& link);

}  // namespace pmg::can
