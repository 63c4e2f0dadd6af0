#include "calib/fit_results.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

namespace pmg::calib {

namespace {

using Json = nlohmann::ordered_json;

Json error_json(const RolloutError& error) {
  return {{"mean_absolute", error.mean_absolute_rad()}, {"rms", std::sqrt(error.mean_square_rad2())}};
}

Json assessment_json(const Assessment& assessment) {
  std::size_t dropouts = 0;
  for (const SingleJoint& joint : *assessment.runs) dropouts += joint.run().recording.dropouts();
  const RolloutError after = total(assessment.after);
  Json json = {{"filter", assessment.filter},
               {"runs", assessment.runs->size()},
               {"samples", after.samples},
               {"sensor_dropouts_left_out", dropouts},
               {"error_before", error_json(total(assessment.before))},
               {"error_after", error_json(after)},
               {"by_run", Json::array()}};
  for (std::size_t i = 0; i < assessment.runs->size(); ++i) {
    json["by_run"].push_back(
        {{"file", (*assessment.runs)[i].run().file}, {"mean_absolute", assessment.after[i].mean_absolute_rad()}});
  }
  return json;
}

Json inverse_json(const InverseDynamics& found) {
  const auto estimate = [](const InverseDynamics::Estimate& e) -> Json {
    return {{"value", e.value}, {"deviation", e.deviation}};
  };
  return {{"transmission.armature_kg_m2", estimate(found.armature_kg_m2)},
          {"friction.viscous_Nm_s_per_rad", estimate(found.viscous_Nm_s_per_rad)},
          {"friction.coulomb_Nm", estimate(found.coulomb_Nm)},
          {"ripple.offset_Nm", estimate(found.offset_Nm)},
          {"coulomb_forward_Nm", found.coulomb_forward_Nm()},
          {"coulomb_backward_Nm", found.coulomb_backward_Nm()},
          {"possible", possible(found)},
          {"residual_Nm", found.residual_Nm},
          {"unresolved", found.unresolved},
          {"windows", found.windows}};
}

Json noise_json(const bench::NoiseFloor& floor) {
  return {{"pairs", floor.pairs.size()},
          {"mean_absolute", floor.mean_absolute_rad},
          {"mean_absolute_low", floor.mean_absolute_low_rad},
          {"mean_absolute_high", floor.mean_absolute_high_rad},
          {"rms", floor.rms_rad},
          {"difference_mean_absolute", floor.difference_mean_absolute_rad}};
}

/// JSON has no infinity: null.
Json parameter_json(const bench::Bench& bench, const Unknown& parameter, double value, const Confidence& confidence) {
  Json json = {{"value", value},
               {"deviation", std::isfinite(confidence.deviation) ? Json(confidence.deviation) : Json(nullptr)},
               {"unit", unit_on_rig(parameter.unit(), bench)},
               {"lower", parameter.lower},
               {"upper", parameter.upper},
               {"at_bound", at_bound(parameter, value)}};
  if (!confidence.told_only_with.empty()) json["told_only_with"] = confidence.told_only_with;
  if (!confidence.confounded_with.empty()) json["told_apart_badly_from"] = confidence.confounded_with;
  return json;
}

}  // namespace

std::string position_unit(const bench::Bench& bench, bool thousandths) {
  return std::string(thousandths ? "m" : "") + (bench.rig == bench::Rig::kLinear ? "m" : "rad");
}

std::string unit_on_rig(std::string unit, const bench::Bench& bench) {
  if (bench.rig != bench::Rig::kLinear) return unit;
  for (const auto& [turning, linear] : {std::pair{"kg m^2", "kg"}, {"Nm", "N"}, {"rad", "m"}}) {
    for (std::size_t at = 0; (at = unit.find(turning, at)) != std::string::npos;)
      unit.replace(at, std::string_view(turning).size(), linear);
  }
  return unit;
}

bool at_bound(const Unknown& parameter, double value) {
  const double edge = 1e-3 * (parameter.upper - parameter.lower);
  if (parameter.lower > 0.0) return value <= 1.01 * parameter.lower || value >= 0.99 * parameter.upper;
  return value >= parameter.upper - edge || (parameter.lower < 0.0 && value <= parameter.lower + edge);
}

std::string deviation_text(const Confidence& confidence) {
  return std::isfinite(confidence.deviation) ? fmt::format("{:.2g}", confidence.deviation) : "?";
}

std::string reservation(const Unknown& parameter, double value, const Confidence& confidence) {
  if (at_bound(parameter, value)) return "at its range's edge";
  if (!confidence.told_only_with.empty())
    return fmt::format("not determined: other values move the same with another {}",
                       fmt::join(confidence.told_only_with, ", "));
  if (!std::isfinite(confidence.deviation)) return "these runs don't show it";
  if (!confidence.confounded_with.empty()) return "hard to tell from " + confidence.confounded_with;
  return "";
}

bool take_inverse_dynamics(const InverseDynamics& found, const bench::Bench& bench, JointModel& start,
                           Unknowns& unknowns) {
  const double viscous = found.viscous_Nm_s_per_rad.value, coulomb_Nm = found.coulomb_Nm.value;
  const std::pair<const char*, double> determined[] = {
      {"transmission.armature_kg_m2", std::max(0.0, found.armature_kg_m2.value)},
      {"friction.viscous_Nm_s_per_rad", std::max(0.0, viscous)},
      {"friction.coulomb_Nm", std::max(0.0, coulomb_Nm)},
      {"ripple.offset_Nm", found.offset_Nm.value},
  };
  for (const auto& [name, value] : determined) {
    std::erase_if(unknowns, [name = name](const Unknown& p) { return p.name == name; });
    if (possible(found))
      set(start, name, value);
    else
      unknowns.push_back(unknown(name, bench));
  }
  if (unknowns.empty()) unknowns.push_back(unknown("sensor.velocity_lag_s", bench));
  return possible(found);
}

Assessment assess(const std::string& filter, const std::vector<SingleJoint>& runs, const JointModel& before,
                  const JointModel& after, unsigned threads) {
  return {filter, &runs, errors(before, runs, threads), errors(after, runs, threads)};
}

RolloutError standing_still(const std::vector<SingleJoint>& runs) {
  RolloutError sum;
  for (const SingleJoint& joint : runs) {
    const bench::Recording& r = joint.run().recording;
    double mean_rad = 0.0, samples = 0.0;
    for (std::size_t k = 0; k < r.q_rad.size(); ++k) {
      if (r.valid[k]) mean_rad += r.q_rad[k], ++samples;
    }
    mean_rad /= samples;
    for (std::size_t k = 0; k < r.q_rad.size(); ++k) {
      if (!r.valid[k]) continue;
      sum.sum_of_squares_rad2 += (r.q_rad[k] - mean_rad) * (r.q_rad[k] - mean_rad);
      sum.sum_of_absolutes_rad += std::abs(r.q_rad[k] - mean_rad);
      ++sum.samples;
    }
  }
  return sum;
}

work::Worth worth_of(const FitResults& results) {
  const Assessment& judged = results.scored ? *results.scored : results.fitted;
  const RolloutError before = total(judged.before), after = total(judged.after), still = standing_still(*judged.runs);
  const std::string unit = position_unit(*results.bench, true);
  work::Worth worth = results.data;
  worth.add_if(results.fit.interrupted, work::Grade::kInterrupted,
               fmt::format("the best of {} evaluations, not the best fit", results.fit.evaluations));
  worth.add_if(!(after.mean_absolute_rad() < kExplainedShare * still.mean_absolute_rad()), work::Grade::kOffItsData,
               fmt::format("the model misses the readings by {:.3g} {}, a joint that stands still would by {:.3g}",
                           1e3 * after.mean_absolute_rad(), unit, 1e3 * still.mean_absolute_rad()));
  worth.add_if(!(after.mean_absolute_rad() < before.mean_absolute_rad()), work::Grade::kNoBetter,
               "the fit is no better than the model that it began with");
  for (std::size_t i = 0; i < results.confidence.size(); ++i) {
    const Unknown& p = results.problem->parameters()[i];
    if (at_bound(p, value(results.fit.model, p.name)))
      worth.add(work::Grade::kOpen, p.name + " is at its range's edge");
    else if (results.confidence[i].told_only_with.empty() && !std::isfinite(results.confidence[i].deviation))
      worth.add(work::Grade::kOpen, "these runs don't show " + p.name);
  }
  std::set<std::string> alike;
  for (std::size_t i = 0; i < results.confidence.size(); ++i) {
    if (!results.confidence[i].told_only_with.empty()) alike.insert(results.problem->parameters()[i].name);
  }
  worth.add_if(!alike.empty(), work::Grade::kOpen,
               fmt::format("these runs don't determine {}: other values of them together move the joint the same",
                           fmt::join(alike, ", ")));
  return worth;
}

Json fit_json(const FitResults& results) {
  Json json = {{"bench", results.bench->folder.string()},      {"joint", results.joint},
               {"unit", position_unit(*results.bench, false)}, {"optimizer", results.method},
               {"interrupted", results.fit.interrupted},       {"parameters", Json::object()}};
  add_to(json, worth_of(results));
  for (std::size_t i = 0; i < results.confidence.size(); ++i) {
    const Unknown& parameter = results.problem->parameters()[i];
    json["parameters"][parameter.name] =
        parameter_json(*results.bench, parameter, value(results.fit.model, parameter.name), results.confidence[i]);
  }
  if (results.bench->law == bench::DriveLaw::kPositionPd) {  // with the same gains in all runs
    const bench::BenchRun& run = results.problem->runs().front().run();
    json["gains"] = {{"kp_Nm_per_rad", results.fit.model.actuator.drive.kp_scale * run.kp},
                     {"kd_Nm_s_per_rad", results.fit.model.actuator.drive.kd_scale * run.kd}};
  }
  if (results.inverse) {
    json["inverse_dynamics"] = inverse_json(*results.inverse);
    json["inverse_dynamics"]["taken"] = results.inverse_taken;
    const std::string meaning = meaning_of_negative(*results.inverse);
    json["inverse_dynamics"]["meaning_of_negative"] = meaning.empty() ? Json(nullptr) : Json(meaning);
  }
  if (!results.noise_floor.pairs.empty()) json["noise_floor"] = noise_json(results.noise_floor);
  json["fit"] = assessment_json(results.fitted);
  if (results.scored) json["score"] = assessment_json(*results.scored);
  json["evaluations"] = results.fit.evaluations;
  json["simulated_s"] = results.fit.simulated_s;
  json["wall_s"] = results.wall_s;
  json["threads"] = results.threads;
  json["start_losses"] = Json::array();
  for (const Found& start : results.fit.starts) json["start_losses"].push_back(start.loss);
  return json;
}

std::vector<std::string> motor_remarks(const FitResults& results) {
  const std::string unit = position_unit(*results.bench, true);
  const auto line = [&](const char* what, const Assessment& assessment) {
    return fmt::format("{} {} runs ({}): mean absolute error {:.4g} {}", what, assessment.runs->size(),
                       assessment.filter.empty() ? "all" : assessment.filter,
                       1e3 * total(assessment.after).mean_absolute_rad(), unit);
  };
  std::vector<std::string> remarks = {
      fmt::format("Written by pmg_calibrate_motor from {}", results.bench->folder.filename().string()),
      line("fitted to", results.fitted)};
  if (const std::string worth = worth_of(results).sentence(); !worth.empty()) remarks.insert(remarks.begin(), worth);
  if (results.scored) remarks.push_back(line("scored on", *results.scored));
  return remarks;
}

}  // namespace pmg::calib
