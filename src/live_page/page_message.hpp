// What a page says, read strictly: (text of a message) => a hand on its stick, or a request.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "operator/device.hpp"

namespace pmg::live_page {

/// What a hand does on a page, told again and again while the page is open.
struct HandNews {
  std::int64_t number = 0;                        ///< increases with each message of a connection
  std::int64_t stamp_ns = 0;                      ///< by the page's clock, whose zero is anywhere
  bool held = false;                              ///< a finger is on a stick
  std::int64_t presses = 0;                       ///< how often one was put there since the page was opened
  double forwards = 0.0, turn = 0.0, left = 0.0;  ///< of the sticks, each in [-1, 1]
};

struct PageMessage {
  std::optional<HandNews> hand;
  std::optional<ops::Request> request;
};

/// {"n": 7, "t": 1234.5, "held": true, "press": 2, "forwards": 0.5, "turn": 0, "left": 0}, t in ms; or {"request":
/// "stand"}, or reset, limp, lift, set_down. Nothing: anything else, whatever it is. Safe for foreign bytes.
std::optional<PageMessage> read_message(std::string_view text);

}  // namespace pmg::live_page
