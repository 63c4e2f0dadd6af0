// A keyboard on the network: its operator source, the robot that it drives, and the text about both.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/clock.hpp"
#include "io/lcm_link.hpp"
#include "operator/keyboard_driver.hpp"
#include "operator/keyboard_text.hpp"
#include "operator/operator_source.hpp"
#include "operator/robot_board.hpp"

namespace pmg::ops {

/// For one thread.
class KeyboardStation {
 public:
  /// robot: the controller's name; empty: the only controller on the address. session: as in OperatorSource.
  /// seal: without keys unless given.
  KeyboardStation(io::LcmLink& link, std::string robot, KeyReport report, std::int64_t session, const io::Clock& clock,
                  const seal::OperatorSeal& seal = seal::OperatorSeal());

  /// Key names are those of key_named(); other names have no effect. Before a robot is known, "escape" stops every
  /// robot on the address.
  void press(std::string_view key, bool shift);
  void repeat(std::string_view key, bool shift);
  void release(std::string_view key);
  void release_all();
  void listen();

  /// Receives for this time, then drives. Call repeatedly.
  void step(int wait_ms);
  void let_go();
  bool gone() const noexcept { return !driver_ ? letting_go_ : driver_->gone(); }

  bool heard() const noexcept { return !source_.heard().empty(); }  ///< any controller has sent a message
  std::vector<std::string> lines() const;                           ///< for a terminal
  DrivingTable table() const;                                       ///< for a window
  std::string last_words() const;                                   ///< at the end: the robot's last state

 private:
  void find_robot();
  const RobotNews* news() const;  // null: the robot has sent nothing
  std::string why_no_robot() const;

  io::LcmLink& link_;
  const io::Clock& clock_;
  KeyReport report_;
  OperatorSource source_;
  RobotBoard board_;
  std::string robot_;
  std::optional<KeyboardDriver> driver_;
  std::optional<ModeWish> stop_everybody_;
  std::int64_t begin_ns_, limits_session_ = 0;
  bool letting_go_ = false, limits_known_ = false;
};

}  // namespace pmg::ops
