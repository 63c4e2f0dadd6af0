// What changes as a joint works, and what it carries.
#include "calib/unknown.hpp"
#include "effects/families.hpp"

namespace pmg::effects {

namespace {

bool knows_temperature(const StartsFrom& from) { return from.scale.temperature_recorded; }

bool warms_its_winding(const StartsFrom& from) {
  return knows_temperature(from) && from.scale.law == bench::DriveLaw::kServoVoltage;
}

double of_a_run(const StartsFrom& from) { return from.scale.duration_s; }

bool several_loads(const StartsFrom& from) { return from.scale.several_loads; }
double usual_inertia(const StartsFrom& from) { return from.scale.inertia_kg_m2; }
double usual_torque(const StartsFrom& from) { return from.scale.torque_Nm; }

Values winding_heats(const StartsFrom& from) {
  const double torque = from.scale.torque_Nm, duration = from.scale.duration_s;
  Values found;
  for (const double share : {-0.1, -0.4}) {
    found.push_back({share * (1.0 / (torque * torque * duration)), 10.0 * duration});
  }
  return found;
}

WorkshopWords friction_changes() { return {.what = "friction that changes as the joint works"}; }
WorkshopWords torque_changes() {
  return {.what = "torque that changes as the joint works",
          .check =
              "Let the joint hold a weight for a long time: does it need more and more current? Check the cooling "
              "of the motor, and limits in its drive."};
}

}  // namespace

std::vector<Effect> warmth_and_load_effects() {
  return {
      {.name = "thermal_drift",
       .title = "thermal drift",
       .forms = {law("friction_and_torque", "of all friction, or of torque",
                     {"thermal.friction_per_K", "thermal.torque_per_K"},
                     "Simoni, Beschi, Legnani, Visioli 2015; Hanselman 2006",
                     where(knows_temperature, these({{-0.02, 0.0}, {0.02, 0.0}, {0.0, -0.01}, {0.0, 0.01}}))),
                 called({.what = "friction in motion that changes with temperature",
                         .check = "Record it cold and warm and compare. Check the grease."},
                        law("viscous", "of viscous friction", {"thermal.viscous_per_K"}, "Bittencourt, Gunnarsson 2012",
                            where(knows_temperature, each({-0.03, 0.02})))),
                 called({.what = "a motor whose strength changes with its temperature",
                         .check = "Record it cold and warm and compare. Check cooling and temperature of the motor."},
                        law("resistance", "of the winding's resistance", {"thermal.resistance_per_K"},
                            "Hughes, Drury 2013", where(warms_its_winding, each({0.004}))))},
       .shows = "runs of the same design differ with temperature",
       .needs = "a temperature column, and runs from cold to warm",
       .workshop = {"a joint that changes with its temperature",
                    "Record it cold and warm and compare. Check grease, cooling and the temperature of the motor.",
                    "Warm, the robot moves otherwise than when it was measured."},
       .demonstration = {.command = shown::sine, .both = {{"friction.coulomb_Nm", 0.3}}}},
      {.name = "self_heating",
       .title = "self-heating",
       .forms = {called(friction_changes(),
                        law("friction_winding", "of friction, by the winding's heat", {"thermal.friction_per_Nm2_s"},
                            "Simoni, Beschi, Legnani, Visioli 2015", each({-0.2, 0.2, -2.0}))),
                 called(friction_changes(),
                        law("friction_own", "of friction, by its own heat", {"thermal.friction_per_J"},
                            "Bittencourt, Gunnarsson 2012", each({-0.3, 0.3, -3.0}))),
                 called(torque_changes(),
                        law("torque_winding", "of torque, by the winding's heat",
                            {"thermal.torque_per_Nm2_s", "thermal.cooling_s"}, "Urata et al. 2008", winding_heats)),
                 called(torque_changes(),
                        law("torque_time", "of torque, by time", {"thermal.torque_fade_share", "thermal.torque_fade_s"},
                            "Urata et al. 2008", grid({{0.15}, {0.15, 0.5}}, {by_itself, of_a_run})))},
       .shows = "friction or torque changes along a run, the more the harder it works",
       .needs = "long runs of hard work",
       .workshop = {"friction or torque that changes as the joint works",
                    "Let the joint work hard for a long time, then turn it by hand and compare with before. Check "
                    "grease and cooling.",
                    "After hard work it moves otherwise than before."},
       .demonstration = {.command = shown::sine, .both = {{"friction.coulomb_Nm", 0.3}}}},
      {.name = "load",
       .title = "mass, centre of mass or inertia",
       .forms = {law("scales", "in proportion to what is written", {"load.inertia_scale", "load.gravity_scale"},
                     "Atkeson, An, Hollerbach 1986",
                     these({{0.8, 0.8}, {1.25, 1.25}, {1.2, 1.0}, {0.8, 1.0}, {1.0, 1.2}, {1.0, 0.8}})),
                 called({.what = "something that turns with the joint and that nobody weighed",
                         .check = "Weigh whatever turns with the joint: pulley, coupling, bracket, cables. Write it "
                                  "into the numbers of the bench."},
                        law("adds", "of something that turns with every load",
                            {calib::kMoreInertia, calib::kMoreGravity}, "Armstrong, Khatib, Burdick 1986",
                            where(several_loads, grid({{0.3}, {0.0, 0.2, -0.2}}, {usual_inertia, usual_torque}))))},
       .shows = "swings too slowly or too fast; sags more or less than the load says",
       .needs = "steps, and poses away from hanging",
       .workshop =
           {"a mass, or the place of a mass, that differs from what is written",
            "Weigh the arm and its load and measure where their centre is. Compare with the numbers of the bench.",
            "The robot computes its balance with a wrong weight: it leans, and swings this limb too far or not far "
            "enough."}},
  };
}

}  // namespace pmg::effects
