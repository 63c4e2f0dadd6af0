// What an operator wants of a simulated robot's hoist: asked for every 50 ms until it is answered, then watched.
#pragma once

#include <cstdint>
#include <string>

#include "operator/mode_wish.hpp"
#include "operator/operator_source.hpp"

namespace pmg::ops {

/// What the hoist does, for people: "holds the robot".
const char* hoist_words(std::int8_t state) noexcept;

class HoistWish {
 public:
  /// A hoist says ten times a second what it does: one that was not heard for so long is not there.
  static constexpr std::int64_t kSilent_ns = 1'000'000'000;

  /// Keeps a reference, and asks for the first time.
  HoistWish(OperatorSource& source, std::string robot, bool lift, double timeout_s);

  /// To be called after every link.receive(). Reached: the robot hangs, or stands on its own.
  Progress step();
  const std::string& text() const noexcept { return text_; }  ///< for people: how it is, or why not
  double elapsed_s() const;

 private:
  Progress judge();

  OperatorSource& source_;
  std::string robot_;
  bool lift_;
  double timeout_s_;
  std::int64_t begin_ns_, repeat_at_ns_;
  std::string text_;
};

}  // namespace pmg::ops
