// A threshold of a diagnosis, with its reason.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace pmg::evidence {

struct Option {
  std::string name;
  double value = 0.0;
  std::string unit;    ///< "" for a share, a count or a number of standard deviations
  std::string reason;  ///< the decision that depends on it
  std::string set_on;  ///< the data it was tuned on, or "assumed"
};

/// [{name, value, unit, reason, set_on}], in the order given.
nlohmann::ordered_json options_json(const std::vector<Option>& options);

}  // namespace pmg::evidence
