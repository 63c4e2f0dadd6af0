// The constants of controllers' messages in words.
#pragma once

#include <cstdint>

namespace pmg::ops {

inline constexpr const char* kHangs =
    "the robot hangs: its feet carry nothing, so its policy isn't run and it doesn't walk; set it down and ask again";

inline constexpr const char* kFootingUnknown =
    "whether its feet carry it can't be told in this posture (a straight knee bears weight without torque), so its "
    "policy isn't run and it doesn't walk";

inline constexpr const char* kNoKey = "it takes only operators with a key, and none of this user's fits (pmg_key)";

const char* mode_name(std::int8_t mode) noexcept;         ///< of pmg_msgs::mode_t: "stand"
bool is_upright(std::int8_t mode) noexcept;               ///< of pmg_msgs::mode_t: Stand or Walk
const char* verdict_words(std::int8_t verdict) noexcept;  ///< of pmg_msgs::ack_t: why a request was not taken

}  // namespace pmg::ops
