// A diagnosis for machines: diagnosis.json.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "diagnosis/diagnosis.hpp"

namespace pmg::diagnosis {

/// {verdict, causes: [{effect, parameters: {name: {value, low, high, unit}}, held_out_error_before,
/// held_out_error_after, evidence, or_instead}], rejected: [{effect, why}], noise_floor, held_out_error_before,
/// held_out_error_after, unit, next_excitation, ...}. Errors are mean absolute ones in `unit`.
nlohmann::ordered_json diagnosis_json(const Diagnosis& diagnosis);

}  // namespace pmg::diagnosis
