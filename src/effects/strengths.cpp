#include "effects/strengths.hpp"

#include <algorithm>
#include <cmath>

#include "calib/unknown.hpp"
#include "fitting/covariance.hpp"

namespace pmg::effects {

namespace {

/// Difference of the effect's strengths from neutral, in coordinates; 0 elsewhere.
Eigen::VectorXd from_neutral(const NestedModel& model, const Forms& forms, const calib::JointModel& neutral,
                             const std::string& effect) {
  Eigen::VectorXd away = Eigen::VectorXd::Zero(model.coordinates.size());
  const std::vector<std::string> names = strengths(effect, forms);
  for (Eigen::Index i = 0; i < away.size(); ++i) {
    const calib::Unknown& u = model.unknowns[static_cast<std::size_t>(i)];
    if (contains(names, u.name)) away[i] = model.coordinates[i] - u.coordinate(calib::value(neutral, u.name));
  }
  return away;
}

}  // namespace

std::vector<std::string> strengths(const Effect& effect, const Form& form) {
  std::vector<std::string> found = form.parameters;
  std::erase_if(found, [&](const std::string& name) {
    const model::Quantity quantity = calib::quantity(name);
    return quantity == model::Quantity::kOrder || quantity == model::Quantity::kPhase ||
           quantity == model::Quantity::kTimeConstant || contains(effect.shapes, name);
  });
  return found;
}

std::vector<std::string> strengths(const std::string& name, const Forms& forms) {
  return strengths(effect(name), form_of(name, forms));
}

std::vector<double> measured_strength(const evidence::Signature& check, const model::ActuatorParameters& joint,
                                      double fastest_rad_s, const evidence::SignatureOptions& options) {
  const Effect& of = effect(check.effect);
  const double value = check.value.value;
  if (of.strength == nullptr || !std::isfinite(value)) return {};
  // Of a voltage servo the balance is in volts.
  const double torque_Nm = joint.drive.back_emf_s_per_rad > 0.0 ? value * joint.drive.torque_per_unit_Nm : value;
  return of.strength({value, torque_Nm, joint, options.slow_share * fastest_rad_s});
}

bool has_its_sign(const evidence::Signature& check) {
  return !effect(check.effect).never_negative || !(check.value.value < 0.0);
}

bool has_other_sign(const std::string& effect, const calib::JointModel& model) {
  return effect == "stribeck" && model.actuator.friction.stribeck_Nm < 0.0;
}

bool fades_unseen(const std::string& effect, const Forms& forms, const calib::JointModel& model, double speed_rad_s) {
  if (!contains(form_of(effect, forms).parameters, "friction.stribeck_rad_s")) return false;
  constexpr double kHalf = 0.5;
  const auto& friction = model.actuator.friction;
  return std::exp(-std::pow(speed_rad_s / friction.stribeck_rad_s, friction.stribeck_exponent)) > kHalf;
}

bool at_its_limit(const NestedModel& model) {
  return std::ranges::any_of(model.unknowns, [&](const calib::Unknown& u) {
    const double x = calib::value(model.model, u.name);
    return (u.name == "transmission.stiffness_Nm_per_rad" && x > 0.99 * u.upper) ||
           (u.name == "thermal.torque_fade_s" && x < 1.01 * u.lower);
  });
}

double likeness(const NestedModel& model, const Forms& forms, const calib::JointModel& neutral,
                const std::string& first, const std::string& second) {
  const Eigen::VectorXd one = from_neutral(model, forms, neutral, first),
                        two = from_neutral(model, forms, neutral, second);
  const Eigen::MatrixXd information = fitting::information(model);
  std::vector<Eigen::Index> of, other;
  for (Eigen::Index i = 0; i < one.size(); ++i) {
    if (!(information(i, i) > fitting::kUnseen_rad2)) continue;
    (one[i] != 0.0 || two[i] != 0.0 ? of : other).push_back(i);
  }
  if (of.empty()) return 0.0;
  const Eigen::MatrixXd left = fitting::beyond(information(of, of), information(other, of), information(other, other));
  const Eigen::VectorXd a = one(of), b = two(of);
  const double scale = std::sqrt(a.dot(left * a) * b.dot(left * b));
  return scale > 0.0 ? a.dot(left * b) / scale : 0.0;
}

}  // namespace pmg::effects
