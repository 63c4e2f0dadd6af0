// The machine that drives one robot: (a device's wishes) => commands and requests for modes on the network.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "operator/climb.hpp"
#include "operator/device.hpp"
#include "operator/heading_hold.hpp"
#include "operator/hoist_wish.hpp"
#include "operator/hold_to_drive.hpp"
#include "operator/mode_wish.hpp"
#include "operator/operator_source.hpp"
#include "operator/robot_board.hpp"
#include "operator/taken_command.hpp"

namespace pmg::ops {

/// For one thread. Sends commands only while the robot shall move, so idle hands do not block other operators.
///
/// - Velocity has effect only while a hold is armed (HoldToDrive).
/// - A stop goes out at once, in every state. It is repeated until it is answered, and nothing else is asked before.
/// - After a stop by any operator, a fault or a controller's restart the robot rises only when its operator asks for
///   Stand or Walk.
/// - A simulated robot keeps its heading where its device asks for no turn (HeadingHold).
/// - Where the controller falls silent, or another source drives, nothing more is sent; afterwards a fresh press is
///   needed.
class RobotDriver {
 public:
  static constexpr std::int64_t kPeriod_ns = 20'000'000;
  static constexpr double kLease_s = 0.5;  ///< a crashed operator's program blocks the others for this time at most
  static constexpr double kLastLease_s = 0.02;  ///< of the last command, so that the next source need not wait
  static constexpr double kArmsLease_s = 0.2;   ///< ten messages may be lost
  /// After this time the velocity is zero: the generator's ramp and a margin.
  static constexpr std::int64_t kCalm_ns = 600'000'000;
  static constexpr std::int64_t kSettle_ns =
      300'000'000;  ///< after this time the controller must show this source as driving
  static constexpr std::int64_t kSilent_ns = 500'000'000;  ///< a controller that has been silent for this time is gone
  static constexpr std::int64_t kSimulationSilent_ns =
      2'000'000'000;                                        ///< the same of a simulated one, whose computer may be busy
  static constexpr std::int64_t kLetGo_ns = 2'000'000'000;  ///< how long let_go() waits for Stand

  /// Keeps references. robot: its controller's name.
  RobotDriver(OperatorSource& source, std::string robot, Device& device);

  void stop();  ///< damps at once
  /// Acts on what the device asks for once. step() does so too; call this after the device's events, before waiting.
  void heed();
  /// Call after each link.receive(), at least every 10 ms. news: the robot's; null: none yet.
  void step(const RobotNews* news = nullptr);
  /// step() takes the limits from ROBOT_INFO. Before they are known a device commands nothing; what is still held then
  /// takes effect.
  void set_limits(const CommandLimits& limits) noexcept { device_.set_limits(limits); }

  /// Velocity to zero, then Stand; further input has no effect.
  void let_go();
  bool letting_go() const noexcept { return letting_go_; }
  bool gone() const noexcept { return gone_; }  ///< let_go() is complete

  const std::string& robot() const noexcept { return robot_; }
  const Command& asked() const noexcept { return asked_; }  ///< the device's command at this moment
  std::string text() const;  ///< for people: the driver's state, or why the robot doesn't move
  bool driving() const noexcept { return doing_ == Doing::kDriving; }
  bool idle() const noexcept { return doing_ == Doing::kIdle; }
  /// While idle(): why it no longer drives. Empty: nobody asks for more.
  std::string why_idle() const { return whole_text(); }
  /// The source whose lease must end first: it drove, fell silent and did not let go. Empty: none.
  std::string waits_for() const;
  /// What the controller follows in place of the newest command, and why. Empty: it follows the command.
  const std::string& limited() const noexcept { return limited_; }
  const HoldToDrive& hold() const noexcept { return hold_; }
  bool silent() const;  ///< the controller was heard and is no longer, or never was

 private:
  enum class Doing { kIdle, kClimbing, kClaiming, kDriving, kCalming, kDescending };

  std::int64_t now_ns() const { return source_.clock().now_ns(); }
  std::int64_t in_doing_ns() const { return now_ns() - doing_since_ns_; }
  void enter(Doing doing);
  // Requests; none has effect after let_go() and while a stop waits for its answer.
  void act(Request request);
  void rise(Goal to);
  void reset();
  void limp();
  void hoist(bool lift);

  void climb(Goal to);
  /// needs_way: the way up belongs behind the text.
  void idle(const std::string& text, bool needs_way = false);
  void rest();
  void hold_back(const std::string& text);

  void hear(const RobotNews* news);
  void watch_mode();
  void follow_errands();
  void follow_device();
  void follow_climb();
  void follow_claim();
  void follow_drive();
  void descend();
  std::string trouble() const;
  void note_limits(bool last);
  bool wants_to_move() const noexcept { return moves() || bent(); }
  bool moves() const noexcept;
  bool bent() const noexcept;
  void send_if_due();
  std::string idle_text() const;
  bool listened() const;  ///< the last request was this operator's to make
  /// text_, and the way up where the robot waits for it.
  std::string whole_text() const;
  std::string way() const;
  std::string silence_words() const;

  OperatorSource& source_;
  std::string robot_;
  Device& device_;
  const DeviceManner manner_;
  ArmsSource arms_;
  HoldToDrive hold_;
  HeadingHold heading_;
  Command asked_, sent_;
  const RobotNews* news_ = nullptr;
  Doing doing_ = Doing::kIdle;
  std::int64_t doing_since_ns_ = 0, send_at_ns_ = 0, letting_go_since_ns_ = 0, claim_since_ns_ = 0;
  std::optional<std::int8_t> mode_;
  std::int64_t session_ = 0;
  std::optional<std::int64_t> limits_session_;
  bool wanted_before_ = false;  // in the last step, so that a wish that begins is seen
  bool climbed_ = false;        // this stretch of driving began below Walk, so it ends in Stand
  bool held_back_ = false, letting_go_ = false, gone_ = false;
  std::optional<Climb> climb_;
  std::optional<ModeWish> stop_, descent_, errand_;
  std::string errand_done_;  // text after errand_ was reached
  std::optional<HoistWish> hoist_;
  std::optional<TakenCommand> taken_;
  std::string text_, limited_;
  bool needs_way_ = false;  // as idle() has it
};

}  // namespace pmg::ops
