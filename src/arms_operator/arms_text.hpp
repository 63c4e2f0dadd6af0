// What a robot's arms do, in words for people and as JSON for machines.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "pmg/types.hpp"
#include "pmg_msgs/arms_state_t.hpp"

namespace pmg::ops {

/// One arm's part of an ARMS_STATE.
struct ArmNews {
  std::int8_t activity = pmg_msgs::arms_state_t::REFERENCE;  ///< REFERENCE to RETURNING
  bool reached = false;
  double error_m = 0.0, error_rad = 0.0;  ///< from the palm to its target
  const double* p_m = nullptr;            ///< three values: of the palm in T [m]
  const double* orientation = nullptr;    ///< four: w, x, y, z
};
ArmNews arm_news(const pmg_msgs::arms_state_t& state, Foot arm);  ///< refers to state

/// "near another link, comes no closer: 0.12 m and 0.30 rad from its target".
std::string arm_text(const ArmNews& arm);
/// Why the arms don't follow the driving source; empty: they do, or no operator has them.
std::string hold_text(const pmg_msgs::arms_state_t& state);
/// Why the last refused message was refused; empty: none was.
const char* refusal_words(std::int8_t refusal) noexcept;

/// Lines for a screen, without line breaks.
std::vector<std::string> arms_lines(const pmg_msgs::arms_state_t& state);
nlohmann::ordered_json arms_json(const pmg_msgs::arms_state_t& state);

}  // namespace pmg::ops
