#include "recording/bus_timing.hpp"

#include <algorithm>

namespace pmg::recording {

void BusTiming::add(const control::CycleTiming& cycle) noexcept {
  ++cycles;
  wake_max_ns = std::max(wake_max_ns, cycle.woke_ns - cycle.planned_ns);
  exchange_max_ns = std::max(exchange_max_ns, cycle.done_ns - cycle.woke_ns);
  missed = cycle.missed;
}

void BusTiming::start_anew() noexcept { *this = {.missed = missed}; }

void BusCycleReader::take_until(std::int64_t until_ns, BusTiming& into) noexcept {
  while (held_ || outbox_.bus_cycles.pop(cycle_)) {
    held_ = cycle_.done_ns > until_ns;
    if (held_) return;
    into.add(cycle_);
  }
}

}  // namespace pmg::recording
