#include "operator/drive.hpp"

#include <fmt/format.h>

#include <utility>

#include "operator/way_up.hpp"

namespace pmg::ops {

void Script::begin() noexcept {
  hold_.down = hold_.pressed = true;
  requests_.other = options_.climb ? Request::kWalk : Request::kClaim;
}

DeviceManner Script::manner() const {
  DeviceManner manner = shell_manner();
  manner.timeout_s = options_.timeout_s;
  return manner;
}

std::span<const Hold> Script::holds(std::int64_t now_ns) noexcept {
  shown_ = hold_;
  shown_.heard_ns = now_ns;
  hold_.pressed = false;
  return {&shown_, 1};
}

Command Script::command(std::optional<std::int32_t> armed, std::int64_t /*now_ns*/) noexcept {
  return armed ? command_ : Command{};
}

Requests Script::take_requests() noexcept { return std::exchange(requests_, Requests{}); }

Drive::Drive(OperatorSource& source, std::string robot, const Command& command, const DriveOptions& options)
    : source_(source),
      options_(options),
      script_(command, options),
      driver_(source, std::move(robot), script_),
      begin_ns_(source.clock().now_ns()) {}

Progress Drive::step(const RobotNews* news) {
  if (ended_ns_) {
    if (!text_.empty()) return Progress::kFailed;
    return now_ns() - *ended_ns_ < kRelease_ns ? Progress::kPending : Progress::kReached;
  }
  note_driven();
  if (driver_.driving() && driven_s_ >= options_.duration_s) script_.end();
  if (end_early_) driver_.let_go();
  driver_.step(news);
  note_driven();
  if (begun_ || end_early_) {
    if (driver_.idle() || driver_.gone()) return end(driver_.why_idle());
  } else if (!driver_.silent()) {
    begun_ = true;  // only now a command would be fresh
    script_.begin();
  } else if (static_cast<double>(now_ns() - begin_ns_) * 1e-9 > options_.timeout_s) {
    return end(driver_.text());
  }
  return Progress::kPending;
}

std::string Drive::last_words() const {
  if (!text_.empty()) return text_;
  return fmt::format("drove for {:.1f} s{}{}", driven_s_, limited().empty() ? "" : "; ", limited());
}

void Drive::note_driven() {
  if (!driver_.driving()) return;
  if (!driving_since_ns_) driving_since_ns_ = now_ns();
  driven_s_ = static_cast<double>(now_ns() - *driving_since_ns_) * 1e-9;
}

Progress Drive::end(const std::string& text) {
  ended_ns_ = now_ns();
  text_ = text;
  return text_.empty() ? Progress::kPending : Progress::kFailed;
}

}  // namespace pmg::ops
