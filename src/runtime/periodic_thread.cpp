#include "runtime/periodic_thread.hpp"

#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "io/clock.hpp"
#include "runtime/periodic_schedule.hpp"

namespace pmg::runtime {

namespace {

void sleep_until(std::int64_t wake_ns) noexcept {
  const timespec wake{.tv_sec = wake_ns / 1'000'000'000, .tv_nsec = wake_ns % 1'000'000'000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr) == EINTR) {
  }
}

}  // namespace

PeriodicThread::PeriodicThread(const ThreadSchedule& schedule, std::int64_t period_ns, Cycle cycle,
                               const std::atomic<std::int64_t>* shift_ns)
    : schedule_(schedule),
      period_ns_(period_ns),
      cycle_(std::move(cycle)),
      shift_ns_(shift_ns),
      statistics_(period_ns) {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kRealtimeStack_bytes);
  const int error = pthread_create(&thread_, &attributes, &PeriodicThread::enter, this);
  pthread_attr_destroy(&attributes);
  if (error != 0) throw std::system_error(error, std::generic_category(), "thread " + schedule_.name);
  prepared_.acquire();
}

PeriodicThread::~PeriodicThread() { stop(); }

void PeriodicThread::start(std::int64_t first_ns) {
  first_ns_ = first_ns;
  started_.release();
}

void PeriodicThread::stop() noexcept {
  if (std::exchange(joined_, true)) return;
  stopping_.store(true);
  started_.release();  // for one that never started
  pthread_join(thread_, nullptr);
}

void* PeriodicThread::enter(void* self) {
  auto& thread = *static_cast<PeriodicThread*>(self);
  thread.prepare();
  thread.started_.acquire();
  thread.loop();
  return nullptr;
}

void PeriodicThread::prepare() {
  id_ = gettid();
  refused_ = schedule_this_thread(schedule_);
  prefault_stack();
  prepared_.release();
}

void PeriodicThread::loop() noexcept {
  const io::WallClock clock;
  PeriodicSchedule schedule(first_ns_, period_ns_);
  std::int64_t shifted_ns = 0;
  while (true) {
    if (!stopping_.load()) sleep_until(schedule.planned_ns());
    if (stopping_.load()) return;
    control::CycleTiming timing{.planned_ns = schedule.planned_ns(), .missed = schedule.missed()};
    timing.woke_ns = clock.now_ns();
    cycle_(timing);
    timing.done_ns = clock.now_ns();
    statistics_.add(timing);
    schedule.advance(timing.woke_ns, timing.done_ns);
    if (shift_ns_ == nullptr) continue;
    const std::int64_t shift_ns = shift_ns_->load(std::memory_order_relaxed);
    schedule.shift(shift_ns - std::exchange(shifted_ns, shift_ns));
  }
}

}  // namespace pmg::runtime
