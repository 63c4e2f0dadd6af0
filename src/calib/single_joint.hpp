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
  double feed_forward_scale = 1.0;                  ///< of the recorded feed-forward
};

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

  /// (model) => (simulated reading at each sample of the recording [rad]). Open loop, from rest at the recording's
  /// first position. There dry friction balances gravity minus drive torque, up to its limit.
  std::vector<double> rollout(const JointModel& model) const;

  RolloutError error(const JointModel& model) const;

  const bench::BenchRun& run() const { return run_; }
  double step_s() const { return step_s_; }
  std::size_t steps() const { return sample_of_step_.size(); }
  sim::ActuatorInput input(std::size_t step) const;
  double start_rad(const JointModel& model) const {
    return sim::ActuatorModel::joint_rad(model.actuator.sensor, start_reading_rad_);
  }

 private:
  template <typename Seen>
  void simulate(const JointModel& model, Seen&& seen) const;

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
