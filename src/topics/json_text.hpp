// (fields of a message) => one JSON object as text, and its schema. Written directly: a tree of JSON values for each of
// an hour's two million messages would take most of an export's time.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "topics/message_fields.hpp"

namespace pmg::topics {

/// Appends a number to seven to nine digits, those that a 32-bit float needs; null if it isn't finite.
void append_number(std::string& json, double value);

/// Appends a text in quotes; bytes that are no UTF-8 become U+FFFD.
void append_text(std::string& json, std::string_view text);

/// {"q_rad": {"left_knee": 0.1, ...}, "mode": 3, "mode_name": "WALK", ...}
std::string message_json(const std::vector<Field>& fields);

/// The JSON schema of these fields' messages. A number that means one of several constants lists them as Foxglove's
/// own schemas do: oneOf with title and const.
std::string message_schema(const std::vector<Field>& fields);

}  // namespace pmg::topics
