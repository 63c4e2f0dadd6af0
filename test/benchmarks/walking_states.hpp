// Postures and velocities of z1 for the benchmarks of kinematics and optimisation, which cycle through them.
#pragma once

#include <array>
#include <cmath>
#include <filesystem>

#include "folders.hpp"
#include "model/robot_model.hpp"
#include "pmg/reference.hpp"

namespace pmg::test {

/// Both feet in contact, with a disagreement as in a blend of clips: the most expensive case for the optimisation.
struct WalkingStates {
  static constexpr std::size_t kCount = 64;

  WalkingStates() : robot(model::load_robot(std::filesystem::path(pmg::test::project_folder()) / "config/robots/z1")) {
    for (std::size_t k = 0; k < kCount; ++k) {
      Reference& reference = states[k];
      reference.q = robot.q_stand();
      reference.dq = JointVector::Zero(reference.q.size());
      for (Eigen::Index i = 0; i < reference.q.size(); ++i) {
        const double angle = 0.1 * static_cast<double>(k) + 1.7 * static_cast<double>(i);
        reference.q[i] += 0.1 * std::sin(angle);
        reference.dq[i] = 0.6 * std::cos(angle);
      }
      reference.contact = {true, true};
      reference.contact_weight = {1.0, 0.5 + 0.5 * static_cast<double>(k) / kCount};
      reference.command = {{0.4, 0.1, 0.2, 0.1, 0.05, -0.03}};
      reference.command_rate = {{0.1, 0.1, 0.1, 0.1, 0.1, 0.1}};
    }
  }
  const Reference& at(std::size_t tick) const { return states[tick % kCount]; }

  model::RobotModel robot;
  std::array<Reference, kCount> states;
};

}  // namespace pmg::test
