// A robot's diagnosis for machines and for people.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "pages/page.hpp"
#include "robot_diagnosis/robot_diagnosis.hpp"
#include "work/worth.hpp"

namespace pmg::robot_diagnosis {

/// {verdict, causes: [{effect, place, parameters: {name: {value, low, high, unit}}, log_evidence, folds_better, folds,
/// or_instead}], rejected: [{effect, place, log_evidence}], ground_friction, coverage_s, held_out_error_before,
/// held_out_error_after, unit, depends_on, not_seen, next_excitation}.
nlohmann::ordered_json robot_diagnosis_json(const RobotDiagnosis& diagnosis);

/// Off its data, where left-out equations miss by more than kMostOfNoise; no better with the causes; missed, where the
/// verdict is unexplained; open, where causes can't be told apart. An interrupted diagnosis leaves nothing.
work::Worth worth_of(const RobotDiagnosis& diagnosis);
inline constexpr double kMostOfNoise = 5.0;  ///< rms of left-out equations over their noise

/// The same for people, a few lines.
std::string robot_diagnosis_text(const RobotDiagnosis& diagnosis);

pages::Page robot_diagnosis_page(const std::string& robot, const RobotDiagnosis& diagnosis);

}  // namespace pmg::robot_diagnosis
