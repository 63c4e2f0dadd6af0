#include "runtime/robot_excitation_session.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "excitation/robot_excitation.hpp"

namespace pmg::runtime {

namespace {

constexpr const char* kHanging = "hanging";
constexpr const char* kStanding = "standing";
constexpr double kTold_s = 10.0;  // of waiting, until people are told what it waits for

}  // namespace

std::vector<std::string> robot_excitation_names() { return {kHanging, kStanding}; }

control::RobotExcitationPlan robot_excitation_plan(const std::string& name, const model::RobotModel& robot,
                                                   const ClipLibrary& clips, const hal::GuardOptions& guard,
                                                   std::span<const std::string> own_gains) {
  control::RobotExcitationPlan plan;
  if (name == kHanging) {
    plan.commands = excitation::hanging_excitation(robot, own_gains);
    plan.footing = faults::Footing::kHangs;
  } else if (name == kStanding) {
    plan.commands = excitation::standing_excitation(robot, clips);
    plan.footing = faults::Footing::kStands;
  } else {
    throw std::invalid_argument(
        fmt::format("excitation '{}'; expected one of {}", name, fmt::join(robot_excitation_names(), ", ")));
  }
  control::check(plan, robot, guard);
  return plan;
}

RobotExcitationSession::RobotExcitationSession(std::string name, const control::RobotExcitationPlan& plan, double dt_s)
    : name_(std::move(name)),
      dt_s_(dt_s),
      duration_s_(dt_s * static_cast<double>(plan.commands.size())),
      settle_s_(plan.settle_s) {}

nlohmann::ordered_json RobotExcitationSession::json() const { return {{"name", name_}, {"duration_s", duration_s_}}; }

std::string RobotExcitationSession::waits(const control::TickRecord& record) {
  const bool stands = record.result.mode == control::Mode::kStand && !record.result.entering;
  const bool tell = stands && waited_s_ < kTold_s && waited_s_ + dt_s_ >= kTold_s;
  waited_s_ = stands ? waited_s_ + dt_s_ : 0.0;
  if (!tell) return "";
  return name_ == kHanging
             ? fmt::format("the excitation waits until the robot hangs still for {:g} s, feet clear of the ground",
                           settle_s_)
             : fmt::format("the excitation waits until the feet carry the robot for {:g} s", settle_s_);
}

std::string RobotExcitationSession::news(const control::TickRecord& record) {
  const control::ExcitationProgress& now = record.result.excitation;
  const bool was_playing = std::exchange(playing_, now.run >= 0), was_over = std::exchange(over_, now.over);
  given_up_ = now.given_up;
  if (over_ && !was_over) {
    if (given_up_) return fmt::format("the {} excitation was given up: the robot left Stand or its footing", name_);
    return name_ == kHanging ? "the hanging excitation is over"
                             : "the standing excitation is over; the robot stands on: take it up before you end this";
  }
  if (over_) return "";
  if (playing_ != was_playing)
    return playing_ ? fmt::format("the {} excitation plays for {:g} s", name_, duration_s_)
                    : fmt::format("the {} excitation comes back to rest", name_);
  return playing_ ? "" : waits(record);
}

}  // namespace pmg::runtime
