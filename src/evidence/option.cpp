#include "evidence/option.hpp"

#include <nlohmann/json.hpp>

namespace pmg::evidence {

nlohmann::ordered_json options_json(const std::vector<Option>& options) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Option& o : options) {
    json.push_back(
        {{"name", o.name}, {"value", o.value}, {"unit", o.unit}, {"reason", o.reason}, {"set_on", o.set_on}});
  }
  return json;
}

}  // namespace pmg::evidence
