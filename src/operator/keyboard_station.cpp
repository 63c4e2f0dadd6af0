#include "operator/keyboard_station.hpp"

#include <utility>

namespace pmg::ops {

KeyboardStation::KeyboardStation(io::LcmLink& link, std::string robot, KeyReport report, std::int64_t session,
                                 const io::Clock& clock, const seal::OperatorSeal& seal)
    : DrivingStation(link, "keyboard", std::move(robot), session, clock, seal), report_(report) {
  begin();
}

RobotDriver& KeyboardStation::make_driver(const std::string& robot) {
  return keyboard_.emplace(source(), robot, report_).driver();
}

void KeyboardStation::press(std::string_view name, bool shift) {
  const auto key = key_named(name);
  if (keyboard_ && key) {
    keyboard_->press(*key, shift);
  } else if (keyboard_) {
    keyboard_->press_other();
  } else if (key == Key::kDamp) {
    stop();
  }
}

void KeyboardStation::repeat(std::string_view name, bool shift) {
  if (const auto key = key_named(name); keyboard_ && key) keyboard_->repeat(*key, shift);
}

void KeyboardStation::release(std::string_view name) {
  if (const auto key = key_named(name); keyboard_ && key) keyboard_->release(*key);
}

void KeyboardStation::release_all() {
  if (keyboard_) keyboard_->release_all();
}

void KeyboardStation::listen() {
  if (keyboard_) keyboard_->listen();
}

}  // namespace pmg::ops
