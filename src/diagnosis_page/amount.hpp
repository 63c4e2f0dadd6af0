// How much of a cause a joint has, in a workshop's units.
#pragma once

#include <string>

#include "bench/bench.hpp"
#include "diagnosis/diagnosis.hpp"

namespace pmg::diagnosis_page {

/// Of positions: "0.5 degrees"; "0.03 mm" of a linear axis.
std::string size(const bench::Bench& bench, double value);

/// Of a cause, by its form's first parameter: "0.5 degrees, between 0.4 and 0.6"; "0.67 Nm; the simulation has 0.5";
/// "at most 115 degrees/s"; "1.5 times what the simulation has"; "5.3 degrees, at most 5.7" where the number's own
/// interval contains its value without the cause, or all but: the cause is sure by all of its numbers. Empty where no
/// workshop has a unit for it and the simulation has none of it, such as a friction per kelvin.
std::string amount(const bench::Bench& bench, const diagnosis::Diagnosis& diagnosis, const diagnosis::Cause& cause);

}  // namespace pmg::diagnosis_page
