#include "hal/bus_cycle.hpp"

namespace pmg::hal {

BusCycle::BusCycle(Hal& hal, BusLink& link, const model::RobotModel& robot, const io::Clock& clock,
                   const GuardOptions& options)
    : hal_(hal), link_(link), clock_(clock), guard_(robot, options), sent_(&guard_.next(nullptr, 0)) {}

void BusCycle::run() noexcept {
  const bool fresh = link_.commands.take(incoming_);
  sent_ = &guard_.next(fresh ? &incoming_ : nullptr, link_.stop.pulls());
  sample_.status = hal_.exchange(*sent_, sample_.state);
  // The run's clock stamps what the drives said, whatever clock a backend may have; without an answer the old stamp
  // stays and the control thread sees the state grow old.
  if (sample_.status == BusStatus::kOk) sample_.state.stamp_ns = clock_.now_ns() - sample_.state.age_ns;
  sample_.trips = guard_.trips();
  sample_.trip_cause = guard_.cause();
  link_.samples.put(sample_);
}

}  // namespace pmg::hal
