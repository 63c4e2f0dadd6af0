#include "operator/words.hpp"

#include "pmg_msgs/ack_t.hpp"
#include "pmg_msgs/mode_t.hpp"

namespace pmg::ops {

bool is_upright(std::int8_t mode) noexcept { return mode == pmg_msgs::mode_t::STAND || mode == pmg_msgs::mode_t::WALK; }

const char* mode_name(std::int8_t mode) noexcept {
  switch (mode) {
    case pmg_msgs::mode_t::PASSIVE:
      return "passive";
    case pmg_msgs::mode_t::DAMPING:
      return "damping";
    case pmg_msgs::mode_t::STAND:
      return "stand";
    case pmg_msgs::mode_t::WALK:
      return "walk";
    case pmg_msgs::mode_t::FAULT:
      return "fault";
    default:
      return "unknown";
  }
}

const char* verdict_words(std::int8_t verdict) noexcept {
  switch (verdict) {
    case pmg_msgs::ack_t::TAKEN:
      return "taken";
    case pmg_msgs::ack_t::NOT_YOURS:
      return "another source drives";
    case pmg_msgs::ack_t::OUT_OF_ORDER:
      return "out of order";
    case pmg_msgs::ack_t::LATE:
      return "late: too long on its way, or somebody stopped the robot before this was known here";
    case pmg_msgs::ack_t::NO_MODE:
      return "no mode that can be asked for";
    case pmg_msgs::ack_t::NO_KEY:
      return kNoKey;
    case pmg_msgs::ack_t::TILTED:
      return "it leans too far to stand up";
    default:
      return "unknown answer";
  }
}

}  // namespace pmg::ops
