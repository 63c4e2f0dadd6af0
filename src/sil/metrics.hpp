// (command, ground truth) => (tracking errors, fall): the metrics of summary.json (docs/reference/file-formats.md).
#pragma once

#include <cstddef>
#include <vector>

#include "pmg/command.hpp"
#include "sim/world.hpp"

namespace pmg::sil {

/// Mean absolute errors against the user's command over all judged ticks. A tick's error is (measured - commanded),
/// averaged over the gait period that ends there; `raw`: the tick's own, without the averaging.
struct TrackingSummary {
  double lin_vel_mae_m_s = 0.0, lin_vel_raw_mae_m_s = 0.0;  ///< norm of the xy error in H
  double yaw_vel_mae_rad_s = 0.0, yaw_vel_raw_mae_rad_s = 0.0;
  double roll_mae_rad = 0.0, roll_raw_mae_rad = 0.0;    ///< torso link in H
  double pitch_mae_rad = 0.0, pitch_raw_mae_rad = 0.0;  ///< torso link in H
  double height_mae_m = 0.0, height_raw_mae_m = 0.0;    ///< pelvis origin above ground
  double foot_slip_mean_m_s = 0.0;                      ///< feet that carry load, both counted
  double followed_s = 0.0;                              ///< how long errors were accumulated
};

class Metrics {
 public:
  static constexpr double kFallenHeightShare = 0.6;  ///< of the standing height
  static constexpr double kFallenTilt_rad = 1.0;     ///< of the torso

  Metrics(double standing_height_m, double dt_s);

  /// One tick. The heading frame H has its x along the pelvis' yaw averaged over one gait period. After a fall velocity
  /// and height count as zero and attitude as measured.
  void add(const model::GroundTruth& truth, const Command& user, double gait_period_s);

  /// A tick that isn't judged (on the gantry, drives released before standing). Averages start anew after it.
  void skip(const model::GroundTruth& truth);

  bool fell() const { return fell_; }
  double fell_at_s() const { return fell_at_s_; }  ///< negative: did not fall
  TrackingSummary summary() const;

 private:
  struct Sample {
    double cos_yaw = 1.0, sin_yaw = 0.0;  // pelvis
    double error_x_m_s = 0.0, error_y_m_s = 0.0, error_yaw_rad_s = 0.0;
    double error_roll_rad = 0.0, error_pitch_rad = 0.0, error_height_m = 0.0;
  };
  void watch_for_fall(const model::GroundTruth& truth);
  Sample& push();
  /// Mean over the newest samples of one gait period, fewer at the start.
  Sample average(double gait_period_s) const;

  double standing_height_m_, dt_s_;
  std::vector<Sample> ring_;
  std::size_t newest_ = 0, filled_ = 0;
  bool fell_ = false;
  double fell_at_s_ = -1.0;
  double elapsed_s_ = 0.0;
  std::size_t ticks_ = 0, slip_samples_ = 0;
  TrackingSummary sums_;
};

/// Roll and pitch of an attitude R_WT = Rz(yaw) Ry(pitch) Rx(roll): pitch positive forward, roll positive to the right
/// [rad].
struct RollPitch {
  double roll_rad = 0.0, pitch_rad = 0.0;
};
RollPitch roll_pitch(const Eigen::Quaterniond& q_WT);

}  // namespace pmg::sil
