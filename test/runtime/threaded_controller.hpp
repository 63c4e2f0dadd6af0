// Shared by tests of the threaded controller: an operator, a bus that can be broken, and waiting for a condition.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "control/fixtures.hpp"
#include "runtime/controller.hpp"
#include "sil/simulated_robot.hpp"

namespace pmg::test {

/// True if the condition holds within a time that every working machine reaches. It looks every 2 ms: spinning would
/// take a processor from the threads under test.
inline bool eventually(const std::function<bool()>& condition, double deadline_s = 30.0) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(deadline_s);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

/// Passes another bus on until a test makes it lose it.
class BreakableBus final : public hal::Hal {
 public:
  explicit BreakableBus(hal::Hal& bus) : bus_(bus) {}
  hal::BusStatus exchange(const model::JointCommand& command, model::RobotState& state) noexcept override {
    last_kp_sum.store(command.kp.sum());
    last_kd_sum.store(command.kd.sum());
    if (lost) return hal::BusStatus::kLost;
    return bus_.exchange(command, state);
  }
  std::atomic<bool> lost{false};
  std::atomic<double> last_kp_sum{-1.0}, last_kd_sum{-1.0};  ///< of the last command

 private:
  hal::Hal& bus_;
};

/// Wraps another policy (default: the reference alone); other threads may freeze it or make it use the heap.
class SwitchablePolicy final : public policy::Policy {
 public:
  explicit SwitchablePolicy(std::unique_ptr<policy::Policy> inner = nullptr)
      : inner_(inner ? std::move(inner) : std::make_unique<policy::ReferencePolicy>()) {}
  Variant variant() const override { return inner_->variant(); }
  std::optional<policy::DriveGains> gains() const override { return inner_->gains(); }
  std::optional<double> action_bound_rad() const override { return inner_->action_bound_rad(); }
  void reset() noexcept override { inner_->reset(); }
  void unsent() noexcept override { inner_->unsent(); }
  bool needs_ground() const override { return inner_->needs_ground(); }
  policy::Status act(const model::RobotState& state, const Reference& reference, const Command& observed,
                     JointVector& q_des) noexcept override {
    while (freeze) std::this_thread::yield();
    if (use_heap) heap_ = std::make_unique<double>(reference.phase);
    if (use_lock) const std::lock_guard lock(mutex_);
    return inner_->act(state, reference, observed, q_des);
  }
  std::atomic<bool> freeze{false}, use_heap{false}, use_lock{false};

 private:
  std::unique_ptr<policy::Policy> inner_;
  std::unique_ptr<double> heap_;
  std::mutex mutex_;
};

/// A test's work in the comms thread: a command and palms' targets every 5 ms and, on demand, one request.
class TestOperator {
 public:
  explicit TestOperator(control::OperatorInbox& inbox) : inbox_(inbox) {
    drive_.source = request_.source = control::Source::make("test", 1);
    drive_.lease_s = 0.5;
    drive_.command[kVx] = 0.4;
    arms_.source = drive_.source;
    arms_.lease_s = 0.1;
    arms_.arm[kLeft] = {.wish = control::ArmWish::kAim, .palm = {.p_m = {0.3, 0.25, 0.15}}};
    arms_.arm[kRight] = {.wish = control::ArmWish::kAim, .palm = {.p_m = {0.3, -0.25, 0.15}}};
  }
  void operator()() {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    drive_.stamp_ns = drive_.received_ns = request_.stamp_ns = request_.received_ns = clock_.now_ns();
    ++drive_.sequence;
    inbox_.put(drive_);
    arms_.stamp_ns = arms_.received_ns = drive_.stamp_ns;
    ++arms_.sequence;
    inbox_.put(arms_);
    if (!asked_.exchange(false)) return;
    ++request_.sequence;
    request_.mode = wanted_;
    request_.reset_fault = reset_;
    inbox_.put(request_);
  }
  /// From any thread; the request goes out with the next message.
  void ask(control::Mode mode, bool reset = false) {
    wanted_ = mode;
    reset_ = reset;
    asked_ = true;
  }

 private:
  control::OperatorInbox& inbox_;
  io::WallClock clock_;
  control::DriveMessage drive_;
  control::ModeRequest request_;
  control::ArmsMessage arms_;
  std::atomic<bool> asked_{false}, reset_{false};
  std::atomic<control::Mode> wanted_{control::Mode::kPassive};
};

/// A simulated robot on the gantry under the threaded controller.
struct ThreadedRobot {
  explicit ThreadedRobot(const model::RobotModel& model, const runtime::ControllerOptions& options = {},
                         std::unique_ptr<policy::Policy> walker = nullptr)
      : world(model, sil::world_with_noise(1, true)),
        robot(world, sil::HoistedBy::kGantry, true),
        bus(robot),
        policy(new SwitchablePolicy(std::move(walker))),
        tick(model, clips(model), std::unique_ptr<policy::Policy>(policy), clock, tick_options(model)),
        controller(model, bus, tick, options),
        speaker(controller.inbox()) {}

  static control::TickOptions tick_options(const model::RobotModel& model) {
    control::TickOptions options = control::tick_options(model);
    sil::expect_shared_host(options);
    return options;
  }

  /// Repeats the request until the mode is reached, because a tick may have to refuse one.
  bool reach(control::Mode mode, bool reset = false) {
    std::int64_t asked_ns = 0;
    return eventually([&] {
      runtime::ControllerNews newest;
      if (controller.news(newest)) news = newest;
      if (news.mode == mode) return true;
      if (clock.now_ns() - asked_ns > 200'000'000) {
        asked_ns = clock.now_ns();
        speaker.ask(mode, reset);
      }
      return false;
    });
  }
  bool sees(control::Mode mode) {
    return eventually([&] {
      runtime::ControllerNews newest;
      if (controller.news(newest)) news = newest;
      return news.mode == mode;
    });
  }

  io::WallClock clock;
  sim::World world;
  sil::SimulatedRobot robot;
  BreakableBus bus;
  SwitchablePolicy* policy;
  control::Tick tick;
  runtime::Controller controller;
  TestOperator speaker;
  runtime::ControllerNews news;
};

}  // namespace pmg::test
