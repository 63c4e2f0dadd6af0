// A keyboard on the network: its own source, the robot that it drives, and what is shown of both.
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
  /// robot: the controller's name; empty: the only one that is heard. session: as OperatorSource's.
  KeyboardStation(io::LcmLink& link, std::string robot, KeyReport report, std::int64_t session, const io::Clock& clock);

  /// Names of keys: key_named()'s; others are ignored. Before a robot is known "escape" stops every one on the address.
  void press(std::string_view key, bool shift);
  void repeat(std::string_view key, bool shift);
  void release(std::string_view key);
  void release_all();
  void listen();

  /// Hears for so long, drives. To be called again and again.
  void step(int wait_ms);
  void let_go();
  bool gone() const noexcept { return !driver_ ? letting_go_ : driver_->gone(); }

  bool heard() const noexcept { return !source_.heard().empty(); }  ///< any controller, ever
  std::vector<std::string> lines() const;                           ///< for a terminal
  DrivingTable table() const;                                       ///< for a window
  std::string last_words() const;                                   ///< at the end: how the robot was left

 private:
  void find_robot();
  const RobotNews* news() const;  // null: nothing was heard of the robot
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
