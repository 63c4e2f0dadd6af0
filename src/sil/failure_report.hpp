// What each injected failure led to, beside what docs/reference/safety.md promises.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "faults/fault.hpp"
#include "sil/failures.hpp"

namespace pmg::sil {

/// (failures, the drives' reactions, the run's faults with stamps since its start) => (an entry each): the failure, the
/// first fault from its beginning on, the bus cycles until the sit-down and until the drives damped, and the page's.
nlohmann::ordered_json failures_json(std::span<const Failure> failures, std::span<const FailureReaction> reactions,
                                     std::span<const faults::Fault> faults);

/// The same as lines of text.
std::string failures_text(const nlohmann::ordered_json& failures);

}  // namespace pmg::sil
