#include "diagnosis/diagnosis_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "data_faults/data_faults_report.hpp"
#include "evidence/thresholds.hpp"
#include "residual_torque/extension_report.hpp"

namespace pmg::diagnosis {

namespace {

using Json = nlohmann::ordered_json;

/// JSON has no infinity: null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json interval_json(const evidence::Interval& interval) {
  return {{"value", number(interval.value)}, {"low", number(interval.low)}, {"high", number(interval.high)}};
}

Json cause_json(const Cause& cause) {
  Json parameters = Json::object();
  for (const evidence::ParameterEstimate& parameter : cause.parameters) {
    parameters[parameter.name] = interval_json(parameter.estimate);
    parameters[parameter.name]["unit"] = parameter.unit;
  }
  return {{"effect", cause.effect},
          {"form", cause.form},
          {"form_or_instead", cause.form_or_instead},
          {"parameters", parameters},
          {"held_out_error_before", number(cause.held_out_error_before)},
          {"held_out_error_after", number(cause.held_out_error_after)},
          {"evidence", cause.evidence},
          {"or_instead", cause.or_instead},
          {"same_here", cause.same_here}};
}

Json run_json(const NextRun& run) {
  return {{"trajectory", run.name},
          {"shape", run.shape},
          {"times", run.times},
          {"kp", run.kp},
          {"kd", run.kd},
          {"load_mass_kg", run.load_mass_kg},
          {"load_length_m", run.load_length_m},
          {"duration_s", run.t_s.empty() ? 0.0 : run.t_s.back()}};
}

Json excitation_json(const NextExcitation& next) {
  Json json = {
      {"text", next.text}, {"tells_apart", next.tells_apart}, {"runs", Json::array()}, {"expected", Json::array()}};
  for (const NextRun& run : next.runs) json["runs"].push_back(run_json(run));
  for (const ExpectedPair& pair : next.pairs) {
    json["expected"].push_back({{"effects", {pair.first, pair.second}}, {"deviations", number(pair.deviations)}});
  }
  return json;
}

Json odd_runs_json(const std::vector<bench::OddRun>& odd_runs) {
  Json json = Json::array();
  for (const bench::OddRun& odd : odd_runs) {
    json.push_back(
        {{"run", odd.run}, {"why", odd.why}, {"deviation", number(odd.deviation_rad)}, {"left_out", odd.left_out}});
  }
  return json;
}

/// Errors of the integrator are rms ones in the diagnosis' unit.
Json integration_json(const Diagnosis& diagnosis) {
  const calib::ChosenStep& step = diagnosis.step;
  Json of_runs = Json::array();
  for (const double error : step.error.of_run_rad) of_runs.push_back(number(error));
  return {{"step_s", step.error.step_s},
          {"why", name(step.limit)},
          {"error", number(step.error.rms_rad)},
          {"error_after", number(diagnosis.step_error_after.rms_rad)},
          {"error_of_runs", of_runs},
          {"first_step_s", step.first.step_s},
          {"first_error", number(step.first.rms_rad)}};
}

}  // namespace

Json diagnosis_json(const Diagnosis& diagnosis) {
  Json json = {{"verdict", name(diagnosis.verdict)}, {"causes", Json::array()}, {"rejected", Json::array()}};
  for (const Cause& cause : diagnosis.causes) json["causes"].push_back(cause_json(cause));
  for (const Rejected& rejected : diagnosis.rejected) {
    json["rejected"].push_back(
        {{"effect", rejected.effect}, {"why", rejected.why}, {"looked_at", name(rejected.looked_at)}});
  }
  work::add_to(json, worth_of(diagnosis));
  json["interrupted"] = diagnosis.verdict == evidence::Verdict::kInterrupted;
  json["standing_still_error"] = number(diagnosis.standing_still);
  data_faults::add_to(json, diagnosis.data);
  json["noise_floor"] = number(diagnosis.noise_floor.mean_absolute_rad);
  json["noise_floor_from"] = diagnosis.noise_floor.how;
  json["noise_floor_rms"] = number(diagnosis.noise_floor.rms_rad);
  json["odd_runs"] = odd_runs_json(diagnosis.noise_floor.odd_runs);
  json["integration"] = integration_json(diagnosis);
  json["held_out_error_before"] = number(diagnosis.held_out_before.value);
  json["held_out_error_after"] = number(diagnosis.held_out_after.value);
  json["held_out_error_before_interval"] = {number(diagnosis.held_out_before.low),
                                            number(diagnosis.held_out_before.high)};
  json["held_out_error_after_interval"] = {number(diagnosis.held_out_after.low), number(diagnosis.held_out_after.high)};
  json["share_of_way_to_floor"] = number(diagnosis.share_of_way_to_floor);
  json["scored_on_held_out_runs"] = diagnosis.held_out;
  json["unit"] = diagnosis.unit;
  assembly::add_to(json, diagnosis.assemblies);
  json["before_over_noise"] = number(diagnosis.before_over_noise);
  json["after_over_noise"] = number(diagnosis.after_over_noise);
  json["depends_on"] = diagnosis.depends_on;
  if (diagnosis.residual_extension)
    json["residual_extension"] = residual_torque::extension_json(*diagnosis.residual_extension);
  json["base_parameters"] = diagnosis.base_parameters;
  json["next_excitation"] = diagnosis.next_excitation ? excitation_json(*diagnosis.next_excitation) : Json(nullptr);
  json["options"] = evidence::thresholds_json(diagnosis.options);
  return json;
}

}  // namespace pmg::diagnosis
