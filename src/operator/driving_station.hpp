// A device on the network: its operator source, the robot that it drives, and the text about both.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/clock.hpp"
#include "io/lcm_link.hpp"
#include "operator/keyboard_text.hpp"
#include "operator/operator_source.hpp"
#include "operator/robot_board.hpp"
#include "operator/robot_driver.hpp"

namespace pmg::ops {

/// For one thread.
class DrivingStation {
 public:
  /// Keeps references. robot: the controller's name; empty: the only controller on the address. session: as in
  /// OperatorSource. seal: without keys unless given.
  DrivingStation(io::LcmLink& link, Device& device, std::string robot, std::int64_t session, const io::Clock& clock,
                 const seal::OperatorSeal& seal = seal::OperatorSeal());
  ~DrivingStation() = default;
  DrivingStation(const DrivingStation&) = delete;
  DrivingStation& operator=(const DrivingStation&) = delete;

  /// Acts on the device's requests, receives for this time, then drives. Call after the device's events, at least every
  /// 10 ms.
  void step(int wait_ms);
  void let_go();
  bool gone() const noexcept { return driver_ ? driver_->gone() : letting_go_; }

  bool heard() const noexcept { return !source_.heard().empty(); }  ///< any controller has sent a message
  std::vector<std::string> lines() const;                           ///< for a terminal
  DrivingTable table() const;                                       ///< for a window
  std::string last_words() const;                                   ///< at the end: the robot's last state

  /// Stops the robot; before a robot is known, every robot on the address. A device's stop does so too.
  void stop();

  const RobotDriver* driver() const noexcept { return driver_ ? &*driver_ : nullptr; }  ///< null: no robot is known
  const RobotNews* news() const;  ///< null: the robot has sent nothing

 private:
  void find_robot();
  std::string why_no_robot() const;

  io::LcmLink& link_;
  Device& device_;
  const io::Clock& clock_;
  OperatorSource source_;
  RobotBoard board_;
  std::string robot_;
  std::optional<RobotDriver> driver_;
  std::optional<ModeWish> stop_everybody_;
  bool letting_go_ = false;
};

}  // namespace pmg::ops
