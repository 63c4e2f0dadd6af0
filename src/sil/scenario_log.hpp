// The steps of a scenario in a run's log.
#pragma once

#include <cstddef>
#include <cstdint>

#include "recording/tick_log.hpp"
#include "sil/scenario.hpp"

namespace pmg::sil {

/// Writes SCENARIO once where the step changes. Allocates there, and nowhere else.
class ScenarioLog {
 public:
  /// Keeps references to both.
  ScenarioLog(recording::TickLog& log, const Scenario& scenario) : log_(log), scenario_(scenario) {}

  /// Call it before every tick. Writes when the number of the step, counted from 1, has changed.
  void write(std::int64_t stamp_ns, std::size_t number);

 private:
  recording::TickLog& log_;
  const Scenario& scenario_;
  std::size_t last_ = 0;
};

}  // namespace pmg::sil
