#include "operator/driving_station.hpp"

#include <fmt/format.h>

#include <utility>

#include "io/plain_text.hpp"
#include "operator/words.hpp"

namespace pmg::ops {

DrivingStation::DrivingStation(io::LcmLink& link, Device& device, std::string robot, std::int64_t session,
                               const io::Clock& clock, const seal::OperatorSeal& seal)
    : link_(link),
      device_(device),
      clock_(clock),
      source_(link, seal.source_name(device.manner().name), session, clock, seal),
      board_(link, clock, seal),
      robot_(std::move(robot)) {
  if (!robot_.empty()) driver_.emplace(source_, robot_, device_);
}

void DrivingStation::stop() {
  if (driver_) return driver_->stop();
  stop_everybody_.emplace(source_, "", Goal::kStop, device_.manner().timeout_s);
}

void DrivingStation::let_go() {
  letting_go_ = true;
  if (driver_) driver_->let_go();
}

void DrivingStation::step(int wait_ms) {
  if (driver_) {
    driver_->heed();
  } else {
    device_.holds(clock_.now_ns());  // a press before a robot is known has no later effect
    if (device_.take_requests().stop) stop();
  }
  link_.receive(wait_ms);
  if (stop_everybody_ && stop_everybody_->step() != Progress::kPending) stop_everybody_.reset();
  if (!driver_ && !stop_everybody_ && !letting_go_) find_robot();
  if (driver_) driver_->step(news());
}

void DrivingStation::find_robot() {
  const auto& heard = source_.heard();
  if (heard.size() != 1 || clock_.now_ns() - heard.begin()->second.first_heard_ns < ModeWish::kGather_ns) return;
  robot_ = heard.begin()->first;
  device_.rest();
  driver_.emplace(source_, robot_, device_);
}

const RobotNews* DrivingStation::news() const {
  const auto found = board_.robots().find(robot_);
  return found == board_.robots().end() ? nullptr : &found->second;
}

std::vector<std::string> DrivingStation::lines() const {
  if (!driver_) return {why_no_robot()};
  return driving_lines(*driver_, news(), news() == nullptr ? 0.0 : board_.silence_s(*news()));
}

DrivingTable DrivingStation::table() const {
  if (!driver_) return {why_no_robot(), ""};
  return driving_table(*driver_, news(), news() == nullptr ? 0.0 : board_.silence_s(*news()));
}

std::string DrivingStation::why_no_robot() const {
  if (source_.heard().size() < 2) return fmt::format("no controller is heard on {}", link_.url());
  std::string names;
  for (const auto& [name, heard] : source_.heard()) names += (names.empty() ? "" : ", ") + name;
  return io::plain_text(fmt::format("several robots are heard ({}): say which one with --robot", names));
}

std::string DrivingStation::last_words() const {
  const HeardRobot* heard = driver_ ? source_.heard(robot_) : nullptr;
  if (heard == nullptr || !heard->mode()) return lines().front();
  return io::plain_text(fmt::format("{}: {}", robot_, mode_name(*heard->mode())));
}

}  // namespace pmg::ops
