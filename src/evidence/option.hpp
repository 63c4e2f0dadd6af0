// A number that a diagnosis decides by, with its reason.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace pmg::evidence {

struct Option {
  std::string name;
  double value = 0.0;
  std::string unit;    ///< "" for a share, a count or a number of standard deviations
  std::string reason;  ///< what it decides
  std::string set_on;  ///< the data that it was set on, or "assumed"
};

/// [{name, value, unit, reason, set_on}], in their order.
nlohmann::ordered_json options_json(const std::vector<Option>& options);

}  // namespace pmg::evidence
