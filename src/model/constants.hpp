// Periods that every room means when it says a tick or a bus cycle.
#pragma once

namespace pmg::model {

inline constexpr double kControlPeriod_s = 0.010;  ///< a control tick: 100 Hz
inline constexpr double kBusPeriod_s = 0.002;      ///< a bus cycle, and a physics step: 500 Hz

}  // namespace pmg::model
