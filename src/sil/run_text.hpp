// What a console shows of a run: a line while it lasts, some lines at its end.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "sil/run_measure.hpp"

namespace pmg::sil {

std::string progress_text(const RunProgress& progress);

/// summary: summary_json of this outcome; with "punctuality" where threads ran.
std::string run_text(const RunOutcome& outcome, const nlohmann::ordered_json& summary);

}  // namespace pmg::sil
