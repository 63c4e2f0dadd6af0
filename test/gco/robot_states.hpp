// Robots and references for the tests of the ground-aware command optimisation.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <random>
#include <string>

#include "folders.hpp"
#include "gco/contact_problem.hpp"
#include "gco/ground_aware_command.hpp"
#include "model/leg_kinematics.hpp"
#include "model/robot_model.hpp"
#include "pmg/reference.hpp"

namespace pmg::test {

/// Paths below the source tree: a full-size humanoid, and a synthetic biped with another joint order and fewer joints.
inline constexpr const char* kRobots[] = {"config/robots/z1", "test/data/robots/biped"};

inline model::RobotModel load(const std::string& robot) {
  return model::load_robot(std::filesystem::path(pmg::test::project_folder()) / robot);
}

/// GoogleTest's name of the instance.
inline std::string robot_name(const testing::TestParamInfo<const char*>& robot) {
  return std::filesystem::path(robot.param).filename().string();
}

/// The robot standing still, both feet in contact, command zero.
inline Reference standing(const model::RobotModel& robot) {
  Reference reference;
  reference.q = robot.q_stand();
  reference.dq = JointVector::Zero(reference.q.size());
  reference.contact = {true, true};
  reference.contact_weight = {1.0, 1.0};
  return reference;
}

inline void set_contact(Reference& reference, double left, double right) {
  reference.contact_weight = {left, right};
  reference.contact = {left >= 0.5, right >= 0.5};
}

/// The same with feet that disagree as in a blend of clips: by centimetres and centimetres per second. The nonlinear
/// problem with free roll and pitch need not converge when feet are decimetres apart.
inline Reference mild(Reference reference, const model::RobotModel& robot) {
  reference.q = robot.q_stand() + 0.2 * (reference.q - robot.q_stand());
  reference.dq *= 0.1;
  return reference;
}

class RandomReferences {
 public:
  RandomReferences(const model::RobotModel& robot, unsigned seed) : robot_(robot), generator_(seed) {}

  double uniform(double lower, double upper) {
    const double unit = static_cast<double>(generator_()) / static_cast<double>(std::mt19937::max());
    return lower + (upper - lower) * unit;
  }

  /// Joints up to 0.3 rad from standing at up to 2 rad/s, any command in range with its rates, both feet in contact.
  Reference next() {
    Reference reference = standing(robot_);
    const JointVector lower = robot_.q_lower(), upper = robot_.q_upper();
    for (Eigen::Index i = 0; i < reference.q.size(); ++i) {
      reference.q[i] = std::clamp(reference.q[i] + uniform(-0.3, 0.3), lower[i], upper[i]);
      reference.dq[i] = uniform(-2.0, 2.0);
    }
    for (std::size_t i = 0; i < kChannels; ++i) {
      reference.command.u[i] = uniform(robot_.command_limits.lower[i], robot_.command_limits.upper[i]);
      const double rate = robot_.command_limits.rate_per_s[i];
      reference.command_rate.u[i] = uniform(-rate, rate);
    }
    return reference;
  }

 private:
  const model::RobotModel& robot_;
  std::mt19937 generator_;
};

/// The terms of a new GroundAwareCommand for this reference (pitch and roll fixed).
class TermsOf {
 public:
  explicit TermsOf(const model::RobotModel& robot) : robot_(robot), legs_(robot), base_attitude_(robot) {}

  gco::ContactTerms operator()(const Reference& reference, double prior_weight = 1e-3) {
    const Command& u = reference.command;
    const Command& rate = reference.command_rate;
    const auto attitude =
        base_attitude_.compute(reference.q, reference.dq, u[kPitch], u[kRoll], rate[kPitch], rate[kRoll]);
    return gco::contact_terms(reference, legs_.compute(reference.q, reference.dq), attitude, robot_.standing_height_m,
                              prior_weight, u[kHeight]);
  }

  /// As operator(), plus GroundAwareCommand's terms for roll and pitch.
  gco::ContactTerms with_attitude(const Reference& reference, double attitude_prior_weight) {
    gco::ContactTerms terms = (*this)(reference);
    const JointVector still = JointVector::Zero(reference.q.size());
    const Eigen::Vector3d pitch_axis_H =
        base_attitude_.compute(reference.q, still, reference.command[kPitch], reference.command[kRoll], 1.0, 0.0)
            .omega_HB_H;
    terms.torso_heading_H = {pitch_axis_H.y(), -pitch_axis_H.x()};
    terms.prior_weight[gco::kXPitch] = std::hypot(terms.prior_weight[gco::kXPitch], attitude_prior_weight);
    terms.prior_weight[gco::kXRoll] = terms.prior_weight[gco::kXPitch];
    return terms;
  }

 private:
  const model::RobotModel& robot_;
  model::LegKinematics legs_;
  model::BaseAttitude base_attitude_;
};

inline std::array<double, gco::kMaxUnknowns> unknowns_of(const gco::Result& result) {
  const Command& u = result.command;
  return {u[kVx], u[kVy], result.vz_m_s, u[kOmega], u[kHeight], u[kPitch], u[kRoll]};
}

template <int kUnknowns>
double cost(const gco::ContactTerms& terms, const std::array<double, gco::kMaxUnknowns>& x) {
  const gco::ContactProblem<kUnknowns> problem{terms};
  Eigen::Matrix<double, gco::ContactProblem<kUnknowns>::NUM_RESIDUALS, 1> r;
  problem(x.data(), r.data(), nullptr);
  return r.squaredNorm() / 2.0;
}

}  // namespace pmg::test
