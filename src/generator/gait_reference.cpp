#include "generator/gait_reference.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "generator/published_gait.hpp"

namespace pmg::generator {
namespace {

double sample_phase(std::size_t sample) { return static_cast<double>(sample) / static_cast<double>(kClipSamples); }

struct PlanarPose {
  double x = 0.0, y = 0.0, yaw = 0.0;
};

/// Pose of a stance foot in the base frame, `seconds` after the middle of its stance: the ground moves with -velocity.
PlanarPose carried(const PlanarPose& middle, const Eigen::Vector3d& velocity, double seconds) {
  const double turned = -velocity.z() * seconds;
  const double c = std::cos(turned);
  const double s = std::sin(turned);
  return {c * middle.x - s * middle.y - velocity.x() * seconds, s * middle.x + c * middle.y - velocity.y() * seconds,
          middle.yaw + turned};
}

double hermite(double from, double to, double slope_from, double slope_to, double s) {
  const double s2 = s * s;
  const double s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * from + (s3 - 2 * s2 + s) * slope_from + (3 * s2 - 2 * s3) * to + (s3 - s2) * slope_to;
}

}  // namespace

std::vector<LegPose> published_reference(const RobotLegs& legs) {
  const PublishedGait& gait = published_gait();
  std::vector<LegPose> reference(kClipSamples, legs.stand);
  for (std::size_t k = 0; k < kClipSamples; ++k) {
    for (const Foot foot : {kLeft, kRight}) {
      const double phase = sample_phase(k) + (foot == kRight ? 0.5 : 0.0);
      reference[k][foot][kHipPitch] = -(gait.hip_flexion.at_rad(phase) - gait.pelvic_tilt_deg * kRadPerDegree);
      reference[k][foot][kKnee] = gait.knee_flexion.at_rad(phase);
      reference[k][foot][kAnklePitch] = -gait.ankle_dorsiflexion.at_rad(phase);
    }
  }
  return reference;
}

std::vector<LegPose> reversed_reference(const RobotLegs& legs, const LegTrajectory& forward, double forward_duty_factor,
                                        double scale) {
  std::vector<LegPose> reference(kClipSamples, legs.stand);
  const auto lift_off = static_cast<std::size_t>(std::lround(forward_duty_factor * static_cast<double>(kClipSamples)));
  for (std::size_t k = 0; k < kClipSamples; ++k) {
    const std::size_t source = (lift_off + kClipSamples - k) % kClipSamples;
    for (const Foot foot : {kLeft, kRight}) {
      reference[k][foot] += scale * (forward.q[source][foot] - legs.stand[foot]);
    }
  }
  return reference;
}

std::vector<LegPose> stepping_reference(const RobotLegs& legs, const GaitTask& task, const Stepping& stepping) {
  std::vector<LegPose> reference(kClipSamples, legs.stand);
  const double r = task.duty_factor;
  const double T = task.period_s;
  for (const Foot foot : {kLeft, kRight}) {
    const double side = foot == kLeft ? 1.0 : -1.0;
    const FootMotion<double> standing =
        foot_motion<double>(legs.geometry[foot], legs.stand[foot], LegVector<double>::Zero());
    const PlanarPose middle = {standing.p_BF.x(), side * stepping.half_width_m, side * stepping.toe_out_rad};
    // Each foot passes its mean place a quarter of a cycle after its contact, so the feet spread and close equally.
    const auto place = [&](double since_contact) { return carried(middle, task.velocity, T * (since_contact - 0.25)); };
    LegVector<double> q = legs.stand[foot];
    for (std::size_t k = 0; k < kClipSamples; ++k) {
      const double phase = sample_phase(k) - (foot == kRight ? 0.5 : 0.0);
      const double since_contact = phase - std::floor(phase);
      PlanarPose pose = place(since_contact);
      double lift = 0.0;
      if (since_contact > r) {
        const double s = (since_contact - r) / (1.0 - r);
        const PlanarPose from = place(r);
        const PlanarPose to = place(0.0);
        const PlanarPose before = place(r - 1e-4);
        const PlanarPose after = place(1e-4);
        const double scale = (1.0 - r) / 1e-4;
        const auto swing = [&](double PlanarPose::*c) {
          return hermite(from.*c, to.*c, (from.*c - before.*c) * scale, (after.*c - to.*c) * scale, s);
        };
        pose = {swing(&PlanarPose::x), swing(&PlanarPose::y), swing(&PlanarPose::yaw)};
        lift = stepping.lift_m * std::pow(std::sin(std::numbers::pi * s), 2);
      }
      const double sway = task.sway_m * std::cos(2.0 * std::numbers::pi * (sample_phase(k) - 0.5 * r));
      const Eigen::Matrix3d R = Eigen::AngleAxisd(pose.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
      const Eigen::Vector3d p(pose.x, pose.y - sway, standing.p_BF.z() - stepping.height_m + lift);
      q = reach(legs.geometry[foot], R, p, q);
      reference[k][foot] = q;
    }
  }
  return reference;
}

LegVector<double> reach(const LegGeometry& leg, const Eigen::Matrix3d& R_BF, const Eigen::Vector3d& p_BF,
                        const LegVector<double>& start) {
  LegVector<double> q = start;
  for (int iteration = 0; iteration < 100; ++iteration) {
    Eigen::Matrix<double, 6, kLegJoints> J;
    FootMotion<double> foot;
    for (Eigen::Index i = 0; i < kLegJoints; ++i) {
      foot = foot_motion<double>(leg, q, LegVector<double>::Unit(i));
      J.col(i) << foot.v_BF, foot.omega_BF;
    }
    const Eigen::AngleAxisd turn(R_BF * foot.R_BF.transpose());
    Eigen::Matrix<double, 6, 1> error;
    error << p_BF - foot.p_BF, turn.angle() * turn.axis();
    if (error.head<3>().norm() < 1e-8 && error.tail<3>().norm() < 1e-8) {
      return q;
    }
    const Eigen::Matrix<double, 6, 6> damped = J.transpose() * J + 1e-8 * Eigen::Matrix<double, 6, 6>::Identity();
    LegVector<double> step = damped.ldlt().solve(J.transpose() * error);
    const double largest = step.cwiseAbs().maxCoeff();
    q += largest > 0.2 ? LegVector<double>(step * (0.2 / largest)) : step;
    if (iteration == 99 && error.head<3>().norm() < 1e-4 && error.tail<3>().norm() < 1e-4) {
      return q;
    }
  }
  throw std::runtime_error("a foot can't be reached: the legs are too short for the posture asked of them");
}

}  // namespace pmg::generator
