// The list of all effects, in the order of the documentation: for each a function that makes its entry of the
// catalogue. It is defined in the file of its name.
#pragma once

#include "effects/catalogue.hpp"
#include "effects/starts.hpp"

// clang-format off
#define PMG_EFFECTS(ENTRY)                                                                                           \
  ENTRY(coulomb) ENTRY(viscous) ENTRY(stribeck) ENTRY(load_friction) ENTRY(direction_friction) ENTRY(offset)         \
  ENTRY(backlash) ENTRY(compliance) ENTRY(delay) ENTRY(rate_limit) ENTRY(hold) ENTRY(torque_speed) ENTRY(supply_sag) \
  ENTRY(gain) ENTRY(dead_band) ENTRY(sensor_lag) ENTRY(quantisation) ENTRY(zero_offset) ENTRY(cogging)               \
  ENTRY(hysteresis) ENTRY(eccentricity) ENTRY(thermal_drift) ENTRY(self_heating) ENTRY(load)
// clang-format on

#define PMG_EFFECT(name) Effect name();
namespace pmg::effects::named {
PMG_EFFECTS(PMG_EFFECT)
}
#undef PMG_EFFECT
