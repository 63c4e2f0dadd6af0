// Drives one robot by keys: (keys) => a hand's input and requests.
#pragma once

#include <string>

#include "operator/key_command.hpp"
#include "operator/robot_driver.hpp"

namespace pmg::ops {

/// For one thread. A key for a velocity or a posture takes the robot from any mode to Walk, except after a stop by any
/// operator and after a fault. Then the robot rises only when its operator asks for Stand (Key::kStand).
class KeyboardDriver {
 public:
  /// Keeps a reference. robot: its controller's name.
  KeyboardDriver(OperatorSource& source, std::string robot, KeyReport report);
  ~KeyboardDriver() = default;
  KeyboardDriver(const KeyboardDriver&) = delete;
  KeyboardDriver& operator=(const KeyboardDriver&) = delete;

  /// Until the robot's limits are known a key commands nothing; one that is still held then takes effect.
  void set_limits(const CommandLimits& limits) noexcept { driver_.set_limits(limits); }

  void press(Key key, bool fast);
  void repeat(Key key, bool fast) { keys_.repeat(key, fast, clock_.now_ns()); }
  void press_other() noexcept { keys_.press_other(); }
  void release(Key key) { keys_.release(key, clock_.now_ns()); }
  void release_all() noexcept { keys_.release_all(); }
  void listen() noexcept { keys_.listen(clock_.now_ns()); }

  void step() { driver_.step(); }
  void let_go() { driver_.let_go(); }
  bool gone() const noexcept { return driver_.gone(); }
  std::string text() const { return driver_.text(); }
  RobotDriver& driver() noexcept { return driver_; }

 private:
  const io::Clock& clock_;
  KeyCommand keys_;
  RobotDriver driver_;
};

}  // namespace pmg::ops
