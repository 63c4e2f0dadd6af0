// Play and softness between motor and joint.
#include <algorithm>
#include <cmath>

#include "effects/families.hpp"

namespace pmg::effects {

namespace {

/// Stiffness and damping of a shaft that bends by so much under the peak torque, rings damped by a tenth.
std::vector<double> shaft(const StartsFrom& from, double bend_rad) {
  const double rotor = std::max(1e-6, from.actuator.transmission.armature_kg_m2);
  const double reduced = 1.0 / (1.0 / rotor + 1.0 / from.scale.inertia_kg_m2);
  const double stiffness = std::max(from.scale.torque_peak_Nm / bend_rad, 5.0 * from.scale.torque_Nm);
  return {stiffness, 0.1 * 2.0 * std::sqrt(stiffness * reduced)};
}

Values shafts(const StartsFrom& from) { return {shaft(from, 0.005), shaft(from, 0.02), shaft(from, 0.06)}; }

/// A hardening spring begins softer and carries half of the peak torque by its cube.
Values hardening_shafts(const StartsFrom& from) {
  Values found;
  for (const double bend_rad : {0.02, 0.06}) {
    std::vector<double> one = shaft(from, bend_rad);
    one[0] *= 0.5;
    one.push_back(one[0] / (bend_rad * bend_rad));
    found.push_back(one);
  }
  return found;
}

/// Belts that give way by half.
Values belts(const StartsFrom& from) {
  Values found;
  for (const double bend_rad : {0.02, 0.06}) {
    for (const double hysteresis_rad : {0.01, 0.03}) {
      std::vector<double> one = shaft(from, bend_rad);
      one.insert(one.end(), {0.5, hysteresis_rad});
      found.push_back(one);
    }
  }
  return found;
}

Starts plays(const std::vector<double>& bends_rad) {
  return [bends_rad](const StartsFrom& from) {
    Values found;
    for (const double bend_rad : bends_rad) {
      const std::vector<double> one = shaft(from, bend_rad);
      for (const double play_rad : {0.005, 0.02, 0.06}) found.push_back({play_rad, one[0], one[1]});
    }
    return found;
  };
}

}  // namespace

std::vector<Effect> transmission_effects() {
  return {
      {.name = "backlash",
       .title = "backlash",
       .forms =
           {law("friction_before", "with the friction before the gear and the sensor behind it",
                {"transmission.backlash_rad", "transmission.stiffness_Nm_per_rad", "transmission.damping_Nm_s_per_rad"},
                "Nordin, Galic, Gutman 1997", plays({0.005, 0.02, 0.06})),
            law("friction_behind", "with the friction behind the gear",
                {"transmission.backlash_rad", "transmission.stiffness_Nm_per_rad", "transmission.damping_Nm_s_per_rad"},
                "Nordin, Gutman 2002", plays({0.005}), {{"transmission.friction_on_joint", 1.0}}),
            called({.what = "play in the gear that the position sensor doesn't see"},
                   law("sensor_before", "with the sensor before the gear",
                       {"transmission.backlash_rad", "transmission.stiffness_Nm_per_rad",
                        "transmission.damping_Nm_s_per_rad"},
                       "Nordin, Gutman 2002", where(closes_loop, plays({0.005})), {{"sensor.on_motor", 1.0}}))},
       .shows = "a dead spot at each reversal",
       .needs = "reversals with little load",
       .workshop =
           {"play in the gear",
            "Hold the motor still and rock the output by hand: is there a dead spot? Check gear, keys, couplings and "
            "screws.",
            "The limb is loose by this play: it knocks where its load changes sides, and the robot sways within it."},
       .contains = {"compliance"},
       .shapes = {"transmission.stiffness_Nm_per_rad", "transmission.damping_Nm_s_per_rad"},
       .demonstration = {.command = shown::triangle,
                         .both = {{"transmission.stiffness_Nm_per_rad", 2000.0},
                                  {"transmission.damping_Nm_s_per_rad", 2.0}},
                         .gravity_Nm = 0.2}},
      {.name = "compliance",
       .title = "compliance",
       .forms = {law("spring_behind", "of a spring behind the friction",
                     {"transmission.stiffness_Nm_per_rad", "transmission.damping_Nm_s_per_rad"}, "Spong 1987", shafts),
                 law("spring_before", "of a spring before the friction",
                     {"transmission.stiffness_Nm_per_rad", "transmission.damping_Nm_s_per_rad"},
                     "Albu-Schaffer, Ott, Hirzinger 2007", shafts, {{"transmission.friction_on_joint", 1.0}}),
                 law("hardening", "of a spring that hardens",
                     {"transmission.stiffness_Nm_per_rad", "transmission.damping_Nm_s_per_rad",
                      "transmission.hardening_Nm_per_rad3"},
                     "Tuttle, Seering 1996", hardening_shafts),
                 called({.what = "a soft part that the position sensor doesn't see"},
                        law("sensor_before", "behind the sensor",
                            {"transmission.stiffness_Nm_per_rad", "transmission.damping_Nm_s_per_rad"},
                            "Sweet, Good 1985", where(closes_loop, shafts), {{"sensor.on_motor", 1.0}})),
                 called({.what = "a soft part that springs back late, as a belt does"},
                        law("belt", "of a belt with hysteresis",
                            {"transmission.stiffness_Nm_per_rad", "transmission.damping_Nm_s_per_rad",
                             "transmission.hysteretic_share", "transmission.hysteresis_rad"},
                            "Bouc 1967; Wen 1976", belts))},
       .shows = "rings at a frequency of its own; bends with load",
       .needs = "steps, and two loads",
       .workshop = {"a soft part between motor and output",
                    "Hold the motor still and push the output: does it give way and spring back? Check belt, coupling, "
                    "gear and screws.",
                    "The limb gives way under load and swings after each stop."},
       .shapes = {"transmission.damping_Nm_s_per_rad", "transmission.hysteresis_rad"}},
  };
}

}  // namespace pmg::effects
