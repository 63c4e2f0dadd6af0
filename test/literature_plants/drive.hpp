// A digital drive: from commands and readings to what it gives until its next tick.
#pragma once

#include <deque>

#include "drive_output.hpp"
#include "randomness.hpp"
#include "sensor.hpp"

namespace pmg::literature {

struct Command {
  double q_rad = 0.0, dq_rad_s = 0.0;
  double feed_forward = 0.0;  ///< in the output's unit: Nm, duty or V
  double kp = 1.0, kd = 0.0;  ///< as named, in the law's units
  double bus_V = 1.0;
  bool enabled = true;
};

class Drive {
 public:
  Drive(const Machine& machine, Draw draw) : m_(machine), draw_(draw) {}

  void reset(const Command& command);
  /// From that time on; late by what the command's way takes.
  void tell(double t_s, const Command& command);
  DriveOutput tick(double t_s, const Sensor::Seen& seen, double motor_rad_s);

 private:
  struct Told {
    double arrives_s = 0.0;
    Command command;
  };
  void take(double t_s);
  void shape(double h_s);
  double error_rad(double seen_rad);
  double wish(const Sensor::Seen& seen, double h_s);
  double late(double t_s, double output);
  DriveOutput bridge(double duty, double motor_rad_s, double h_s);

  Machine m_;
  Draw draw_;
  std::deque<Told> told_;
  Command newest_, taken_;
  double taken_s_ = -1.0, ticked_s_ = 0.0, computed_s_ = -1.0;
  double shaped_rad_ = 0.0, shaped_rad_s_ = 0.0;
  double integral_ = 0.0, output_ = 0.0, given_ = 0.0, bus_lost_ = 0.0;
  bool awake_ = true;
  std::deque<std::pair<double, double>> outputs_;
};

}  // namespace pmg::literature
