#include "effects/starts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pmg::effects {

namespace {

/// Stiffness and damping of a shaft that bends by so much under the peak torque.
std::vector<double> shaft(const NominalJoint& joint, double bend_rad) {
  const double rotor = std::max(1e-6, joint.actuator.transmission.armature_kg_m2);
  const double reduced = 1.0 / (1.0 / rotor + 1.0 / joint.scale.inertia_kg_m2);
  const double stiffness = std::max(joint.peak / bend_rad, 5.0 * joint.torque);
  return {stiffness, 0.1 * 2.0 * std::sqrt(stiffness * reduced)};
}

}  // namespace

Starts starts(const Form& form, const calib::JointModel& current, const BenchScale& scale) {
  return form.starts(NominalJoint{.actuator = current.actuator, .scale = scale});
}

Starts each_from(double present, double factor, std::initializer_list<double> shares) {
  Starts found;
  for (const double share : shares) {
    const double value = present + factor * share;
    if (value >= 0.0) found.push_back({value});
  }
  return found;
}

Starts pairs(std::initializer_list<double> first, double first_factor, std::initializer_list<double> second,
             double second_factor) {
  Starts found;
  for (const double a : first) {
    for (const double b : second) found.push_back({a * first_factor, b * second_factor});
  }
  return found;
}

Starts followed_by(double last, Starts values) {
  for (std::vector<double>& one : values) one.push_back(last);
  return values;
}

Starts only_if(bool possible, Starts values) { return possible ? std::move(values) : Starts{}; }

Starts shafts(const NominalJoint& joint) { return {shaft(joint, 0.005), shaft(joint, 0.02), shaft(joint, 0.06)}; }

Starts hardening_shafts(const NominalJoint& joint) {
  Starts found;
  for (const double bend_rad : {0.02, 0.06}) {
    std::vector<double> one = shaft(joint, bend_rad);
    one[0] *= 0.5;
    one.push_back(one[0] / (bend_rad * bend_rad));
    found.push_back(one);
  }
  return found;
}

Starts plays(const NominalJoint& joint, std::initializer_list<double> bends_rad) {
  Starts found;
  for (const double bend_rad : bends_rad) {
    const std::vector<double> one = shaft(joint, bend_rad);
    for (const double play_rad : {0.005, 0.02, 0.06}) found.push_back({play_rad, one[0], one[1]});
  }
  return found;
}

Starts waves(const NominalJoint& joint, double amplitude, double periods, double highest_order) {
  Starts found;
  const double lowest = lowest_order(joint.scale), step = std::clamp(periods * lowest, 0.5, 4.0);
  for (double order = lowest; order <= highest_order; order += step) found.push_back({amplitude, order, 0.0});
  return found;
}

bool feels_bus(const NominalJoint& joint) {
  return joint.actuator.drive.back_emf_s_per_rad > 0.0 && !joint.scale.bus_recorded;
}

}  // namespace pmg::effects
