// Drives one robot by keys: (keys) => commands and requests for modes on the network.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "operator/climb.hpp"
#include "operator/hoist_wish.hpp"
#include "operator/key_command.hpp"
#include "operator/mode_wish.hpp"
#include "operator/operator_source.hpp"

namespace pmg::ops {

/// For one thread. Sends commands only while the robot shall move, so an idle keyboard does not block other operators.
///
/// A key for a velocity or a posture takes the robot from any mode to Walk, except after a stop by any operator and
/// after a fault. Then the robot rises only when its operator asks for Stand (Key::kStand).
class KeyboardDriver {
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

  /// Keeps a reference. robot: its controller's name.
  KeyboardDriver(OperatorSource& source, std::string robot, KeyReport report);

  /// Until the robot's limits are known a key commands nothing; one that is still held then takes effect.
  void set_limits(const CommandLimits& limits) noexcept {
    keys_.set_limits(limits);
    limits_known_ = true;
  }

  void press(Key key, bool fast);
  void repeat(Key key, bool fast) { keys_.repeat(key, fast, now_ns()); }
  void press_other() noexcept { keys_.press_other(); }
  void release(Key key) { keys_.release(key, now_ns()); }
  void release_all() noexcept { keys_.release_all(); }
  void listen() noexcept { keys_.listen(now_ns()); }

  /// Call after each link.receive(), at least every 10 ms.
  void step();

  /// Velocity to zero, then Stand; further keys have no effect.
  void let_go();
  bool gone() const noexcept { return gone_; }  ///< let_go() is complete

  const std::string& robot() const noexcept { return robot_; }
  const Command& asked() const noexcept { return asked_; }  ///< the keys' command at this moment
  std::string text() const;  ///< for people: the driver's state, or why the robot doesn't move
  bool driving() const noexcept { return doing_ == Doing::kDriving; }

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
  void follow_keys();
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
  const KeyReport report_;
  KeyCommand keys_;
  Command asked_;
  Doing doing_ = Doing::kIdle;
  std::int64_t doing_since_ns_ = 0, send_at_ns_ = 0, letting_go_since_ns_ = 0;
  Command sent_;
  std::int64_t seen_presses_ = 0;  // presses that have been handled
  std::optional<std::int8_t> mode_;
  std::int64_t session_ = 0;
  bool limits_known_ = false, held_back_ = false, letting_go_ = false, gone_ = false;
  std::optional<Climb> climb_;
  std::optional<ModeWish> stop_, descent_, reset_;
  std::optional<HoistWish> hoist_;
  std::string text_;
};

}  // namespace pmg::ops
