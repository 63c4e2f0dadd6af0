#include "generator/gait_measure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pmg::generator {
namespace {

constexpr double kSoftness_m = 0.0003;  // of the contact point, as in gco/contact_point.cpp

double wrapped(double phase) { return phase - std::floor(phase + 0.5); }

double lowest_height(const LegGeometry& leg, const FootMotion<double>& foot) {
  double lowest = std::numeric_limits<double>::max();
  for (const Eigen::Vector3d& corner : leg.sole) {
    lowest = std::min(lowest, (foot.R_BF * corner + foot.p_BF).z());
  }
  return lowest;
}

/// Smallest and largest y of a sole.
std::pair<double, double> width(const LegGeometry& leg, const FootMotion<double>& foot) {
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();
  for (const Eigen::Vector3d& corner : leg.sole) {
    const double y = (foot.R_BF * corner + foot.p_BF).y();
    low = std::min(low, y);
    high = std::max(high, y);
  }
  return {low, high};
}

struct SampleState {
  PerFoot<FootMotion<double>> foot;
  PerFoot<SoleContact<double>> contact;
  PerFoot<double> lowest{}, weight{}, stance_phase{};
  Eigen::Vector3d base = Eigen::Vector3d::Zero();  ///< vx, vy, omega
  double ground_z = 0.0;
};

SampleState evaluate(const RobotLegs& legs, const LegTrajectory& trajectory, const GaitTiming& timing,
                     std::size_t sample, const BaseMotion& base) {
  SampleState state;
  const double phase = static_cast<double>(sample) / static_cast<double>(trajectory.q.size());
  for (const Foot f : {kLeft, kRight}) {
    FootMotion<double>& foot = state.foot[f];
    foot =
        foot_motion<double>(legs.geometry[f], trajectory.q[sample][f], trajectory.dq_dphi[sample][f] / timing.period_s);
    const Eigen::Vector3d p = base.R_HB * foot.p_BF;
    foot = {base.R_HB * foot.R_BF, p, base.R_HB * foot.v_BF + base.omega_HB.cross(p),
            base.R_HB * foot.omega_BF + base.omega_HB};
    state.contact[f] = sole_contact<double>(legs.geometry[f], foot, kSoftness_m);
    state.lowest[f] = lowest_height(legs.geometry[f], foot);
    state.stance_phase[f] = wrapped(phase - timing.contact_center[f]);
    state.weight[f] = contact_weight(state.stance_phase[f], timing.duty_factor[f]);
  }
  // Weighted least squares over both feet: three velocities each, three unknowns.
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Foot f : {kLeft, kRight}) {
    const SoleContact<double>& c = state.contact[f];
    const Eigen::Matrix3d J{{1.0, 0.0, -c.p.y()}, {0.0, 1.0, c.p.x()}, {0.0, 0.0, 1.0}};
    const Eigen::Vector3d drift(c.v.x(), c.v.y(), state.foot[f].omega_BF.z());
    A += state.weight[f] * J.transpose() * J;
    b -= state.weight[f] * J.transpose() * drift;
  }
  state.base = A.ldlt().solve(b);
  state.ground_z = std::numeric_limits<double>::max();
  for (const Foot f : {kLeft, kRight}) {
    if (std::abs(state.stance_phase[f]) <= 0.5 * timing.duty_factor[f]) {
      state.ground_z = std::min(state.ground_z, state.lowest[f]);
    }
  }
  return state;
}

}  // namespace

GaitTiming timing(double period_s, double duty_factor) {
  return {period_s, {0.5 * duty_factor, 0.5 + 0.5 * duty_factor}, {duty_factor, duty_factor}};
}

std::vector<BaseMotion> hiking_base(const GaitTask& task, double gain) {
  std::vector<BaseMotion> base(kClipSamples);
  for (std::size_t k = 0; k < kClipSamples; ++k) {
    const Roll roll = hike(task, static_cast<double>(k) / static_cast<double>(kClipSamples));
    base[k].R_HB = Eigen::AngleAxisd(gain * roll.angle_rad, Eigen::Vector3d::UnitX()).toRotationMatrix();
    base[k].omega_HB = gain * roll.slope_rad / task.period_s * Eigen::Vector3d::UnitX();
  }
  return base;
}

