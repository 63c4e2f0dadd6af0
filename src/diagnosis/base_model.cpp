#include "diagnosis/base_model.hpp"

#include <cmath>

#include "calib/motor_fit.hpp"
#include "diagnosis/catalogue.hpp"

namespace pmg::diagnosis {

namespace {

struct Tolerance {
  const char* name;
  double share;  ///< of the value
};

// What a careful bench engineer's numbers are good for: gains and scales to a few percent, friction and a rotor's
// inertia, which change from day to day or come from a data sheet, to a tenth.
constexpr Tolerance kTolerances[] = {
    {"drive.kp_scale", 0.02},
    {"drive.kd_scale", 0.03},
    {"drive.torque_per_unit_Nm", 0.02},
    {"drive.back_emf_s_per_rad", 0.03},
    {"transmission.armature_kg_m2", 0.1},
    {"friction.viscous_Nm_s_per_rad", 0.1},
    {"friction.coulomb_Nm", 0.1},
    {"friction.stribeck_Nm", 0.1},
    {"friction.load_driving", 0.1},
    {"friction.load_backdriving", 0.1},
    {"command.delay_s", 0.1},
    {"load.inertia_scale", 0.02},
    {"load.gravity_scale", 0.02},
};

constexpr double kDeviation = 0.5;  // of the tolerance: where a calibration's number lies within it

}  // namespace

BaseModel base_model(const bench::Bench& bench, const std::optional<sim::ActuatorParameters>& given,
                     const NestedFit& fit, unsigned threads) {
  BaseModel base;
  base.model.actuator = given.value_or(bench.known);
  std::vector<std::string> free = given ? bench.unknown : calib::basic_parameters(bench);
  if (!given) {  // no joint is without
    for (const char* name : {"friction.coulomb_Nm", "friction.viscous_Nm_s_per_rad"}) {
      if (!contains(free, name)) free.emplace_back(name);
    }
  }
  if (!given) {
    std::vector<calib::FitParameter> parameters;
    for (const std::string& name : free) parameters.push_back(calib::fit_parameter(name, bench));
    calib::FitOptions options;
    options.starts = 4;
    options.runs_while_searching = 8;
    options.threads = threads;
    const calib::FitProblem problem(parameters, base.model, fit.runs());
    base.model = calib::fit(problem.thinned(12), options).model;
  }
  base.scale = scale_of(bench, fit.runs(), base.model);
  for (const std::string& name : free) base.unknowns.push_back(unknown(name, bench, base.scale));
  for (const auto& [name, share] : kTolerances) {
    if (contains(free, name)) continue;
    const double value = calib::value(base.model, name);
    if (value == 0.0) continue;
    Unknown u = unknown(name, bench, base.scale);
    u.lower = value - share * std::abs(value);
    u.upper = value + share * std::abs(value);
    u.logarithmic = false;
    u.typical = std::abs(value);
    u.expected = value;
    u.deviation = kDeviation * share * std::abs(value);
    base.unknowns.push_back(u);
  }
  const NestedModel fitted = fit.fit(base.model, base.unknowns, 20);
  base.model = fitted.model;
  return base;
}

}  // namespace pmg::diagnosis
