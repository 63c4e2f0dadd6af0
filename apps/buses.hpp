// The buses of a robot, and one question to all of their drives.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "can/bus_claim.hpp"
#include "can/bus_setup.hpp"
#include "can/link.hpp"
#include "can/roll_call.hpp"
#include "model/robot_model.hpp"

namespace pmg::apps {

struct Buses {
  enum class Use {
    kDrive,   ///< no other program may drive these buses meanwhile
    kListen,  ///< sends nothing
  };
  /// Opens every CAN bus that robot.yaml names.
  /// \throws std::runtime_error where a bus can't be opened, can't carry its load, or is another program's
  explicit Buses(const std::string& robot_name, Use use = Use::kDrive);

  model::RobotModel robot;
  can::DriveSetup setup;
  std::vector<can::BusClaim> claims;
  std::vector<std::unique_ptr<can::Link>> links;
};

/// What each motor of a bus said, as its drive has it; nullopt: it didn't answer.
using TakeReadings = std::function<void(const can::BusSetup&, const drives::Readings&)>;

enum class Whom : std::uint8_t {
  kOwn,  ///< the motors of robot.yaml
  kAll,  ///< every node that a protocol of the bus can have
};

/// Asks every bus once; take gets what its motors said. Returns all problems. Ends early after an interrupt.
std::vector<std::string> ask(Buses& buses, const TakeReadings& take, Whom whom = Whom::kOwn);

/// What drives say that another program drives.
class Overhearing {
 public:
  /// Keeps a reference.
  explicit Overhearing(Buses& buses);
  /// Listens for 0.2 s; prints a row for each motor from what its drive said last, if that is less than 2 s ago, and
  /// all problems, as far as that shows them. Returns their number.
  std::size_t show();

 private:
  struct Heard {
    const drives::MotorSetup* motor;
    std::unique_ptr<drives::Protocol> protocol;
    can::Answer answer{};
    std::chrono::steady_clock::time_point at{};
  };
  void listen();

  Buses& buses_;
  std::vector<std::vector<Heard>> heard_;  // of each bus: its motors
};

/// Asks every bus once, and prints a row for each motor, one for each joint of a linkage, and all problems. Returns the
/// number of problems.
std::size_t show(Buses& buses, Whom whom = Whom::kOwn);

}  // namespace pmg::apps
