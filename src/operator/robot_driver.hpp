// Drives one robot by hand: (a hand's input) => commands and requests for modes on the network.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "operator/climb.hpp"
#include "operator/command_input.hpp"
#include "operator/hoist_wish.hpp"
#include "operator/mode_wish.hpp"
#include "operator/operator_source.hpp"

namespace pmg::ops {

/// How a kind of input drives, and the words for it.
struct DriverManner {
  bool command_raises;  ///< a command takes the robot from any mode to Walk; otherwise from Stand only
  bool at_once;         ///< a command that changes is sent at once; otherwise the rate is fixed
  std::string raises;   ///< how the robot is made to stand up: "Enter makes it stand up"
  std::string resets;   ///< how a fault is reset: "R resets it"
  std::string drives;   ///< how it is driven from Stand: "a key drives it"
  std::string starts;   ///< the same from a mode below Stand
  std::string anew;     ///< what to do after it came to rest by itself: "Press a key anew"
};

/// For one thread. Sends commands only while the robot shall move, so idle hands do not block other operators.
///
/// After a stop by any operator and after a fault the robot rises only when its operator asks for Stand (stand()).
class RobotDriver {
 public:
  static constexpr std::int64_t kPeriod_ns = 20'000'000;
  static constexpr double kLease_s = 0.5, kLastLease_s = 0.02;  ///< as Drive's
  /// After this time the velocity is zero: the generator's ramp and a margin.
  static constexpr std::int64_t kCalm_ns = 600'000'000;
  static constexpr std::int64_t kSettle_ns =
      300'000'000;  ///< after this time the controller must show this source as driving
  static constexpr std::int64_t kSilent_ns = 500'000'000;  ///< a controller that has been silent for this time is gone
  static constexpr double kTimeout_s = 10.0;
  static constexpr std::int64_t kLetGo_ns = 2'000'000'000;  ///< how long let_go() waits for Stand

  /// Keeps references. robot: its controller's name.
  RobotDriver(OperatorSource& source, std::string robot, CommandInput& input, DriverManner manner);

  /// Until the robot's limits are known nothing is commanded; what is still held then takes effect.
  void set_limits(const CommandLimits& limits) noexcept {
    input_.set_limits(limits);
    limits_known_ = true;
  }

  // Requests; all but the stop have no effect after let_go() and while a stop waits for its answer.
  void stop();            ///< damps at once
  void stand();           ///< from any mode, after a stop, too
  void reset();           ///< of a latched fault
  void limp();            ///< to Passive; a robot that stands brakes first and must be told twice
  void hoist(bool lift);  ///< a simulated robot's

  /// Call after each link.receive(), at least every 10 ms.
  void step();

  /// Velocity to zero, then Stand; further input has no effect.
  void let_go();
  bool letting_go() const noexcept { return letting_go_; }
  bool gone() const noexcept { return gone_; }  ///< let_go() is complete

  const std::string& robot() const noexcept { return robot_; }
  const Command& asked() const noexcept { return asked_; }  ///< the input's command at this moment
  std::string text() const;  ///< for people: the driver's state, or why the robot doesn't move
  bool driving() const noexcept { return doing_ == Doing::kDriving; }
  bool silent() const;  ///< the controller was heard and is no longer, or never was

 private:
  enum class Doing { kIdle, kClimbing, kDriving, kCalming, kDescending };

  std::int64_t now_ns() const { return source_.clock().now_ns(); }
  std::int64_t in_doing_ns() const { return now_ns() - doing_since_ns_; }
  void enter(Doing doing);
  void climb(Goal to);
  void idle(const std::string& text);
  void hold_back(const std::string& text);

  void watch_mode();
  void follow_errands();
  void follow_input();
  void follow_climb();
  void follow_drive();
  std::string trouble() const;
  bool wants_to_move() const noexcept { return moves() || bent(); }
  bool moves() const noexcept;
  bool bent() const noexcept;
  void send_if_due();
  std::string idle_text() const;

  OperatorSource& source_;
  std::string robot_;
  CommandInput& input_;
  const DriverManner manner_;
  Command asked_;
  Doing doing_ = Doing::kIdle;
  std::int64_t doing_since_ns_ = 0, send_at_ns_ = 0, letting_go_since_ns_ = 0;
  Command sent_;
  std::int64_t seen_presses_ = 0;  // presses that have been handled
  std::optional<std::int8_t> mode_;
  std::int64_t session_ = 0;
  bool limits_known_ = false, held_back_ = false, letting_go_ = false, gone_ = false;
  std::optional<Climb> climb_;
  std::optional<ModeWish> stop_, descent_, errand_;
  std::string errand_done_;  // text after errand_ was reached
  std::optional<HoistWish> hoist_;
  std::string text_;
};

}  // namespace pmg::ops
