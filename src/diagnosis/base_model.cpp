#include "diagnosis/base_model.hpp"

#include <algorithm>
#include <cmath>

#include "calib/motor_fit.hpp"
#include "effects/catalogue.hpp"
#include "effects/folds.hpp"

namespace pmg::diagnosis {

namespace {

constexpr const char* kPresliding = "friction.presliding_rad";
constexpr const char* kBrake = "drive.brake_when_disabled";
constexpr double kPreslidingDifference = 0.2;  // of the logarithm: less is lost among the jumps of a joint that sticks
constexpr int kBaseIterations = 20;

struct Tolerance {
  const char* name;
  work::Threshold JointDiagnosisOptions::*share;  ///< of the value
};

using Options = JointDiagnosisOptions;
constexpr Tolerance kTolerances[] = {
    {"drive.kp_scale", &Options::gain_tolerance},
    {"drive.kd_scale", &Options::damping_tolerance},
    {"drive.torque_per_unit_Nm", &Options::gain_tolerance},
    {"drive.back_emf_s_per_rad", &Options::damping_tolerance},
    {"transmission.armature_kg_m2", &Options::friction_tolerance},
    {"friction.viscous_Nm_s_per_rad", &Options::friction_tolerance},
    {"friction.coulomb_Nm", &Options::friction_tolerance},
    {"friction.stribeck_Nm", &Options::friction_tolerance},
    {"friction.load_driving", &Options::friction_tolerance},
    {"friction.load_backdriving", &Options::friction_tolerance},
    {"command.delay_s", &Options::friction_tolerance},
    {"load.inertia_scale", &Options::load_tolerance},
    {"load.gravity_scale", &Options::load_tolerance},
};

/// Dry friction gives way a little before it slides. How far no data sheet says, and no effect of the catalogue is made
/// of it: about the model's value and the usual one. Joints that stick ideally have a tenth of that.
calib::Unknown presliding(const bench::Bench& bench, const JointDiagnosisOptions& options, const BaseModel& base) {
  const double given = base.model.actuator.friction.presliding_rad;
  const auto [lower, upper] = std::minmax(given, bench.known.friction.presliding_rad);
  calib::Unknown u = effects::unknown(kPresliding, bench, base.scale);
  u.lower = lower / options.stiffer_presliding;
  u.upper = upper * options.softer_presliding;
  u.scale = calib::Scale::kLogarithmic;
  u.expected = u.coordinate(given);
  u.deviation = std::log(options.softer_presliding);
  u.difference = kPreslidingDifference;
  return u;
}

calib::Unknowns constants(const bench::Bench& bench, const JointDiagnosisOptions& options, const BaseModel& base) {
  const model::ActuatorParameters::Friction& friction = base.model.actuator.friction;
  const bool dry = friction.coulomb_Nm > 0.0 || friction.stribeck_Nm > 0.0 || friction.load_driving > 0.0 ||
                   friction.load_backdriving > 0.0;
  calib::Unknowns found;
  if (dry) found.push_back(presliding(bench, options, base));
  if (bench.law == bench::DriveLaw::kServoVoltage && base.scale.switches_off)
    found.push_back(effects::unknown(kBrake, bench, base.scale));
  std::erase_if(found, [&](const calib::Unknown& u) { return calib::place_of(base.unknowns, u.name) >= 0; });
  return found;
}

/// A constant that explains most of what is left is free from the start. One that explains less may do so in the place
/// of an effect that the search hasn't found yet: it waits until the effects are chosen.
void free_constants(const effects::NestedFit& fit, const JointDiagnosisOptions& options, double noise_squares,
                    effects::NestedModel fitted, BaseModel& base) {
  const fitting::BlockComparison compare(fit.blocks(), folds(fit), noise_squares);
  for (const calib::Unknown& constant : calib::Unknowns(base.constants)) {
    calib::Unknowns unknowns = base.unknowns;
    unknowns.push_back(constant);
    effects::NestedModel with = fit.fit(base.model, unknowns, kBaseIterations);
    const double rest = fitted.squares - noise_squares * fit.blocks().all_samples();
    if (!(rest > 0.0) || fitted.squares - with.squares < options.constant_gain_of_rest * rest) continue;
    for (effects::NestedModel* model : {&fitted, &with}) {
      if (model->blocks.empty()) fit.linearise(*model);
    }
    const fitting::Comparison gain =
        compare(fit.held_out_squares(fitted, compare.folds()), fit.held_out_squares(with, compare.folds()));
    if (gain.deviations < options.least_deviations) continue;
    std::erase(base.constants, constant);
    base.unknowns = unknowns;
    base.model = with.model;
    fitted = std::move(with);
  }
}

}  // namespace

BaseModel base_model(const bench::Bench& bench, const std::optional<model::ActuatorParameters>& given,
                     const effects::NestedFit& fit, const JointDiagnosisOptions& options, double noise_squares,
                     unsigned threads) {
  BaseModel base;
  base.model.actuator = given.value_or(bench.known);
  std::vector<std::string> free = given ? bench.unknown : calib::basic_parameters(bench);
  if (!given) {
    calib::add_missing(free, {"friction.coulomb_Nm", "friction.viscous_Nm_s_per_rad"});  // every joint has friction
    calib::Unknowns parameters;
    for (const std::string& name : free) parameters.push_back(calib::unknown(name, bench));
    const calib::FitOptions search{.starts = 4, .runs_while_searching = 8, .threads = threads};
    const calib::FitProblem problem(parameters, base.model, fit.runs());
    base.model = calib::fit(problem.thinned(12), search).model;
  }
  base.scale = effects::scale_of(bench, fit.runs(), base.model);
  for (const std::string& name : free) base.unknowns.push_back(effects::unknown(name, bench, base.scale));
  for (const auto& [name, member] : kTolerances) {
    const double share = options.*member;
    if (effects::contains(free, name)) continue;
    const double value = calib::value(base.model, name);
    if (value == 0.0) continue;
    calib::Unknown u = effects::unknown(name, bench, base.scale);
    u.lower = value - share * std::abs(value);
    u.upper = value + share * std::abs(value);
    u.scale = calib::Scale::kLinear;
    u.typical = std::abs(value);
    u.expected = value;
    u.deviation = options.deviation_of_tolerance * share * std::abs(value);
    base.unknowns.push_back(u);
  }
  base.constants = constants(bench, options, base);
  const effects::NestedModel fitted = fit.fit(base.model, base.unknowns, kBaseIterations);
  base.model = fitted.model;
  free_constants(fit, options, noise_squares, fitted, base);
  return base;
}

}  // namespace pmg::diagnosis
