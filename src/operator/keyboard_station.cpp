#include "operator/keyboard_station.hpp"

#include <fmt/format.h>

#include <utility>

#include "io/plain_text.hpp"
#include "operator/words.hpp"

namespace pmg::ops {

KeyboardStation::KeyboardStation(io::LcmLink& link, std::string robot, KeyReport report, std::int64_t session,
                                 const io::Clock& clock, const seal::OperatorSeal& seal)
    : link_(link),
      clock_(clock),
      report_(report),
      source_(link, seal.source_name("keyboard"), session, clock, seal),
      board_(link, clock, seal),
      robot_(std::move(robot)),
      begin_ns_(clock.now_ns()) {
  if (!robot_.empty()) driver_.emplace(source_, robot_, report_);
}

void KeyboardStation::press(std::string_view name, bool shift) {
  const auto key = key_named(name);
  if (driver_ && key) {
    driver_->press(*key, shift);
  } else if (driver_) {
    driver_->press_other();
  } else if (key == Key::kDamp) {
    stop_everybody_.emplace(source_, "", Goal::kStop, KeyboardDriver::kTimeout_s);
  }
}

void KeyboardStation::repeat(std::string_view name, bool shift) {
  if (const auto key = key_named(name); driver_ && key) driver_->repeat(*key, shift);
}

void KeyboardStation::release(std::string_view name) {
  if (const auto key = key_named(name); driver_ && key) driver_->release(*key);
}

void KeyboardStation::release_all() {
  if (driver_) driver_->release_all();
}

void KeyboardStation::listen() {
  if (driver_) driver_->listen();
}

void KeyboardStation::let_go() {
  letting_go_ = true;
  if (driver_) driver_->let_go();
}

void KeyboardStation::step(int wait_ms) {
  link_.receive(wait_ms);
  if (stop_everybody_ && stop_everybody_->step() != Progress::kPending) stop_everybody_.reset();
  if (!driver_ && !stop_everybody_ && !letting_go_) find_robot();
  if (!driver_) return;
  if (news() != nullptr && news()->info) {
    const pmg_msgs::robot_info_t& info = *news()->info;
    if (const auto limits = command_limits(info); limits && (!limits_known_ || limits_session_ != info.session)) {
      driver_->set_limits(*limits);
      limits_known_ = true;
      limits_session_ = info.session;
    }
  }
  driver_->step();
}

void KeyboardStation::find_robot() {
  const auto& heard = source_.heard();
  if (heard.size() != 1 || clock_.now_ns() - heard.begin()->second.first_heard_ns < ModeWish::kGather_ns) return;
  robot_ = heard.begin()->first;
  driver_.emplace(source_, robot_, report_);
}

const RobotNews* KeyboardStation::news() const {
  const auto found = board_.robots().find(robot_);
  return found == board_.robots().end() ? nullptr : &found->second;
}

std::vector<std::string> KeyboardStation::lines() const {
  if (!driver_) return {why_no_robot()};
  return driving_lines(*driver_, news(), news() == nullptr ? 0.0 : board_.silence_s(*news()));
}

DrivingTable KeyboardStation::table() const {
  if (!driver_) return {why_no_robot(), ""};
  return driving_table(*driver_, news(), news() == nullptr ? 0.0 : board_.silence_s(*news()));
}

std::string KeyboardStation::why_no_robot() const {
  if (source_.heard().size() < 2) return fmt::format("no controller is heard on {}", link_.url());
  std::string names;
  for (const auto& [name, heard] : source_.heard()) names += (names.empty() ? "" : ", ") + name;
  return io::plain_text(fmt::format("several robots are heard ({}): say which one with --robot", names));
}

std::string KeyboardStation::last_words() const {
  const HeardRobot* heard = driver_ ? source_.heard(robot_) : nullptr;
  if (heard == nullptr || !heard->mode()) return lines().front();
  return io::plain_text(fmt::format("{}: {}", robot_, mode_name(*heard->mode())));
}

}  // namespace pmg::ops
