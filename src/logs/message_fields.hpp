// The fields of every logged message by name, for those who write them down (CSV, JSON) or compare them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace pmg::logs {

/// One number, flag or text of a message, or one element of a vector of fixed meaning. A list, whose length changes
/// from message to message, is one field.
struct Field {
  using Value = std::variant<std::int64_t, double, bool, std::string, std::vector<std::string>>;

  std::string name;     ///< as in msgs/
  std::string element;  ///< joint, foot, axis or command channel; empty: no vector
  Value value;

  std::string path() const { return element.empty() ? name : name + "." + element; }
};

/// A number in full, a text as it is, a list with ';' between.
std::string to_text(const Field::Value& value);

/// Channels whose messages this program knows, in the order of a tick.
std::span<const std::string_view> known_channels();

/// A message's fields in the order of its type, lengths of vectors left out. False when the channel isn't known or
/// these bytes aren't such a message. joint_names label vectors of as many entries; others are numbered.
bool read_fields(std::string_view channel, const std::vector<std::uint8_t>& data,
                 const std::vector<std::string>& joint_names, std::vector<Field>& fields);

}  // namespace pmg::logs
