// The fields of every logged message by name, for exports (CSV, JSON) and comparisons.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "io/lcm_assembler.hpp"
#include "pmg_msgs/field.hpp"

namespace pmg::topics {

/// One number, flag or text of a message, or one element of an array with named elements. A list, whose length may
/// change from message to message, is one field.
struct Field {
  using Value = std::variant<std::int64_t, double, bool, std::string, std::vector<std::string>>;

  std::string name;     ///< as in msgs/
  std::string element;  ///< joint, foot, axis or command channel; empty: no array
  Value value;
  std::span<const pmg_msgs::Constant> constants{};  ///< what the number may mean; empty: it is a number

  /// The name of the constant that the number is; empty: of none.
  std::string_view constant() const;
  std::string path() const { return element.empty() ? name : name + "." + element; }
};

/// A number in full, a text unchanged, a list with ';' between its entries.
std::string to_text(const Field::Value& value);

/// Channels of the known messages, in the order of a tick.
std::span<const std::string_view> known_channels();

/// The fields of a message in the order of its .lcm file, without lengths of arrays. False if the channel is unknown or
/// the bytes are no message of its type. joint_names label arrays of joints of the same length; other arrays have
/// numbers.
bool read_fields(std::string_view channel, io::Bytes data, const std::vector<std::string>& joint_names,
                 std::vector<Field>& fields);

}  // namespace pmg::topics
