// One stretch of driving by a script: a command for some seconds, then zero velocity.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "operator/mode_wish.hpp"
#include "operator/robot_driver.hpp"

namespace pmg::ops {

struct DriveOptions {
  double duration_s = 0.0;
  bool climb = false;  ///< ask for Walk first, and for Stand at the end
  double timeout_s =
      10;  ///< for each of the two requests, for a hoist to set the robot down, for a crashed source's lease to end
};

/// A script as a device: one request, one hold that is held until the end, one command.
class Script : public Device {
 public:
  Script(const Command& command, const DriveOptions& options) : command_(command), options_(options) {}
  void begin() noexcept;
  void end() noexcept { hold_.down = false; }
  void lead(const PerFoot<PalmWish>* palms) noexcept { palms_ = palms; }

  DeviceManner manner() const override;
  void set_limits(const CommandLimits& /*limits*/) noexcept override {}  // the controller says what it doesn't follow
  std::span<const Hold> holds(std::int64_t now_ns) noexcept override;
  Command command(std::optional<std::int32_t> armed, std::int64_t now_ns) noexcept override;
  Requests take_requests() noexcept override;
  const PerFoot<PalmWish>* palms() const noexcept override { return palms_; }
  void rest() noexcept override { end(); }
  void upright() noexcept override {}

 private:
  Command command_;
  DriveOptions options_;
  Hold hold_{}, shown_{};
  Requests requests_{};
  const PerFoot<PalmWish>* palms_ = nullptr;
};

class Drive {
 public:
  static constexpr std::int64_t kRelease_ns =
      50'000'000;  ///< until the last command's lease is over and the next line of a script may drive

  /// Keeps a reference to source.
  Drive(OperatorSource& source, std::string robot, const Command& command, const DriveOptions& options);

  /// Call after each link.receive(), at least every 20 ms. news: as in RobotDriver.
  Progress step(const RobotNews* news = nullptr);
  /// Ends the stretch early, also with zero velocity.
  void end_early() noexcept { end_early_ = true; }
  /// Leads the arms while it drives. Keeps the pointer; null: not.
  void lead(const PerFoot<PalmWish>* palms) noexcept { script_.lead(palms); }

  const std::string& text() const noexcept { return text_; }  ///< why it failed, in words
  bool driving() const noexcept { return driver_.driving(); }
  double driven_s() const noexcept { return driven_s_; }
  std::string waits_for() const { return driver_.waits_for(); }              ///< as RobotDriver's
  const std::string& limited() const noexcept { return driver_.limited(); }  ///< likewise, also after the end
  /// At the end: "drove for 2.0 s; limited: vx 50 -> 0.5 m/s (range -0.3 to 0.5)", or why it failed.
  std::string last_words() const;

 private:
  std::int64_t now_ns() const { return source_.clock().now_ns(); }
  void note_driven();
  Progress end(const std::string& text);

  OperatorSource& source_;
  DriveOptions options_;
  Script script_;
  RobotDriver driver_;
  std::int64_t begin_ns_;
  bool begun_ = false, end_early_ = false;
  std::optional<std::int64_t> driving_since_ns_, ended_ns_;
  double driven_s_ = 0.0;
  std::string text_;
};

}  // namespace pmg::ops
