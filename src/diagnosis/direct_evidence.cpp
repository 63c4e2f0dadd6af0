#include "diagnosis/direct_evidence.hpp"

#include <algorithm>
#include <cmath>

#include "calib/unknown.hpp"
#include "effects/catalogue.hpp"
#include "effects/strengths.hpp"

namespace pmg::diagnosis {

bool in_base(const std::string& name, const model::ActuatorParameters& base) {
  const std::vector<effects::Form>& forms = effects::effect(name).forms;
  calib::JointModel model;
  model.actuator = base;
  return std::any_of(forms.begin(), forms.end(), [&](const effects::Form& form) {
    return std::any_of(form.parameters.begin(), form.parameters.end(), [&](const std::string& parameter) {
      return calib::value(model, parameter) != calib::value({}, parameter);
    });
  });
}

namespace {

std::vector<MeasuredCause> measured_causes(const std::vector<evidence::Signature>& checks,
                                           const model::ActuatorParameters& base, double noise_rms_rad,
                                           const JointDiagnosisOptions& options) {
  std::vector<MeasuredCause> found;
  for (const evidence::Signature& check : checks) {
    if (check.effect != "quantisation" || check.agreement != evidence::Agreement::kAgrees) continue;
    const double quantum_rad = check.value.value;
    const double rms_rad = quantum_rad / std::sqrt(12.0);  // of the rounding error, uniform over one quantum
    if (quantum_rad < options.coarser_quantum * base.sensor.quantum_rad ||
        rms_rad < options.quantum_of_noise * noise_rms_rad)
      continue;
    found.push_back({check.effect, "sensor.quantum_rad", check.value});
  }
  return found;
}

bool some_check(const std::vector<evidence::Signature>& checks, const std::string& effect,
                evidence::Agreement agreement) {
  return std::any_of(checks.begin(), checks.end(), [&](const evidence::Signature& check) {
    return check.effect == effect && check.agreement == agreement;
  });
}

std::vector<std::string> shown_effects(const std::vector<evidence::Signature>& checks,
                                       const model::ActuatorParameters& base) {
  const std::string thermal = "thermal_drift";
  if (!some_check(checks, thermal, evidence::Agreement::kAgrees) || in_base(thermal, base)) return {};
  return {thermal};
}

/// Effects in doubt. Not `load`: its check compares inertia with weight, and a wrong mass changes both alike.
std::vector<std::string> doubted_effects(const std::vector<evidence::Signature>& checks,
                                         const model::ActuatorParameters& base) {
  std::vector<std::string> found;
  for (const effects::Effect& one : effects::catalogue()) {
    const bool doubted = some_check(checks, one.name, evidence::Agreement::kDisagrees) &&
                         !some_check(checks, one.name, evidence::Agreement::kAgrees) && one.name != "load";
    if (doubted && !in_base(one.name, base)) found.push_back(one.name);
  }
  return found;
}

std::map<std::string, std::vector<double>> evident_effects(const std::vector<evidence::Signature>& checks,
                                                           const model::ActuatorParameters& base, double fastest_rad_s,
                                                           const JointDiagnosisOptions& options) {
  std::map<std::string, std::vector<double>> found;
  for (const evidence::Signature& check : checks) {
    const bool read_off = check.effect == "quantisation";  // measured_causes() decides
    if (check.agreement != evidence::Agreement::kAgrees || read_off || !effects::has_its_sign(check)) continue;
    if (!in_base(check.effect, base))
      found[check.effect] = effects::measured_strength(check, base, fastest_rad_s, options.signatures);
  }
  return found;
}

}  // namespace

DirectEvidence direct_evidence(const std::vector<evidence::Signature>& checks, const model::ActuatorParameters& base,
                               double noise_rms_rad, double fastest_rad_s, const JointDiagnosisOptions& options) {
  return {measured_causes(checks, base, noise_rms_rad, options), shown_effects(checks, base),
          doubted_effects(checks, base), evident_effects(checks, base, fastest_rad_s, options)};
}

}  // namespace pmg::diagnosis
