// Friction, and the constant torque that looks like it.
#include <algorithm>

#include "effects/families.hpp"

namespace pmg::effects {

namespace {

bool has_viscous_friction(const StartsFrom& from) { return from.actuator.friction.viscous_Nm_s_per_rad > 0.0; }

bool has_no_viscous_friction(const StartsFrom& from) { return !has_viscous_friction(from); }
double usual_damping(const StartsFrom& from) { return usual(model::Quantity::kDamping, from.scale).start; }

std::vector<double> positive_torque(const Measured& m) { return {std::max(0.0, m.torque_Nm)}; }
std::vector<double> slow_torque(const Measured& m) { return {m.torque_Nm, m.slow_rad_s}; }
std::vector<double> both_ways(const Measured& m) { return {m.torque_Nm, m.torque_Nm}; }

/// The balance is drive = load + friction - constant torque (opposite()), and friction is
/// coulomb (1 + asymmetry direction).
std::vector<double> of_coulomb(const Measured& m) {
  const double coulomb_Nm = m.joint.friction.coulomb_Nm;
  return coulomb_Nm > 0.0 ? std::vector<double>{m.torque_Nm / coulomb_Nm} : std::vector<double>{};
}

}  // namespace

std::vector<Effect> friction_effects() {
  return {
      {.name = "coulomb",
       .title = "Coulomb friction",
       .forms = {law("dry", "", {"friction.coulomb_Nm"}, "Coulomb 1785", more_or_less({0.03, 0.1, 0.3, -0.05, -0.2}))},
       .shows = "stops short of the target by the same torque whatever the speed; a free swing's amplitude falls by a "
                "constant",
       .needs = "two gains, and motion that stops",
       .workshop = {"dry friction",
                    "Switch the motor off and turn the joint slowly by hand: does it stick? Look at bearings, seals "
                    "and the alignment of the shaft.",
                    "It stops short of where it should, and small corrections don't move it."},
       .strength = positive_torque,
       .never_negative = true},
      {.name = "viscous",
       .title = "viscous friction",
       .forms = {law("linear", "growing in proportion to speed", {"friction.viscous_Nm_s_per_rad"}, "Stokes 1851",
                     more_or_less({0.03, 0.1, 0.3, -0.05, -0.2})),
                 called(
                     {.what = "friction that grows with the square of the speed"},
                     law("quadratic", "growing with the square of speed", {"friction.viscous_quadratic_Nm_s2_per_rad2"},
                         "Changenet, Oviedo-Marlot, Velex 2006", each({0.1, 0.4})))},
       .shows = "the residual grows with speed",
       .needs = "slow and fast motion; two settings of kd, or a commanded speed",
       .workshop = {"friction that grows with speed",
                    "Switch the motor off and turn the joint by hand, slowly and fast: is fast much harder? Look for "
                    "thick, cold or too much grease.",
                    "Fast motion lags behind and warms the motor."},
       .strength = positive_torque,
       .never_negative = true,
       .demonstration = {.against = Against::kVelocity}},
      {.name = "stribeck",
       .title = "Stribeck friction",
       .forms = {law("exponent_2", "with exponent 2", {"friction.stribeck_Nm", "friction.stribeck_rad_s"},
                     "Armstrong-Helouvry 1991", grid({{-0.15, -0.05, 0.05, 0.15, 0.4}, {0.02, 0.1, 0.4}})),
                 law("exponent_1", "with exponent 1", {"friction.stribeck_Nm", "friction.stribeck_rad_s"},
                     "Tustin 1947", grid({{-0.15, 0.1, 0.3}, {0.05, 0.2}}), {{"friction.stribeck_exponent", 1.0}}),
                 law("exponent_0_5", "with exponent 0.5", {"friction.stribeck_Nm", "friction.stribeck_rad_s"},
                     "Bo, Pavelescu 1982", grid({{-0.15, 0.1, 0.3}, {0.05, 0.2}}),
                     {{"friction.stribeck_exponent", 0.5}})},
       .shows = "sticks, then jumps; negative: friction grows with speed and levels off",
       .needs = "slow motion through rest",
       .workshop = {"friction that is different at very slow motion",
                    "Let the joint move very slowly: does it stick and jump? Clean and grease bearings and seals.",
                    "Slow motion sticks and jumps: the robot sways where it should stand still."},
       .contains = {"coulomb", "viscous"},
       .shapes = {"friction.stribeck_rad_s"},
       .strength = slow_torque,
       .never_negative = true,
       .demonstration = {.command = shown::slow_sine, .kp = 8.0}},
      {.name = "load_friction",
       .title = "load-dependent friction",
       .forms = {law("transmitted", "by the torque through the gear and the direction of power flow",
                     {"friction.load_driving", "friction.load_backdriving"},
                     "Dohring, Lee, Newman 1993; Verstraten et al. 2015",
                     these({{0.1, 0.1}, {0.3, 0.3}, {0.7, 0.4}, {0.2, 0.0}, {0.0, 0.2}})),
                 law("motor", "by the motor's torque", {"friction.load_driving", "friction.load_backdriving"},
                     "Duclusaud, Passault, Padois, Ly 2025", these({{0.1, 0.1}, {0.3, 0.3}}),
                     {{"friction.load_by_motor", 1.0}}),
                 law("net", "by the difference of motor torque and load",
                     {"friction.load_driving", "friction.load_backdriving"}, "Duclusaud, Passault, Padois, Ly 2025",
                     these({{0.1, 0.1}, {0.3, 0.3}}), {{"friction.load_net", 1.0}})},
       .shows = "stops shorter under more load; lifting needs more than holding",
       .needs = "two loads",
       .workshop = {"friction that grows with the load",
                    "Turn the joint with and without its load: does the load make it harder to turn? Look at the "
                    "teeth, the grease and the bearings of the gear.",
                    "It stops shorter the more it carries, and lifting takes more current than holding."},
       .strength = both_ways,
       .never_negative = true},
      {.name = "direction_friction",
       .title = "direction-dependent friction",
       .forms = {law("dry", "of dry friction", {"friction.asymmetry"},
                     "Armstrong-Helouvry, Dupont, Canudas de Wit 1994", each({-0.2, 0.2})),
                 law("viscous", "of viscous friction", {"friction.viscous_asymmetry"},
                     "Canudas de Wit, Astrom, Braun 1987", where(has_viscous_friction, each({-0.5, 0.5}))),
                 law("stribeck", "of Stribeck friction",
                     {"friction.stribeck_asymmetry", "friction.stribeck_Nm", "friction.stribeck_rad_s"},
                     "Armstrong-Helouvry 1991", grid({{0.8, -0.8}, {0.1}, {0.1}})),
                 law("viscous_too", "of viscous friction that the simulation lacks",
                     {"friction.viscous_asymmetry", "friction.viscous_Nm_s_per_rad"},
                     "Canudas de Wit, Astrom, Braun 1987",
                     where(has_no_viscous_friction, grid({{0.8, -0.8}, {0.05, 0.2}}, {by_itself, usual_damping})))},
       .shows = "one direction misses more than the other, in proportion to the friction",
       .needs = "motion in both directions",
       .workshop = {"friction that is stronger in one direction",
                    "Switch the motor off and turn the joint both ways: is one way harder? Look for a tilted bearing, "
                    "a seal that rubs, or worn teeth.",
                    "It comes nearer to its target from one side than from the other."},
       .shapes = {"friction.stribeck_rad_s"},
       .strength = of_coulomb,
       .demonstration = {.command = shown::triangle,
                         .both = {{"friction.coulomb_Nm", 0.6}, {"friction.viscous_Nm_s_per_rad", 0.2}}}},
      {.name = "offset",
       .title = "constant torque (asymmetry)",
       .forms = {law("constant", "always the same", {"ripple.offset_Nm"}, "Craig 2005", each({-0.2, -0.05, 0.05, 0.2})),
                 called({.what = "a constant push of the drive while it is on",
                         .check = "Let the drive find the zero of its current sensor again."},
                        law("drive", "of the drive, while it is on", {"drive.offset_Nm"}, "Chung, Sul 1998",
                            where(switches_off, each({-0.2, 0.2})))),
                 called({.what = "something that pulls like a spring",
                         .check = "Switch the motor off and turn the joint by hand through all of its range: does "
                                  "something pull it back? Look for a cable, a hose or a spring.",
                         .cost = "It rests beside its target, more so at some places than at others."},
                        law("spring", "of a spring with preload", {"ripple.offset_Nm", "ripple.spring_Nm_per_rad"},
                            "Wahl 1963", grid({{-0.2, 0.2}, {0.1}})))},
       .shows = "pushed to one side by the same torque always, at rest too",
       .needs = "two gains, and motion in both directions",
       .workshop = {"a constant torque to one side",
                    "Let the joint go where gravity doesn't turn it: does something push it? Look for a cable, a hose "
                    "or a spring that pulls. If nothing pushes while the drive is off, let the drive find the zero of "
                    "its current sensor again.",
                    "It rests beside its target, always on the same side."},
       .strength = opposite},
  };
}

}  // namespace pmg::effects