std::vector<BaseMotion> hiking_base(const GaitTask& task, const Scenario& scenario) {
  std::vector<BaseMotion> base = hiking_base(task, scenario.gain);
  for (std::size_t k = 0; k < scenario.addition.roll.size(); ++k) {
    const Roll& added = scenario.addition.roll[k];
    base[k].R_HB = Eigen::AngleAxisd(added.angle_rad, Eigen::Vector3d::UnitX()) * base[k].R_HB;
    base[k].omega_HB += added.slope_rad / task.period_s * Eigen::Vector3d::UnitX();
  }
  return base;
}

LegTrajectory blend(const RobotLegs& legs, const LegTrajectory& clip, const Scenario& scenario) {
  LegTrajectory out = clip;
  const Addition& addition = scenario.addition;
  for (std::size_t k = 0; k < clip.q.size(); ++k) {
    for (const Foot f : {kLeft, kRight}) {
      out.q[k][f] = legs.stand[f] + scenario.gain * (clip.q[k][f] - legs.stand[f]);
      out.dq_dphi[k][f] = scenario.gain * clip.dq_dphi[k][f];
      if (!addition.q.empty()) {
        out.q[k][f] += addition.q[k % addition.q.size()][f];
      }
      if (!addition.dq_dphi.empty()) {
        out.dq_dphi[k][f] += addition.dq_dphi[k % addition.dq_dphi.size()][f];
      }
    }
  }
  return out;
}

GroundMeasure measure(const RobotLegs& legs, const LegTrajectory& trajectory, const GaitTiming& timing,
                      const std::vector<BaseMotion>& base) {
  const std::size_t n = trajectory.q.size();
  std::vector<SampleState> states;
  for (std::size_t k = 0; k < n; ++k) {
    states.push_back(evaluate(legs, trajectory, timing, k, base.empty() ? BaseMotion{} : base[k]));
  }
  GroundMeasure m;
  m.clearance_m = m.landing_m = m.lowest_swing_m = m.foot_gap_m = m.height_min_m = std::numeric_limits<double>::max();
  m.height_max_m = std::numeric_limits<double>::lowest();
  for (const SampleState& s : states) {
    m.mean_velocity += s.base / static_cast<double>(n);
  }
  std::vector<double> slips;
  for (const SampleState& s : states) {
    m.velocity_range = m.velocity_range.cwiseMax((s.base - m.mean_velocity).cwiseAbs());
    const double height = -s.ground_z - legs.standing_height_m;
    m.height_mean_m += height / static_cast<double>(n);
    m.height_min_m = std::min(m.height_min_m, height);
    m.height_max_m = std::max(m.height_max_m, height);
    m.foot_gap_m = std::min(m.foot_gap_m, width(legs.geometry[kLeft], s.foot[kLeft]).first -
                                              width(legs.geometry[kRight], s.foot[kRight]).second);
    PerFoot<bool> stance{};
    for (const Foot f : {kLeft, kRight}) {
      stance[f] = std::abs(s.stance_phase[f]) <= 0.5 * timing.duty_factor[f];
    }
    for (const Foot f : {kLeft, kRight}) {
      if (stance[kLeft] && stance[kRight]) {
        const SoleContact<double>& c = s.contact[f];
        slips.push_back(
            std::hypot(c.v.x() + s.base.x() - s.base.z() * c.p.y(), c.v.y() + s.base.y() + s.base.z() * c.p.x()));
        m.yaw_slip_max_rad_s = std::max(m.yaw_slip_max_rad_s, std::abs(s.foot[f].omega_BF.z() + s.base.z()));
        m.other_foot_height_m = std::max(m.other_foot_height_m, s.lowest[f] - s.ground_z);
      } else if (!stance[f]) {
        const double r = timing.duty_factor[f];
        const double since = s.stance_phase[f] > 0 ? s.stance_phase[f] - 0.5 * r : s.stance_phase[f] + 1.0 - 0.5 * r;
        const double swing = since / (1.0 - r);
        const double above = s.lowest[f] - s.ground_z;
        const double held = std::min(1.0, 2.0 * s.weight[f]);
        m.lowest_swing_m = std::min(m.lowest_swing_m, above < 0.0 ? (1.0 - held) * above : above);
        if (swing >= 0.3 && swing <= 0.7) {
          m.clearance_m = std::min(m.clearance_m, above);
        } else if (swing > 0.7 && swing <= 0.85) {
          m.landing_m = std::min(m.landing_m, above);
        }
      }
    }
  }
  std::sort(slips.begin(), slips.end());
  for (const double slip : slips) {
    m.slip_mean_m_s += slip / static_cast<double>(slips.size());
  }
  m.slip_p95_m_s = slips.empty() ? 0.0 : slips[(slips.size() - 1) * 95 / 100];
  return m;
}

}  // namespace pmg::generator
