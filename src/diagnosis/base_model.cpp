#include "diagnosis/base_model.hpp"

#include <cmath>

#include "calib/motor_fit.hpp"
#include "effects/catalogue.hpp"

namespace pmg::diagnosis {

namespace {

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

}  // namespace

BaseModel base_model(const bench::Bench& bench, const std::optional<model::ActuatorParameters>& given,
                     const effects::NestedFit& fit, const JointDiagnosisOptions& options, unsigned threads) {
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
  const effects::NestedModel fitted = fit.fit(base.model, base.unknowns, 20);
  base.model = fitted.model;
  return base;
}

}  // namespace pmg::diagnosis
