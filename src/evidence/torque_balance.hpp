// A joint's equation of motion, integrated over short windows of the recordings (weak form).
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "bench/bench.hpp"
#include "evidence/signature_options.hpp"

namespace pmg::evidence {

/// Dead time and rate limit of a command before the drive compares it with its sensor.
struct CommandShape {
  double delay_s = 0.0;
  double rate_limit_rad_s = std::numeric_limits<double>::infinity();
};

/// The joint half-way between two samples.
struct BalancePoint {
  double q_rad = 0.0, dq_rad_s = 0.0;
  double direction = 0.0;                     ///< of motion: clamp(dq / still speed, -1, 1)
  double gravity_Nm = 0.0, load_Nm = 0.0;     ///< torque of the load: G sin(q - hangs_at), and that + I ddq
  double hanging_Nm = 0.0;                    ///< G cos(q - hangs_at)
  double drive = 0.0;                         ///< output of the drive's law [unit of output times supply]
  double recorded_Nm = 0.0;                   ///< recorded torque, or recorded voltage times its constant; NaN without
  double error_rad = 0.0, error_drive = 0.0;  ///< command minus reading, and kp * error * supply
  double temp_C = 0.0;
  double since_turn_s = 0.0;  ///< since the drive's torque last changed its sign
};

using Column = Eigen::VectorXd;

/// Windows of a bench's runs in which the joint moves. A column holds one value per window: the integral of a quantity
/// under the weight w = (1 - x^2)^3, x = -1..1 over the window, scaled to integral(w) = 1. Speeds and accelerations
/// follow by parts, integral(w dq) = -integral(w' q) and integral(w ddq) = integral(w'' q): the readings are not
/// differentiated, so sensor noise hardly biases a regression on them.
class TorqueBalance {
 public:
  /// The bench and the runs must outlive the balance. Windows lie where the drive is on throughout, or off throughout.
  enum class While { kOn, kOff };
  TorqueBalance(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs, const BalanceOptions& options,
                While when = While::kOn);

  std::size_t windows() const { return windows_.size(); }
  bool shaped() const { return shaped_; }  ///< positions are commanded, so the command's shape matters

  Column drive() const;  ///< for the command shape that is set
  void shape(const CommandShape& shape);

  Column acceleration_rad_s2() const;
  Column speed_rad_s() const;
  Column load_inertia_Nm() const;  ///< I ddq

  /// Weighted integral of any function of a BalancePoint.
  template <typename Function>
  Column integral(const Function& function) const {
    Column column(static_cast<Eigen::Index>(windows_.size()));
    for (std::size_t i = 0; i < windows_.size(); ++i) {
      const Window& window = windows_[i];
      double sum = 0.0;
      for (std::size_t k = 0; k < weight_.size(); ++k)
        sum += weight_[k] * function(runs_[window.run][window.first + k]);
      column[static_cast<Eigen::Index>(i)] = sum;
    }
    return column;
  }

  /// Cluster of each window: one second of one run, or one whole run. Windows of a cluster are correlated.
  std::vector<int> clusters(bool whole_runs = false) const;

  double sample_s() const { return sample_s_; }
  double fastest_rad_s() const { return fastest_rad_s_; }  ///< over all runs: 98 % quantile of a run's |dq|

 private:
  struct Window {
    std::size_t run, first;
  };
  void sample_weights(std::size_t count);
  void read(const bench::BenchRun& run);
  void find_windows(std::size_t run);

  const bench::Bench* bench_;
  const std::vector<bench::BenchRun>* source_;
  BalanceOptions options_;
  While when_;
  bool shaped_;
  double sample_s_ = 0.01, fastest_rad_s_ = 0.0;
  std::vector<double> weight_, weight_1_, weight_2_;  // at midpoints: the weight and its derivatives
  std::vector<std::vector<BalancePoint>> runs_;
  std::vector<std::vector<bool>> usable_;
  std::vector<Window> windows_;
};

}  // namespace pmg::evidence
