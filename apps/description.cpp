#include "description.hpp"

#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

namespace pmg::apps {

namespace {

using nlohmann::ordered_json;

/// The names of "TEXT:one|two", as option_checks.hpp writes them.
std::vector<std::string> values_of(const std::string& type) {
  const std::size_t colon = type.find(':');
  if (colon == std::string::npos || type.find('|') == std::string::npos) return {};
  std::vector<std::string> values;
  std::istringstream names(type.substr(colon + 1));
  for (std::string name; std::getline(names, name, '|');) values.push_back(name);
  return values;
}

ordered_json option_json(const CLI::Option& option) {
  ordered_json names = ordered_json::array();
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  if (option.get_positional()) names.push_back(option.get_name(true, false));
  const bool flag = option.get_items_expected_max() == 0;
  const std::string type = flag ? "" : option.get_type_name();
  return {{"names", names},
          {"type", type},
          {"description", option.get_description()},
          {"default", option.get_default_str()},
          {"required", option.get_required()},
          {"many", option.get_items_expected_max() > 1},
          {"values", values_of(type)}};
}

ordered_json app_json(const CLI::App& app) {
  ordered_json json = {
      {"name", app.get_name()},           {"description", app.get_description()}, {"footer", app.get_footer()},
      {"options", ordered_json::array()}, {"positionals", ordered_json::array()}, {"commands", ordered_json::array()}};
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;  // hidden
    json[option->get_positional() ? "positionals" : "options"].push_back(option_json(*option));
  }
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    json["commands"].push_back(app_json(*command));
  return json;
}

}  // namespace

std::string description(const CLI::App& app) { return app_json(app).dump(1); }

}  // namespace pmg::apps
