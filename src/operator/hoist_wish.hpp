// An operator's request to a simulated robot's hoist: repeated every 50 ms until the answer, then watched until it is
// fulfilled.
#pragma once

#include <cstdint>
#include <string>

#include "operator/mode_wish.hpp"
#include "operator/operator_source.hpp"

namespace pmg::ops {

/// The hoist's state in words: "holds the robot".
const char* hoist_words(std::int8_t state) noexcept;

class HoistWish {
 public:
  /// Keeps a reference and sends the first request.
  HoistWish(OperatorSource& source, std::string robot, bool lift, double timeout_s);

  /// Call after each link.receive(). Reached: the robot hangs, or stands by itself.
  Progress step();
  const std::string& text() const noexcept { return text_; }  ///< for people: the state, or why the request failed
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
