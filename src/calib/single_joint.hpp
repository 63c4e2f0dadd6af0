// A fast simulation of one joint on its bench: the actuator model and a pendulum load.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "bench/bench.hpp"
#include "sim/actuator_model.hpp"

namespace pmg::calib {

/// All parameters that a fit can change.
struct JointModel {
  model::ActuatorParameters actuator;
  double inertia_scale = 1.0, gravity_scale = 1.0;  ///< of the bench's loads
  /// Of something that turns with every load and that no load's numbers have: an arm, a pulley.
  double more_inertia_kg_m2 = 0.0, more_gravity_Nm = 0.0;
  double feed_forward_scale = 1.0;  ///< of the recorded feed-forward
  /// By how much the sensor's zero slipped between two recordings, and the place of the slip among them
  /// (bench::BenchRun::place). Runs from there on have it.
  double zero_slip_rad = 0.0, zero_slip_at = 0.0;
};

/// (model) => (what it is once the sensor's zero has slipped: the slip is part of the offset). What a joint is now.
JointModel after_the_slip(JointModel model);

/// Errors of a rollout, summed over the recording's valid samples.
struct RolloutError {
  double sum_of_squares_rad2 = 0.0, sum_of_absolutes_rad = 0.0;
  std::size_t samples = 0;
  double mean_square_rad2() const { return sum_of_squares_rad2 / static_cast<double>(samples); }
  double mean_absolute_rad() const { return sum_of_absolutes_rad / static_cast<double>(samples); }
};

/// A recording with its inputs resampled to simulation steps. Semi-implicit Euler, dq' = dq + h tau / (I - h slope),
/// q' = q + h dq', slope = d tau / d dq: identical to MuJoCo's `implicit` integrator for one hinge, step by step.
class SingleJoint {
 public:
  SingleJoint(const bench::Bench& bench, bench::BenchRun run, double step_s);

  /// (model) => (simulated reading at each sample of the recording [rad]), with what differs in this run's assembly.
  /// Open loop, from rest at the recording's first position. There dry friction balances gravity minus drive torque, up
  /// to its limit.
  std::vector<double> rollout(const JointModel& model) const;

  RolloutError error(const JointModel& model) const;

  /// (model) => (the load of this run as the model has it). A rig without gravity has none, whatever turns on it.
  bench::JointLoad load(const JointModel& model) const;

  const bench::BenchRun& run() const { return run_; }
  /// Sets what differs from the model in this run's assembly; later rollouts have it.
  void set_differences(std::vector<bench::AssemblyDifference> differs) { run_.differs = std::move(differs); }
  /// (model of all runs) => (the model of this run: of its assembly, and of its place among the recordings).
  JointModel of_run(JointModel model) const;
  /// The same run as if it had ended after so many seconds, from the same rest. At least two samples stay.
  SingleJoint beginning(double seconds) const;
  double step_s() const { return step_s_; }
  std::size_t steps() const { return sample_of_step_.size(); }
  sim::ActuatorInput input(std::size_t step) const;

  /// Where a rollout begins: the joint's angle, the load on it (positive pulls q down), and how far the motor is ahead
  /// within the play of a shaft that carries nothing.
  struct Start {
    double q_rad = 0.0, load_Nm = 0.0, slack_rad = 0.0;
  };
  Start start(const JointModel& model) const;

 private:
  template <typename Seen>
  void simulate(const JointModel& of_all, Seen&& seen) const;

  struct Place {  // of a sample between two steps
    std::size_t step;
    double share;
  };
  bench::BenchRun run_;
  double step_s_;
  double start_reading_rad_;
  std::vector<sim::ActuatorInput> inputs_;  // one a sample
  std::vector<std::size_t> sample_of_step_;
  std::vector<double> q_cmd_of_step_rad_;
  std::vector<Place> place_of_sample_;
};

/// Simulation step for a bench: the SIL's 2 ms, or less for a faster recording. Implicit damping acts like an
/// additional inertia of step times damping, and a fit would subtract that from the rotor's inertia.
double simulation_step_s(const bench::Bench& bench);

}  // namespace pmg::calib
