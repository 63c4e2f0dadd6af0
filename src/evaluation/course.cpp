#include "evaluation/course.hpp"

#include <algorithm>
#include <cmath>

#include "control/control_cycle.hpp"
#include "sil/metrics.hpp"

namespace pmg::evaluation {

void CourseRecorder::add(const sil::RunProgress& now, const model::GroundTruth& truth) {
  if (now.result.reference.phase_rate_per_s > 0.0) gait_period_s_ = 1.0 / now.result.reference.phase_rate_per_s;
  const Eigen::Matrix3d R_WB = truth.q_WB.toRotationMatrix();
  const double heading_rad = std::atan2(R_WB(1, 0), R_WB(0, 0)), c = std::cos(heading_rad), s = std::sin(heading_rad);
  const std::array<double, kVelocityChannels> velocity = {c * truth.v_WB_W.x() + s * truth.v_WB_W.y(),
                                                          c * truth.v_WB_W.y() - s * truth.v_WB_W.x(),
                                                          (R_WB * truth.omega_WB_B).z()};
  course_.time_s.push_back(now.time_s);
  for (std::size_t channel = 0; channel < kChannels; ++channel) {
    course_.asked[channel].push_back(now.step.command.u[channel]);
  }
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    std::vector<double>& sum = travelled_[channel];
    if (sum.empty()) sum.push_back(0.0);
    sum.push_back(sum.back() + velocity[channel]);
    const auto window = std::min(
        sum.size() - 1, static_cast<std::size_t>(std::lround(gait_period_s_ / control::ControlCycle::kPeriod_s)));
    course_.did[channel].push_back((sum.back() - sum[sum.size() - 1 - window]) / static_cast<double>(window));
  }
  const sil::RollPitch torso = sil::roll_pitch(truth.q_WT);
  course_.did[kPitch].push_back(torso.pitch_rad);
  course_.did[kRoll].push_back(torso.roll_rad);
  course_.did[kHeight].push_back(truth.p_WB.z() - standing_height_m_);
}

}  // namespace pmg::evaluation
