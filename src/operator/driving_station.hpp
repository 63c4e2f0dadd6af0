// An input on the network: its operator source, the robot that it drives, and the text about both.
#pragma once

#include <optional>
#include <string>
#include <string_view>
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
  /// program: for the source's name. robot: the controller's name; empty: the only controller on the address. session:
  /// as in OperatorSource.
  DrivingStation(io::LcmLink& link, std::string_view program, std::string robot, std::int64_t session,
                 const io::Clock& clock, const seal::OperatorSeal& seal);
  virtual ~DrivingStation() = default;
  DrivingStation(const DrivingStation&) = delete;
  DrivingStation& operator=(const DrivingStation&) = delete;

  /// Receives for this time, then drives. Call repeatedly.
  void step(int wait_ms);
  void let_go();
  bool gone() const noexcept { return driver_ == nullptr ? letting_go_ : driver_->gone(); }

  bool heard() const noexcept { return !source_.heard().empty(); }  ///< any controller has sent a message
  std::vector<std::string> lines() const;                           ///< for a terminal
  DrivingTable table() const;                                       ///< for a window
  std::string last_words() const;                                   ///< at the end: the robot's last state

 protected:
  /// Of the robot with this name; the object lives as long as the station.
  virtual RobotDriver& make_driver(const std::string& robot) = 0;
  /// Call once, from the constructor of the class that makes the driver.
  void begin();
  /// Stops the robot; before a robot is known, every robot on the address.
  void stop();

  OperatorSource& source() noexcept { return source_; }
  const io::Clock& clock() const noexcept { return clock_; }
  RobotDriver* driver() const noexcept { return driver_; }  ///< null: no robot is known
  const RobotNews* news() const;                            ///< null: the robot has sent nothing

 private:
  void find_robot();
  std::string why_no_robot() const;

  io::LcmLink& link_;
  const io::Clock& clock_;
  OperatorSource source_;
  RobotBoard board_;
  std::string robot_;
  RobotDriver* driver_ = nullptr;
  std::optional<ModeWish> stop_everybody_;
  std::int64_t limits_session_ = 0;
  bool letting_go_ = false, limits_known_ = false;
};

}  // namespace pmg::ops
