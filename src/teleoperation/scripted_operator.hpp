// What every scripted operator can do: walk the robot, crouch with it, raise its hands, each by head and hands in a
// headset.
#pragma once

#include "teleoperation/led_robot.hpp"
#include "teleoperation/person.hpp"
#include "teleoperation/view.hpp"

namespace pmg::teleoperation {

/// One for each task. It knows pictures and what its page tells, nothing else.
class ScriptedOperator {
 public:
  virtual ~ScriptedOperator() = default;
  ScriptedOperator(const ScriptedOperator&) = delete;
  ScriptedOperator& operator=(const ScriptedOperator&) = delete;

  /// 10 ms: it looks, moves head and hands, and the robot's tick runs.
  void step(LedRobot& robot);
  virtual const char* stage() const noexcept = 0;  ///< what it does, in words

 protected:
  ScriptedOperator() = default;

  /// What it sees now; false: no picture has arrived yet, and it waits.
  virtual bool look(double now_s) = 0;
  virtual void act(LedRobot& robot, double now_s) = 0;

  /// Squeezes the grip once the robot stands, and steps forward; true: it walks, led by this headset.
  bool takes_over(const LedRobot& robot, double now_s);
  /// Velocities that are wanted: forwards, left [m/s], turn [rad/s].
  void walk(double ahead_m_s, double left_m_s, double turn_rad_s);
  void stay();
  /// From now on: the robot's height [m] and pitch [rad] beside those of standing, which it takes slowly.
  void crouch(double height_m, double pitch_rad) noexcept;
  /// A velocity that closes this gap, at least `least`; none where it is small.
  static double towards(double gap, double small, double least = 0.05);

  /// Takes both palms to these places in T [m], pulling the triggers where they aren't yet.
  void raise(const LedRobot& robot, const Picture& picture, const PerFoot<Eigen::Vector3d>& to_m, double now_s);
  void steer(Foot side, const Eigen::Vector3d& error_m);

  Person person_;

 private:
  static bool follows(const LedRobot& robot, Foot side);

  CommandLimits limits_;  // its page tells them
  PerFoot<double> pulled_s_{-10.0, -10.0};
  double squeezed_s_ = 0.0;
  double down_m_ = 0.0, down_to_m_ = 0.0, bent_rad_ = 0.0, bent_to_rad_ = 0.0;  // of its own head
};

}  // namespace pmg::teleoperation
