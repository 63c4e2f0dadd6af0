// The sensor, and what repeats with the joint's angle.
#include <algorithm>

#include "calib/unknown.hpp"
#include "effects/families.hpp"
#include "effects/zero_slip.hpp"

namespace pmg::effects {

namespace {

Values quantum(const StartsFrom& from) {
  return from.scale.quantum_rad > 0.0 ? Values{{from.scale.quantum_rad}} : Values{};
}

/// Orders that lie so many periods over the range apart.
Values waves(const StartsFrom& from, double amplitude, double periods, double highest) {
  Values found;
  const double lowest = lowest_order(from.scale), step = std::clamp(periods * lowest, 0.5, 4.0);
  for (double order = lowest; order <= highest; order += step) found.push_back({amplitude, order, 0.0});
  return found;
}

Values waves_of_torque(const StartsFrom& from) { return waves(from, 0.1 * from.scale.torque_Nm, 0.25, 64.0); }
Values waves_of_two(const StartsFrom& from) {
  Values found;
  for (const std::vector<double>& wave : waves(from, 0.1 * from.scale.torque_Nm, 0.25, 32.0))
    found.push_back({wave[0], wave[1], wave[2], 0.5 * wave[0], 0.0});
  return found;
}
Values waves_of_share(const StartsFrom& from) { return waves(from, 0.2, 0.5, 32.0); }
Values waves_of_angle(const StartsFrom& from) { return waves(from, 0.005, 0.5, 32.0); }

bool may_slip(const StartsFrom& from) { return from.scale.recordings >= 2 * kFewestBesideSlip; }

}  // namespace

std::vector<Effect> sensor_effects() {
  return {
      {.name = "sensor_lag",
       .title = "sensor lag",
       .forms = {law("first_order", "of first order", {"sensor.lag_s"}, "Oppenheim, Willsky 1997",
                     each({2.0, 5.0, 10.0, 20.0})),
                 law("tracking", "of a tracking loop", {"sensor.lag_s"}, "Ellis 2002", each({2.0, 5.0, 10.0, 20.0}),
                     {{"sensor.lag_stages", 2.0}}),
                 law("average", "of a moving average", {"sensor.lag_s"}, "Smith 1997", each({2.0, 5.0, 10.0, 20.0}),
                     {{"sensor.lag_stages", 3.0}})},
       .shows = "rings more than damping explains",
       .needs = "steps",
       .workshop = {"a position reading that comes late",
                    "Look into the settings of the drive for a filter on the position sensor.",
                    "It brakes too late, overshoots and swings."}},
      {.name = "quantisation",
       .title = "quantisation",
       .forms = {law("rounds", "", {"sensor.quantum_rad"}, "Widrow, Kollar 2008", quantum)},
       .shows = "readings are multiples of one number",
       .needs = "slow motion",
       .workshop = {"position readings in coarse steps",
                    "Check the resolution of the encoder, and how many digits the recording keeps.",
                    "The speed that the drive computes is rough: it growls and wears."},
       .demonstration = {.command = shown::slow_sine}},
      {.name = "zero_offset",
       .title = "zero offset",
       .forms = {law("constant", "always the same", {"sensor.zero_offset_rad"}, "Mooring, Roth, Driels 1991",
                     each({-0.05, -0.01, 0.01, 0.05})),
                 called({.what = "a zero of the position sensor that slipped between two recordings",
                         .check = "Check that magnet, coupling and arm sit firmly on the shaft. Set the zero again, "
                                  "and repeat the recordings after the slip."},
                        law("slips", "that slipped between two recordings",
                            {calib::kZeroSlip, "sensor.zero_offset_rad", calib::kZeroSlipAt},
                            "Mooring, Roth, Driels 1991", where(may_slip, these({{0.03, 0.0, 0.0}}))))},
       .shows = "misses by a constant where gravity differs",
       .needs = "a load that hangs",
       .workshop =
           {"a wrong zero of the position sensor",
            "Put the joint on its mark and compare the reading with the angle. If it slipped, check that magnet, "
            "coupling and arm sit firmly on the shaft. Set the zero again.",
            "Whatever uses this angle is wrong by it: a foot stands tilted, or the robot leans."},
       .shapes = {calib::kZeroSlipAt},
       .strength = opposite},
      {.name = "cogging",
       .title = "cogging",
       .forms =
           {law("sine", "of one size", {"ripple.amplitude_Nm", "ripple.order", "ripple.phase_rad"}, "Jahns, Soong 1996",
                waves_of_torque),
            called(
                {.what = "a torque that goes up and down several times per turn, the more the harder the motor works",
                 .check =
                     "Let the joint hold a weight at many places and compare the currents: do they go up and down? "
                     "Look at the magnets and windings of the motor, and at the current sensors of its drive.",
                 .cost = "Motion under load is uneven."},
                law("current", "in proportion to the drive's torque",
                    {"ripple.torque_share", "ripple.order", "ripple.phase_rad"}, "Holtz, Springob 1996",
                    waves_of_share)),
            law("two_harmonics", "with a second harmonic",
                {"ripple.amplitude_Nm", "ripple.order", "ripple.phase_rad", "ripple.second_Nm",
                 "ripple.second_phase_rad"},
                "Zhu, Howe 2000", waves_of_two)},
       .shows = "misses with the joint's angle, several times a turn",
       .needs = "slow motion over a large part of a turn",
       .workshop = {"a torque that repeats several times per turn",
                    "Switch the motor off and turn the joint slowly by hand: do you feel steps? Look at the magnets of "
                    "the motor and the teeth of the gear.",
                    "Slow motion is uneven, and places between the steps are hard to hold."},
       .demonstration = {.command = shown::slow_ramp, .against = Against::kPosition}},
      {.name = "hysteresis",
       .title = "sensor hysteresis",
       .forms = {law("play", "", {"sensor.hysteresis_rad"}, "Krasnosel'skii, Pokrovskii 1989",
                     each({0.003, 0.01, 0.03}))},
       .shows = "the reading waits at each reversal though the joint moves",
       .needs = "reversals under load",
       .workshop = {"a position sensor that doesn't follow at once when the motion turns",
                    "Check that the encoder sits firmly: screws, magnet, coupling.",
                    "Where it stands depends on where it came from: the robot never stands twice alike."},
       .demonstration = {.command = shown::triangle}},
      {.name = "eccentricity",
       .title = "sensor eccentricity",
       .forms = {law("once_a_turn", "once a turn", {"sensor.eccentricity_rad", "sensor.eccentricity_phase_rad"},
                     "Sanchez-Brea, Morlanes 2008", these({{0.02, 0.0}})),
                 law("ellipse", "of a disc that is not round either",
                     {"sensor.eccentricity_rad", "sensor.eccentricity_phase_rad", "sensor.ellipticity_rad",
                      "sensor.ellipticity_phase_rad"},
                     "Sanchez-Brea, Morlanes 2008", these({{0.02, 0.0, 0.01, 0.0}})),
                 called({.what = "a position sensor on the motor's shaft that isn't centred",
                         .check = "Check that the magnet or disc of the encoder is centred on the motor's shaft."},
                        law("motor_shaft", "of a disc on the motor's shaft",
                            {"sensor.eccentricity_rad", "sensor.eccentricity_order", "sensor.eccentricity_phase_rad"},
                            "Ellin, Dolsak 2008", waves_of_angle))},
       .shows = "misses with the joint's angle, once a turn",
       .needs = "motion over a large part of a turn",
       .workshop = {"a position sensor that isn't centred",
                    "Check that the magnet or disc of the encoder is centred on the shaft.",
                    "Its angle is too large at some places and too small at others."},
       .demonstration = {.command = shown::slow_ramp, .against = Against::kPosition}},
  };
}

}  // namespace pmg::effects
