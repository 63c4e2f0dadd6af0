// One endless stream of what the controller would give its policy, made by the controller's own generator.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "command_stream.hpp"
#include "gco/motion_composition.hpp"
#include "model/leg_kinematics.hpp"
#include "model/robot_model.hpp"

namespace pmg::training {

/// Columns of a row, in their order.
struct Field {
  std::string name;
  int offset = 0, size = 0;
};

class ReferenceStream {
 public:
  ReferenceStream(const model::RobotModel& robot, const ClipLibrary& library, Variant variant, std::uint64_t seed);

  static std::vector<Field> fields(const model::RobotModel& robot);

  /// One control tick of a random command; row has the size of all fields.
  void step(float* row) { step(random_command_.step(kTick_s), row); }
  /// One control tick of this command.
  void step(const Command& user, float* row);

  void reset();
  const Reference& reference() const { return motion_.reference(); }
  const Command& observed() const { return ground_.command; }

  static constexpr double kTick_s = 0.01;

 private:
  void write(const Command& user, float* row);

  CommandStream random_command_;
  gco::MotionComposition motion_;
  model::BaseAttitude base_attitude_;
  double standing_height_m_;
  gco::Result ground_;
};

}  // namespace pmg::training
