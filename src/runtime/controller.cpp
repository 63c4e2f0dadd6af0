#include "runtime/controller.hpp"

#include <fmt/format.h>
#include <time.h>

#include <chrono>
#include <stdexcept>
#include <utility>

namespace pmg::runtime {

namespace {

using std::chrono::milliseconds;

/// The control cycle begins so long after a bus cycle: the drives have answered by then, and half a bus period and more
/// is left for the tick, so that its command goes out with the next exchange.
constexpr std::int64_t kControlAfterBus_ns = 800'000;
constexpr std::int64_t kStartDelay_ns = 2 * hal::BusCycle::kPeriod_ns;
constexpr milliseconds kPoll{1};
constexpr int kRecorderPause_ms = 20;

ThreadSchedule scheduled(ThreadSchedule schedule, bool realtime) {
  if (!realtime) {
    schedule.priority = 0;
    schedule.cpu = -1;
  }
  return schedule;
}

}  // namespace

Controller::Controller(const model::RobotModel& robot, hal::Hal& bus, control::Tick& tick,
                       const ControllerOptions& options)
    : options_(options),
      inbox_(link_.stop),
      phase_source_(dynamic_cast<const hal::PhaseSource*>(&bus)),
      bus_cycle_(bus, link_, robot, clock_, tick.guard()),
      control_cycle_(tick, link_, inbox_, clock_) {
  if (options.waits) turns_.emplace();
  if (options.realtime) refused_ = lock_memory();
  bus_thread_ = std::make_unique<PeriodicThread>(
      scheduled(options.bus, options.realtime), hal::BusCycle::kPeriod_ns,
      [this](const control::CycleTiming& timing) { run_bus(timing); }, &phase_ns_);
  control_thread_ = std::make_unique<PeriodicThread>(
      scheduled(options.control, options.realtime), control::ControlCycle::kPeriod_ns,
      [this](const control::CycleTiming& timing) { run_control(timing); }, &phase_ns_);
  for (const PeriodicThread* thread : {bus_thread_.get(), control_thread_.get()}) {
    refused_.insert(refused_.end(), thread->refused().begin(), thread->refused().end());
  }
  if (!options.realtime) refused_.push_back("real-time scheduling was not asked for");
}

Controller::~Controller() { stop(); }

void Controller::run_bus(const control::CycleTiming& timing) noexcept {
  for (int due = turns_ ? turns_->due(clock_.now_ns()) : 1; due > 0; --due) bus_cycle_.run();
  if (turns_) turns_->ran();
  if (phase_source_ != nullptr) phase_ns_.fetch_add(phase_source_->phase_shift_ns(), std::memory_order_relaxed);
  if (bus_cycle_.sample().status == hal::BusStatus::kOk) drives_answered_.store(true, std::memory_order_release);
  control::CycleTiming done = timing;
  done.done_ns = clock_.now_ns();
  outbox_.put(done);
}

void Controller::run_control(const control::CycleTiming& timing) noexcept {
  if (turns_) await_bus();
  // Where a simulation waits, a tick is late by its own work alone.
  control_cycle_.run(turns_ ? clock_.now_ns() : timing.planned_ns);
  if (turns_) turns_->ticked(timing.planned_ns);
  record_ = control_cycle_.record();
  record_.timing = timing;
  record_.timing.done_ns = clock_.now_ns();
  outbox_.put(record_);
  const control::TickResult& result = record_.result;
  news_.put({.now_ns = record_.now_ns,
             .mode = result.mode,
             .hanging = control::hanging(result.maker),
             .sitting = control::sitting_down(result.maker),
             .fault = result.fault,
             .driving = result.driving});
  mode_.store(result.mode, std::memory_order_release);
}

void Controller::await_bus() noexcept {
  constexpr timespec kLook{.tv_sec = 0, .tv_nsec = Turns::kLook_ns};
  while (!turns_->may_tick()) clock_nanosleep(CLOCK_MONOTONIC, 0, &kLook, nullptr);
}

void Controller::start(Pass comms, Pass recorder) {
  comms_ = std::move(comms);
  recorder_ = std::move(recorder);
  started_ = true;
  const std::int64_t first_ns = clock_.now_ns() + kStartDelay_ns;
  bus_thread_->start(first_ns);
  await_first_sample();
  const std::int64_t cycles = (clock_.now_ns() - first_ns) / hal::BusCycle::kPeriod_ns + 2;
  control_thread_->start(first_ns + cycles * hal::BusCycle::kPeriod_ns + kControlAfterBus_ns);
  comms_thread_ = repeat("comms", comms_, 0);
  recorder_thread_ = repeat("recorder", recorder_, kRecorderPause_ms);
}

void Controller::await_first_sample() {
  const std::int64_t deadline_ns = clock_.now_ns() + io::nanoseconds(options_.first_sample_within_s);
  while (!drives_answered_.load(std::memory_order_acquire)) {
    if (clock_.now_ns() > deadline_ns) {
      stopped_ = true;
      bus_thread_->stop();
      throw std::runtime_error(
          fmt::format("the drives did not answer within {:.1f} s: are they powered and is the bus connected?",
                      options_.first_sample_within_s));
    }
    std::this_thread::sleep_for(kPoll);
  }
}

std::jthread Controller::repeat(const char* name, Pass& pass, int pause_ms) {
  return std::jthread([this, name, &pass, pause_ms](const std::stop_token& stop) {
    pthread_setname_np(pthread_self(), name);
    while (!stop.stop_requested() && try_pass(name, pass)) {
      if (pause_ms > 0) std::this_thread::sleep_for(milliseconds(pause_ms));
    }
  });
}

bool Controller::try_pass(const char* name, Pass& pass) {
  std::string what;
  try {
    pass();
    return true;
  } catch (const std::exception& error) {
    what = error.what();
  } catch (...) {
    what = "unknown exception";
  }
  link_.stop.pull();  // first of all
  const std::lock_guard lock(failure_mutex_);
  if (failure_.empty()) failure_ = fmt::format("thread {}: {}", name, what);
  return false;
}

std::string Controller::failure() const {
  const std::lock_guard lock(failure_mutex_);
  return failure_;
}

bool Controller::stop() {
  if (std::exchange(stopped_, true)) return confirmed_;
  if (!started_) return confirmed_;
  link_.stop.pull();  // before anything that might wait
  comms_thread_.request_stop();
  if (comms_thread_.joinable()) comms_thread_.join();
  confirmed_ = await_damping();
  control_thread_->stop();
  bus_thread_->stop();
  recorder_thread_.request_stop();
  if (recorder_thread_.joinable()) recorder_thread_.join();
  try_pass("comms", comms_);
  try_pass("recorder", recorder_);
  return confirmed_;
}

bool Controller::await_damping() {
  // With comms gone this thread is the inbox's only writer, and nobody can ask for another mode.
  control::ModeRequest damping;
  damping.source = control::Source::make("controller", 1);
  damping.sequence = 1;
  damping.mode = control::Mode::kDamping;
  damping.received_ns = damping.stamp_ns = clock_.now_ns();
  inbox_.put(damping);
  const std::int64_t deadline_ns = clock_.now_ns() + io::nanoseconds(options_.confirm_stop_within_s);
  const auto damps = [this] {
    const control::Mode mode = mode_.load(std::memory_order_acquire);
    return mode == control::Mode::kDamping || mode == control::Mode::kFault;
  };
  while (!damps() && clock_.now_ns() < deadline_ns) std::this_thread::sleep_for(kPoll);
  std::this_thread::sleep_for(std::chrono::nanoseconds(io::nanoseconds(options_.damp_s)));
  return damps();
}

}  // namespace pmg::runtime
