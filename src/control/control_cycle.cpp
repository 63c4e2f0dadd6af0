#include "control/control_cycle.hpp"

namespace pmg::control {

ControlCycle::ControlCycle(Tick& tick, hal::BusLink& link, OperatorInbox& inbox, const io::Clock& clock)
    : tick_(tick), link_(link), inbox_(inbox), clock_(clock) {}

void ControlCycle::run(std::int64_t planned_ns) noexcept {
  // Pulls are counted before the queue is read: a pull that is seen has its request in the queue already.
  const std::uint32_t pulls = link_.stop.pulls();
  record_.stop = pulls != output_.stops_seen;
  output_.stops_seen = pulls;
  take_sample();
  take_messages();
  record_.late_ns = late_ns_;
  record_.policy_late = late_ns_ > 0 && record_.result.times.policy_ns > kPeriod_ns;
  record_.now_ns = clock_.now_ns();
  const TickResult& result = tick_.step(record_.input());
  output_.joints = result.command;
  link_.commands.put(output_);
  record_.result = result;
  record_.tick = next_tick_++;
  late_ns_ = clock_.now_ns() - (planned_ns + kPeriod_ns);
}

void ControlCycle::take_sample() noexcept {
  link_.samples.take(sample_);  // without news the old sample stays, and its stamp grows old
  record_.state = sample_.state;
  record_.bus = sample_.status;
  record_.guard_trip = sample_.trips != output_.trips_seen ? sample_.trip_cause : hal::TripCause::kNone;
  output_.trips_seen = sample_.trips;
}

void ControlCycle::take_messages() noexcept {
  record_.drive_count = record_.request_count = record_.arms_count = 0;
  while (record_.drive_count < kMaxDrives && inbox_.take(record_.drives[record_.drive_count])) ++record_.drive_count;
  while (record_.request_count < kMaxRequests && inbox_.take(record_.requests[record_.request_count])) {
    ++record_.request_count;
  }
  while (record_.arms_count < kMaxArms && inbox_.take(record_.arms[record_.arms_count])) ++record_.arms_count;
}

}  // namespace pmg::control
