// The robot's controller: bus and control in real-time threads, messages and log in ordinary ones. Lockstep runs the
// same objects in one thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "control/control_cycle.hpp"
#include "control/controller_outbox.hpp"
#include "control/operator_inbox.hpp"
#include "hal/bus_cycle.hpp"
#include "hal/phase_source.hpp"
#include "io/clock.hpp"
#include "io/mailbox.hpp"
#include "runtime/periodic_thread.hpp"
#include "runtime/turns.hpp"

namespace pmg::runtime {

struct ControllerOptions {
  bool realtime = true;  ///< false: ordinary scheduling, nothing locked
  bool waits = false;    ///< of a simulation: a thread that is late stops the physics (runtime/turns.hpp)
  /// The bus before the control tick: whatever the tick does, the drives are answered and the guard can act.
  ThreadSchedule bus{.name = "bus", .priority = 80};
  ThreadSchedule control{.name = "control", .priority = 70};
  double first_sample_within_s = 2.0;  ///< the drives must answer once before control starts
  double confirm_stop_within_s = 0.5;  ///< how long stop() waits for the control thread's damping
  double damp_s = 0.2;                 ///< how long stop() lets the drives damp before the threads end
};

/// The part of a tick that a console shows.
struct ControllerNews {
  std::int64_t now_ns = 0;
  control::Mode mode = control::Mode::kPassive;
  bool hanging = false;
  bool sitting = false;  ///< in Fault: the robot is lowered before the drives damp
  faults::Fault fault;
  control::Source driving;
};

class Controller {
 public:
  /// One pass of an ordinary thread, which repeats it. An exception ends the thread and damps the robot; failure()
  /// keeps its text.
  using Pass = std::function<void()>;

  /// Keeps references; the bus guard gets the tick's options. Makes the real-time threads, which wait for start().
  /// Throws std::system_error when there are no threads to be had.
  Controller(const model::RobotModel& robot, hal::Hal& bus, control::Tick& tick, const ControllerOptions& options = {});
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;
  ~Controller();  ///< stops

  control::OperatorInbox& inbox() noexcept {
    return inbox_;
  }  ///< to be written by comms alone, and by others before start()
  control::ControllerOutbox& outbox() noexcept { return outbox_; }
  const control::ControllerOutbox& outbox() const noexcept { return outbox_; }
  /// The real-time scheduling that the system refused, in words; known before start().
  const std::vector<std::string>& refused() const noexcept { return refused_; }
  pid_t bus_thread() const noexcept { return bus_thread_->id(); }
  pid_t control_thread() const noexcept { return control_thread_->id(); }

  /// Starts the bus; when the drives have answered, control; then comms and recorder. comms blocks for some
  /// milliseconds itself; recorder is called every 20 ms. Throws std::runtime_error when the drives don't answer.
  void start(Pass comms, Pass recorder);

  /// The newest tick; false when there was none since the last call. One reader.
  bool news(ControllerNews& news) noexcept { return news_.take(news); }
  /// Empty while all threads are well.
  std::string failure() const;

  /// Damps, waits until the control thread confirms, keeps damping for a moment, ends the threads in the order comms,
  /// control, bus, recorder, and gives comms and recorder a last pass. False when the control thread did not confirm
  /// (the bus damped all the same). Further calls return the first one's answer.
  bool stop();

  const CycleStatistics& bus_statistics() const noexcept { return bus_thread_->statistics(); }  ///< after stop()
  const CycleStatistics& control_statistics() const noexcept {
    return control_thread_->statistics();
  }                                                                       ///< after stop()
  const hal::BusCycle& bus_cycle() const noexcept { return bus_cycle_; }  ///< after stop()
  const std::optional<Turns>& turns() const noexcept { return turns_; }   ///< nullopt: nothing waits

 private:
  void run_bus(const control::CycleTiming& timing) noexcept;
  void run_control(const control::CycleTiming& timing) noexcept;
  void await_first_sample();
  void await_bus() noexcept;
  std::jthread repeat(const char* name, Pass& pass, int pause_ms);
  bool try_pass(const char* name, Pass& pass);  // false: it threw
  bool await_damping();

  ControllerOptions options_;
  io::WallClock clock_;
  hal::BusLink link_;
  control::OperatorInbox inbox_;
  control::ControllerOutbox outbox_;
  const hal::PhaseSource* phase_source_;  // null: the drives have no clock
  hal::BusCycle bus_cycle_;
  control::ControlCycle control_cycle_;
  std::optional<Turns> turns_;
  control::TickRecord record_;  // the control thread's
  io::Mailbox<ControllerNews> news_;
  std::atomic<bool> drives_answered_{false};
  std::atomic<control::Mode> mode_{control::Mode::kPassive};
  Pass comms_, recorder_;
  std::vector<std::string> refused_;
  std::atomic<std::int64_t> phase_ns_{0};  // by which the drives' clock has moved both threads
  std::unique_ptr<PeriodicThread> bus_thread_, control_thread_;
  std::jthread comms_thread_, recorder_thread_;
  mutable std::mutex failure_mutex_;  // ordinary threads only
  std::string failure_;
  bool started_ = false, stopped_ = false, confirmed_ = true;
};

}  // namespace pmg::runtime
