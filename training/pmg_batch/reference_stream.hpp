// One endless stream of what the controller would give its policy, made by the controller's own generator.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command_stream.hpp"
#include "gco/ground_aware_command.hpp"
#include "model/leg_kinematics.hpp"
#include "model/robot_model.hpp"
#include "pmg/generator.hpp"

namespace pmg::training {

enum class Variant {
  kPmg,         ///< generator and ground-aware optimisation: u' is what the actor sees
  kWithoutGco,  ///< the same references, u' = u
  kSingleGait,  ///< the forward clip alone, played as strongly as the command is large; u' = u
};

Variant variant_of(const std::string& name);  ///< "pmg", "without_gco", "single_gait"; throws std::invalid_argument

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
  const Reference& reference() const { return reference_; }
  const Command& optimised() const { return optimised_; }

  static constexpr double kTick_s = 0.01;

 private:
  void single_gait(const Reference& wanted);
  void write(const Command& user, float* row);

  Variant variant_;
  GeneratorOptions options_;
  CommandStream random_command_;
  Generator generator_;
  std::optional<Generator> forward_only_;
  gco::GroundAwareCommand gco_;
  model::BaseAttitude base_attitude_;
  double standing_height_m_;
  Reference reference_;
  Command optimised_;
  double vz_m_s_ = 0.0;
};

}  // namespace pmg::training
