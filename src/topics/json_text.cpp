#include "topics/json_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

namespace pmg::topics {

namespace {

using nlohmann::ordered_json;

struct AppendValue {
  std::string& json;

  void operator()(std::int64_t value) const { fmt::format_to(std::back_inserter(json), "{}", value); }
  void operator()(double value) const { append_number(json, value); }
  void operator()(bool value) const { json += value ? "true" : "false"; }
  void operator()(const std::string& value) const { append_text(json, value); }
  void operator()(const std::vector<std::string>& values) const {
    const char* before = "[";
    for (const std::string& value : values) {
      json += before;
      append_text(json, value);
      before = ",";
    }
    json += values.empty() ? "[]" : "]";
  }
};

struct SchemaType {
  const char* operator()(std::int64_t) const { return "integer"; }
  const char* operator()(double) const { return "number"; }
  const char* operator()(bool) const { return "boolean"; }
  const char* operator()(const std::string&) const { return "string"; }
  const char* operator()(const std::vector<std::string>&) const { return "array"; }
};

ordered_json field_schema(const Field& field) {
  ordered_json schema = {{"type", std::visit(SchemaType{}, field.value)}};
  if (schema["type"] == "array") schema["items"] = {{"type", "string"}};
  for (const pmg_msgs::Constant& constant : field.constants)
    schema["oneOf"].push_back({{"title", constant.name}, {"const", constant.value}});
  return schema;
}

}  // namespace

void append_number(std::string& json, double value) {
  const auto rounded = static_cast<float>(value);
  if (std::isfinite(rounded)) {
    fmt::format_to(std::back_inserter(json), "{}", rounded);
  } else {
    json += "null";
  }
}

void append_text(std::string& json, std::string_view text) {
  json += nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string message_json(const std::vector<Field>& fields) {
  std::string json = "{";
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const Field& field = fields[i];
    const bool begins = i == 0 || fields[i - 1].name != field.name;
    if (begins) {
      if (i > 0) json += ',';
      append_text(json, field.name);
      json += field.element.empty() ? ":" : ":{";
    } else {
      json += ',';
    }
    if (!field.element.empty()) {
      append_text(json, field.element);
      json += ':';
    }
    std::visit(AppendValue{json}, field.value);
    if (!field.element.empty() && (i + 1 == fields.size() || fields[i + 1].name != field.name)) json += '}';
    if (!field.constants.empty()) {
      json += ',';
      append_text(json, field.name + "_name");
      json += ':';
      append_text(json, field.constant());
    }
  }
  return json + '}';
}

std::string message_schema(const std::vector<Field>& fields) {
  ordered_json properties = ordered_json::object();
  for (const Field& field : fields) {
    if (field.element.empty()) {
      properties[field.name] = field_schema(field);
    } else {
      properties[field.name]["type"] = "object";
      properties[field.name]["properties"][field.element] = field_schema(field);
    }
    if (!field.constants.empty()) properties[field.name + "_name"] = {{"type", "string"}};
  }
  return ordered_json{{"type", "object"}, {"properties", properties}}.dump();
}

}  // namespace pmg::topics
