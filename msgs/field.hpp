// The members of a message as data, for programs that treat every message alike. The build makes
// pmg_msgs/message_fields.hpp from the .lcm files (message_fields.py); this header declares its parts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace pmg_msgs {

/// One meaning of a number.
struct Constant {
  std::int64_t value;
  std::string_view name;
};

/// One member of a message.
template <typename Message, typename Value>
struct Field {
  std::string_view name;
  std::string_view type;                       ///< as in the .lcm file: "double", "boolean", another message
  std::string_view length;                     ///< of an array: a number, or the member that holds it; empty: no array
  bool is_length;                              ///< the length of other members
  std::span<const std::string_view> elements;  ///< names of an array's elements, where the .lcm file gives them
  std::span<const Constant> constants;         ///< what the number may be, where the .lcm file says so
  std::string_view comment;                    ///< the comment behind the member in the .lcm file
  Value Message::*access;
};

/// A std::tuple of the Fields of a message, in the order of its .lcm file.
template <typename Message>
inline constexpr std::nullptr_t kFields = nullptr;

/// The channel that a message is sent on; empty: it is part of other messages only.
template <typename Message>
inline constexpr std::string_view kChannel = {};

}  // namespace pmg_msgs
