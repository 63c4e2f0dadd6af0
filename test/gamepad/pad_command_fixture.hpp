// Game controllers whose states a test sets by hand, and the rule of what is held, without SDL, network or robot.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "gamepad/pad_command.hpp"
#include "operator/hold_to_drive.hpp"

namespace pmg::gamepad {

class PadCommandTest : public testing::Test {
 protected:
  static constexpr std::size_t kA = 0, kB = 1, kX = 2, kUp = 3, kLb = 9, kRb = 10;  // kButtonNames' order
  static constexpr std::size_t kLeftX = 0, kLeftY = 1, kRightX = 2, kRightY = 3;
  static constexpr double kStep_s = 0.01;
  // Both ends of every range differ, so that a swapped sign or end is seen.
  inline static const CommandLimits kLimits{.lower = {-0.5, -0.2, -0.7, -0.1, -0.15, -0.3},
                                            .upper = {0.8, 0.3, 0.9, 0.4, 0.25, 0.05}};

  PadCommandTest() { command_.set_limits(kLimits); }

  /// All pads for a time, rounded to steps. What happens in a step that asks for a stop or a move is counted.
  void run(double seconds) {
    for (; seconds > kStep_s / 2; seconds -= kStep_s) step();
  }
  void step() {
    for (PadReport& pad : pads_) pad.state.pressed = (pad.state.held & ~before_[pad.id]) | flicked_;
    flicked_.reset();
    command_.take(pads_, now_ns_);
    follow();
    for (PadReport& pad : pads_) {
      before_[pad.id] = pad.state.held;
      pad.state.changed = lively_;
    }
    now_ns_ += static_cast<std::int64_t>(kStep_s * 1e9);
  }
  /// As RobotDriver does it.
  void follow() {
    const ops::Requests requests = command_.take_requests();
    if (requests.stop) {
      ++stops_;
      rest();
    } else if (requests.other) {
      actions_.push_back(*requests.other);
    }
    const bool armed = rule_.armed().has_value();
    rule_.step(command_.holds(now_ns_), now_ns_);
    if (armed && !rule_.armed()) command_.rest();
    u_ = command_.command(rule_.armed(), now_ns_);
  }
  void rest() {
    rule_.disarm();
    command_.rest();
  }
  std::optional<std::int32_t> driving() const { return rule_.armed(); }
  PadReport& plug_in(std::int32_t id) {
    pads_.reserve(2);
    return pads_.emplace_back(PadReport{.id = id});
  }
  void press(PadReport& pad, std::size_t button) { hold(pad, button, true); }
  void let_go(PadReport& pad, std::size_t button) { hold(pad, button, false); }
  void hold(PadReport& pad, std::size_t button, bool down) {
    pad.state.held[button] = down;
    pad.state.changed = true;
    step();
  }
  void arm(PadReport& pad) {
    let_go(pad, kLb);
    press(pad, kLb);
    ASSERT_EQ(driving(), pad.id);
  }
  double u(std::size_t channel) const { return u_.u[channel]; }

  const Mapping mapping_ = read_mapping(find_mapping("standard"));
  PadCommand command_{mapping_};
  std::vector<PadReport> pads_;
  std::map<std::int32_t, Buttons> before_;
  Buttons flicked_;  ///< let go and pressed again before the next step, on every pad
  ops::HoldToDrive rule_;
  Command u_;
  std::vector<ops::Request> actions_;
  int stops_ = 0;
  bool lively_ = true;
  std::int64_t now_ns_ = 1'000'000'000;
};

}  // namespace pmg::gamepad
