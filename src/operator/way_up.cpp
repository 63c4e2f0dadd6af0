#include "operator/way_up.hpp"

#include <fmt/format.h>

#include "operator/hoist_wish.hpp"
#include "operator/words.hpp"

namespace pmg::ops {

namespace {

using Hoist = pmg_msgs::hoist_state_t;
using Modes = pmg_msgs::mode_t;

void see_hoist(const HeardHoist& heard, std::int64_t now_ns, Posture& posture) {
  const auto hoist = heard.speaking(now_ns);
  if (!hoist) return;
  posture.hoist = hoist->state;
  posture.stays_up = hoist->stays_up != 0;
}

void see_tilt(const RobotNews& news, Posture& posture) {
  posture.tilt_rad = tilt_rad(news);
  posture.down = posture.tilt_rad && *posture.tilt_rad > news.upright->most_tilt_rad;
}

const char* words(Step step, const DeviceManner& manner) {
  switch (step) {
    case Step::kLift:
      return manner.lifts.c_str();
    case Step::kPutUp:
      return "put it upright and hold it";
    case Step::kAwaitHoist:
      return "the hoist takes it up";
    case Step::kReset:
      return manner.resets.c_str();
    case Step::kStand:
      return manner.raises.c_str();
    default:
      return manner.sets_down.c_str();
  }
}

/// Why it doesn't stand on its feet, as far as that isn't its mode.
std::string where(const Posture& posture) {
  const bool held = posture.hoist && posture.hoist != Hoist::FREE;
  if (held && posture.hoist == Hoist::HOLDING) return "hangs on the hoist: ";
  if (held || !posture.down || !posture.tilt_rad) return "";
  return fmt::format("lies ({:.2f} rad from upright): ", *posture.tilt_rad);
}

}  // namespace

Posture posture(const HeardRobot& heard, const RobotNews* news, std::int64_t now_ns) {
  Posture posture;
  if (!heard.status) return posture;
  posture.mode = heard.mode().value_or(heard.status->mode);
  posture.hanging = heard.status->hanging != 0;
  see_hoist(heard.hoist, now_ns, posture);
  if (news != nullptr) see_tilt(*news, posture);
  if (!posture.tilt_rad) posture.down = heard.ack && heard.ack->verdict == pmg_msgs::ack_t::TILTED;
  return posture;
}

Posture posture(const RobotNews& news, std::int64_t now_ns) {
  Posture posture{.mode = news.status.mode, .hanging = news.status.hanging != 0};
  see_hoist(news.hoist, now_ns, posture);
  see_tilt(news, posture);
  return posture;
}

std::vector<Step> steps_up(const Posture& posture) {
  std::vector<Step> steps;
  if (is_upright(posture.mode)) {
    if (posture.hoist == Hoist::HOLDING && posture.stays_up) steps.push_back(Step::kSetDown);
    return steps;
  }
  // A robot whose drives don't hold it falls, whether it lies already or not.
  if (posture.hoist == Hoist::FREE) {
    steps.push_back(Step::kLift);
  } else if (posture.hoist && posture.hoist != Hoist::HOLDING) {
    steps.push_back(Step::kAwaitHoist);
  } else if (!posture.hoist && posture.down) {
    steps.push_back(Step::kPutUp);
  }
  if (posture.mode == Modes::FAULT) steps.push_back(Step::kReset);
  steps.push_back(Step::kStand);
  return steps;
}

std::string way_up(const Posture& posture, const DeviceManner& manner) {
  std::string text;
  for (const Step step : steps_up(posture)) text += (text.empty() ? where(posture) : ", then ") + words(step, manner);
  return text;
}

DeviceManner shell_manner() {
  return {.name = "script",
          .command_raises = false,
          .at_once = false,
          .raises = "pmg_send stand makes it stand up",
          .resets = "pmg_send reset resets it",
          .drives = "pmg_send walk drives it",
          .starts = "pmg_send walk makes it stand up and walk",
          .anew = "Ask again"};
}

}  // namespace pmg::ops
