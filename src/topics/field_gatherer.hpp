// (a message, its members as pmg_msgs::kFields lists them) => the fields that an export writes, in the order of the
// .lcm file.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "pmg_msgs/field.hpp"
#include "topics/message_fields.hpp"

namespace pmg::topics {

/// Appends a message's fields. Members that are lengths of others are left out; a message within a message is its
/// members, "outer.inner".
class FieldGatherer {
 public:
  FieldGatherer(const std::vector<std::string>& joint_names, std::vector<Field>& fields)
      : joint_names_(joint_names), fields_(fields) {}

  template <typename Message>
  void add(const Message& message, const std::string& within = {}) {
    std::apply(
        [&](const auto&... member) {
          (add_member(member, message.*member.access, within + std::string(member.name)), ...);
        },
        pmg_msgs::kFields<Message>);
  }

 private:
  template <typename Member, typename T>
  void add_member(const Member& member, const T& value, const std::string& name) {
    if (member.is_length) return;
    if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
      fields_.push_back({name, {}, converted(member, value), member.constants});
    } else if constexpr (std::is_array_v<T>) {
      for (std::size_t i = 0; i < std::extent_v<T>; ++i) {
        const bool named = i < member.elements.size();
        fields_.push_back(
            {name, named ? std::string(member.elements[i]) : std::to_string(i), converted(member, value[i]), {}});
      }
    } else if constexpr (std::is_class_v<T>) {
      add(value, name + ".");
    }
  }
  /// An array of any length is one field, a list. Only numbers of joints have a column each: every message of a robot
  /// has as many.
  template <typename Member, typename T>
  void add_member(const Member& member, const std::vector<T>& values, const std::string& name) {
    if constexpr (std::is_floating_point_v<T>) {
      if (member.length == "joint_count") return add_joints(values, name);
    }
    std::vector<std::string> texts;
    for (const T& value : values) texts.push_back(fmt::format("{}", value));
    fields_.push_back({name, {}, std::move(texts), {}});
  }
  template <typename T>
  void add_joints(const std::vector<T>& values, const std::string& name) {
    const bool named = values.size() == joint_names_.size();
    for (std::size_t i = 0; i < values.size(); ++i) {
      fields_.push_back({name, named ? joint_names_[i] : std::to_string(i), static_cast<double>(values[i]), {}});
    }
  }

  /// In C++ a boolean of LCM is a number; its type tells.
  template <typename Member, typename T>
  static Field::Value converted(const Member& member, const T& value) {
    if constexpr (std::is_same_v<T, std::string>) {
      return value;
    } else if constexpr (std::is_floating_point_v<T>) {
      return static_cast<double>(value);
    } else {
      if (member.type == "boolean") return value != 0;
      return static_cast<std::int64_t>(value);
    }
  }

  const std::vector<std::string>& joint_names_;
  std::vector<Field>& fields_;
};

}  // namespace pmg::topics
