// The reading passes one to three lags of first order: AngleSensor.
#include "effects/named.hpp"

namespace pmg::effects {

namespace {

Starts sensor_lag_starts(const NominalJoint&) { return each(1e-3, 2.0, 5.0, 10.0, 20.0); }

}  // namespace

Effect named::sensor_lag() {
  return {.name = "sensor_lag",
          .title = "sensor lag",
          .forms = {{.name = "first_order",
                     .title = "of first order",
                     .parameters = {"sensor.lag_s"},
                     .source = "Oppenheim, Willsky 1997",
                     .starts = sensor_lag_starts},
                    {.name = "tracking",
                     .title = "of a tracking loop",
                     .parameters = {"sensor.lag_s"},
                     .fixed = {{"sensor.lag_stages", 2.0}},
                     .source = "Ellis 2002",
                     .starts = sensor_lag_starts},
                    {.name = "average",
                     .title = "of a moving average",
                     .parameters = {"sensor.lag_s"},
                     .fixed = {{"sensor.lag_stages", 3.0}},
                     .source = "Smith 1997",
                     .starts = sensor_lag_starts}},
          .shows = "rings more than damping explains",
          .needs = "steps",
          .workshop = {.what = "a position reading that comes late",
                       .check = "Look into the settings of the drive for a filter on the position sensor.",
                       .cost = "It brakes too late, overshoots and swings."},
          .demonstration = {.with = {{"sensor.lag_s", 0.03}}}};
}

}  // namespace pmg::effects
