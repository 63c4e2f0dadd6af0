#include "arms_operator/arms_text.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "io/plain_text.hpp"

namespace pmg::ops {

namespace {

using State = pmg_msgs::arms_state_t;

struct ActivityWords {
  const char *name, *words;
};
constexpr std::array<ActivityWords, 6> kActivities = {{{"reference", "the gait moves it"},
                                                       {"following", "on the way to its target"},
                                                       {"out_of_reach", "out of reach, as near as its joints allow"},
                                                       {"blocked", "near another link, comes no closer"},
                                                       {"held", "stays where it is"},
                                                       {"returning", "on the way back to the gait"}}};
constexpr std::array kOrders = {"in_force", "none_came", "lease_over", "not_walking"};
constexpr std::array kRefusals = {"never", "other_source", "out_of_order", "late", "no_pose", "no_lease"};

/// A number that this program doesn't know is another version's.
std::string unknown(std::int8_t number) { return fmt::format("unknown ({})", number); }

template <typename Names>
std::string name_of(const Names& names, std::int8_t number) {
  const auto index = static_cast<std::uint8_t>(number);  // a negative one is beyond the names
  return index < names.size() ? names[index] : unknown(number);
}

const ActivityWords* words_of(std::int8_t activity) {
  const auto index = static_cast<std::uint8_t>(activity);
  return index < kActivities.size() ? &kActivities[index] : nullptr;
}

}  // namespace

ArmNews arm_news(const State& state, Foot arm) {
  if (arm == kLeft) {
    return {.activity = state.left,
            .reached = state.left_reached != 0,
            .error_m = state.left_error_m,
            .error_rad = state.left_error_rad,
            .p_m = state.left_p_m,
            .orientation = state.left_orientation};
  }
  return {.activity = state.right,
          .reached = state.right_reached != 0,
          .error_m = state.right_error_m,
          .error_rad = state.right_error_rad,
          .p_m = state.right_p_m,
          .orientation = state.right_orientation};
}

std::string arm_text(const ArmNews& arm) {
  if (arm.reached) return "at its target";
  const ActivityWords* known = words_of(arm.activity);
  if (known == nullptr) return unknown(arm.activity);
  const bool aims =
      arm.activity == State::FOLLOWING || arm.activity == State::OUT_OF_REACH || arm.activity == State::BLOCKED;
  if (!aims) return known->words;
  return fmt::format("{}: {:.3f} m and {:.2f} rad from its target", known->words, arm.error_m, arm.error_rad);
}

std::string hold_text(const State& state) {
  if (state.left != State::HELD && state.right != State::HELD) return "";
  switch (state.order) {
    case State::NOT_WALKING:
      return "the robot doesn't walk: arms are led in walk only";
    case State::LEASE_OVER:
      return "the driving source sends no targets any more";
    case State::NONE_CAME:
      return "the driving source has sent no targets";
    default:
      return "";
  }
}

const char* refusal_words(std::int8_t refusal) noexcept {
  switch (refusal) {
    case State::OTHER_SOURCE:
      return "its source doesn't drive the robot";
    case State::OUT_OF_ORDER:
      return "repeated or overtaken";
    case State::LATE:
      return "too long on its way";
    case State::NO_POSE:
      return "a target that no palm can have: not finite, beyond 10 m, or a quaternion that hasn't length 1";
    case State::NO_LEASE:
      return "without a lease";
    default:
      return "";
  }
}

std::vector<std::string> arms_lines(const State& state) {
  std::vector<std::string> lines;
  lines.push_back(fmt::format("left arm      {}", arm_text(arm_news(state, kLeft))));
  lines.push_back(fmt::format("right arm     {}", arm_text(arm_news(state, kRight))));
  if (const std::string why = hold_text(state); !why.empty()) lines.push_back("              " + why);
  if (state.refused > 0) {
    lines.push_back(fmt::format("              {} targets refused, the last: {}", state.refused,
                                refusal_words(state.last_refusal)));
  }
  return lines;
}

nlohmann::ordered_json arms_json(const State& state) {
  nlohmann::ordered_json json{{"order", name_of(kOrders, state.order)},
                              {"source", io::plain_text(state.source)},
                              {"refused", state.refused},
                              {"last_refusal", name_of(kRefusals, state.last_refusal)}};
  for (const Foot side : {kLeft, kRight}) {
    const ArmNews arm = arm_news(state, side);
    const ActivityWords* known = words_of(arm.activity);
    json[side == kLeft ? "left" : "right"] = {
        {"activity", known == nullptr ? unknown(arm.activity) : known->name},
        {"reached", arm.reached},
        {"error_m", arm.error_m},
        {"error_rad", arm.error_rad},
        {"p_m", {arm.p_m[0], arm.p_m[1], arm.p_m[2]}},
        {"orientation", {arm.orientation[0], arm.orientation[1], arm.orientation[2], arm.orientation[3]}}};
  }
  return json;
}

}  // namespace pmg::ops
