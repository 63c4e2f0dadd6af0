// How the controller's values stand in fields of LCM messages: into them and back.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "control/mode.hpp"
#include "pmg/command.hpp"
#include "pmg/types.hpp"

namespace pmg::recording {

/// Copies a value into its field of a message.
struct ToMessage {
  int joint_count = 0;

  template <typename T>
  void operator()(const T& from, T& to) const {
    to = from;
  }
  template <typename Enum>
  requires std::is_enum_v<Enum>
  void operator()(Enum from, std::int8_t& to) const { to = static_cast<std::int8_t>(from); }
  void operator()(bool from, std::int8_t& to) const { to = from; }
  void operator()(std::uint64_t from, std::int64_t& to) const { to = static_cast<std::int64_t>(from); }
  void operator()(const control::Source& from, std::string& name, std::int64_t& session) const {
    name = from.name.data();
    session = from.session;
  }
  /// A vector that a broken state left short is filled up with NaN.
  void operator()(const JointVector& from, std::vector<double>& to) const {
    to.assign(from.data(), from.data() + from.size());
    to.resize(static_cast<std::size_t>(joint_count), std::numeric_limits<double>::quiet_NaN());
  }
  void operator()(const Command& from, double (&to)[kChannels]) const { std::ranges::copy(from.u, to); }
  template <typename T, typename U>
  void operator()(const PerFoot<T>& from, U (&to)[2]) const {
    for (const std::size_t foot : {kLeft, kRight}) to[foot] = from[foot];
  }
  void operator()(const Eigen::Vector3d& from, double (&to)[3]) const { std::copy_n(from.data(), 3, to); }
  void operator()(const Eigen::Quaterniond& from, double (&to)[4]) const {
    std::ranges::copy(std::array{from.w(), from.x(), from.y(), from.z()}, to);
  }
};

/// The way back.
struct FromMessage {
  int joint_count = 0;
  bool complete = true;  ///< false after a vector of another number of joints

  template <typename T>
  void operator()(T& to, const T& from) {
    to = from;
  }
  template <typename Enum>
  requires std::is_enum_v<Enum>
  void operator()(Enum& to, std::int8_t from) { to = static_cast<Enum>(from); }
  void operator()(bool& to, std::int8_t from) { to = from != 0; }
  void operator()(std::uint64_t& to, std::int64_t from) { to = static_cast<std::uint64_t>(from); }
  void operator()(control::Source& to, const std::string& name, std::int64_t session) {
    to = control::Source::make(name, session);
  }
  void operator()(JointVector& to, const std::vector<double>& from) {
    if (std::ssize(from) == joint_count) {
      to = Eigen::Map<const Eigen::VectorXd>(from.data(), joint_count);
    } else {
      complete = false;
    }
  }
  void operator()(Eigen::Vector3d& to, const double (&from)[3]) { to = Eigen::Map<const Eigen::Vector3d>(from); }
  void operator()(Eigen::Quaterniond& to, const double (&from)[4]) { to = {from[0], from[1], from[2], from[3]}; }
};

}  // namespace pmg::recording
