// What a drive makes of a command.
#include "effects/families.hpp"

namespace pmg::effects {

namespace {

bool regulates_current(const StartsFrom& from) { return from.scale.law != bench::DriveLaw::kServoVoltage; }

/// Only voltage drives, which have back-EMF, feel the bus; the others regulate their current. A recorded bus voltage is
/// an input that already contains the sag.
bool feels_bus(const StartsFrom& from) {
  return from.actuator.drive.back_emf_s_per_rad > 0.0 && !from.scale.bus_recorded;
}

double peak_torque(const StartsFrom& from) { return from.scale.torque_peak_Nm; }
double per_usual_torque(const StartsFrom& from) { return 1.0 / from.scale.torque_Nm; }
double usual_speed(const StartsFrom& from) { return from.scale.speed_rad_s; }
double position_gain(const StartsFrom& from) { return from.actuator.drive.kp_scale; }

/// Full voltage from 0.4 rad of error; 3.6 Nm at rest, none at 10 rad/s.
std::vector<FixedValue> hobby_servo() {
  return {{"drive.limit", 1.0},
          {"drive.kp_scale", 0.1},
          {"drive.kd_scale", 0.0},
          {"drive.torque_per_unit_Nm", 3.6},
          {"drive.back_emf_s_per_rad", 0.1}};
}

}  // namespace

std::vector<Effect> drive_effects() {
  return {
      {.name = "torque_speed",
       .title = "torque-speed limit",
       .forms = {law("line", "along a line to the no-load speed", {"drive.stall_torque_Nm", "drive.no_load_rad_s"},
                     "Hughes, Drury 2013", grid({{0.5, 1.0, 1.8}, {1.05, 1.4, 2.5}}, {peak_torque, usual_speed})),
                 called({.what = "a motor that has only so much power"},
                        law("power", "of constant power", {"drive.most_power_W"}, "Krishnan 2001",
                            where(regulates_current, each({0.15, 0.4, 0.8})))),
                 called({.what = "a motor that stops pushing above one speed",
                         .check = "Look into the settings of the drive for a limit of the speed."},
                        law("cut", "that cuts the torque at a speed", {"drive.cut_speed_rad_s"}, "Leonhard 2001",
                            where(regulates_current, each({0.9, 1.05, 1.2})))),
                 called({.what = "a limit of the torque, however slow the motion",
                         .check = "Look into the settings of the drive for a limit of current or torque. Check that "
                                  "the motor is of the right type.",
                         .cost = "Hard motion falls short: a step that should catch the robot may be too slow."},
                        law("torque", "of the torque at any speed", {"drive.stall_torque_Nm"}, "Leonhard 2001",
                            where(regulates_current, each({0.5, 0.8}, peak_torque))))},
       .shows = "fast motion lags however high the gain",
       .needs = "large steps",
       .workshop = {"too little torque in hard or fast motion",
                    "Measure the supply voltage while the joint moves fast. Check the current limit of the drive, and "
                    "that the motor is of the right type.",
                    "Fast motion under load falls short: a step that should catch the robot may be too slow."},
       .contains = {"viscous"},
       .demonstration = {.command = shown::big_step}},
      {.name = "supply_sag",
       .title = "bus sag",
       .forms = {law("resistance", "of a source with a resistance", {"drive.supply_sag_per_Nm"}, "Horowitz, Hill 2015",
                     where(feels_bus, each({0.05, 0.2, 0.5, 1.0, 2.0, 4.0}))),
                 law("battery", "of a battery that takes time",
                     {"drive.supply_sag_per_Nm", "drive.supply_sag_time_s", "drive.supply_sag_slow_share"},
                     "Chen, Rincon-Mora 2006", where(feels_bus, grid({{0.2, 0.6}, {0.2, 0.8}, {0.5}}))),
                 called({.what = "a supply that gives only so much current",
                         .check = "Check the current limit of the power supply, and measure the voltage at the drive "
                                  "while the joint works hard."},
                        law("limit", "of a supply with a current limit", {"drive.supply_limit_Nm"},
                            "Horowitz, Hill 2015", where(feels_bus, each({0.2, 0.4, 0.7}, peak_torque))))},
       .shows = "hard motion of a voltage servo is weaker than its gain says",
       .needs = "small and large steps",
       .workshop = {"a supply voltage that falls under load",
                    "Measure the voltage at the drive while the joint works hard. Check power supply, battery, cables "
                    "and plugs.",
                    "It is weakest when the robot needs it most."},
       .shapes = {"drive.supply_sag_slow_share"},
       .demonstration = {.command = shown::big_step, .both = hobby_servo()}},
      {.name = "gain",
       .title = "wrong gain or unit",
       .forms = {law("position", "of the position loop", {"drive.kp_scale"}, "Ljung 1999",
                     each({0.6, 0.8, 0.9, 1.1, 1.25, 1.6}, position_gain)),
                 called({.what = "a motor that makes more or less torque than its number says",
                         .check = "Hold a known weight and compare its torque with the one that the drive tells. Check "
                                  "the type of the motor, its torque per ampere and the gear ratio.",
                         .cost = "All torques of this joint are wrong by this share."},
                        law("torque", "of all torque", {"drive.torque_scale"}, "Gautier, Briot 2014",
                            each({0.7, 0.9, 1.1, 1.4}))),
                 called(
                     {.what = "a position reading that is too large or too small by a share",
                      .check = "Turn the joint by a known angle and compare it with the reading. Check how many counts "
                               "the encoder has per turn, and the gear ratio.",
                      .cost = "The limb isn't where the robot believes it to be, and the further it turns, the worse."},
                     law("reading", "of all readings", {"sensor.angle_scale"}, "Ellin, Dolsak 2008",
                         each({0.8, 0.93, 1.07, 1.2}))),
                 called({.what = "a motor whose torque grows less and less with its current",
                         .check = "Hold one weight after another, each heavier, and compare the currents: do they grow "
                                  "faster than the weights? Check that the motor is of the right type.",
                         .cost = "Where the robot needs most torque, it gets less than its controller expects."},
                        law("saturation", "that falls with torque", {"drive.saturation_per_Nm"}, "Hanselman 2006",
                            each({0.05, 0.2}, per_usual_torque)))},
       .shows = "all errors are too large, or too small, by a factor",
       .needs = "load, or steps",
       .workshop = {"a drive that is stronger or weaker than its number says",
                    "Compare the gains and their units in the drive with those of the simulation. Check gear ratio and "
                    "motor type.",
                    "The robot stands stiffer or softer than its controller expects."},
       .strength = itself},
      {.name = "dead_band",
       .title = "dead band",
       .forms = {law("jumps", "that jumps at its edge", {"drive.dead_band_rad"}, "Gelb, Vander Velde 1968",
                     each({0.003, 0.01, 0.03})),
                 law("subtracts", "that subtracts its width", {"drive.dead_band_rad"}, "Tao, Kokotovic 1994",
                     where(closes_loop, each({0.01, 0.03})), {{"drive.dead_band_subtracts", 1.0}}),
                 called({.what = "small outputs that the drive doesn't pass on"},
                        law("output", "of the drive's output", {"drive.output_dead_band"}, "Leggate, Kerkman 1997",
                            each({0.05, 0.2}))),
                 law("wakes_later", "that ends later than it begins",
                     {"drive.dead_band_rad", "drive.dead_band_wake_rad"}, "Gelb, Vander Velde 1968",
                     where(closes_loop, these({{0.01, 0.01}, {0.03, 0.03}})))},
       .shows = "errors below a threshold give no output",
       .needs = "two gains: the error at rest is the same",
       .workshop = {"small errors that the drive ignores",
                    "Look into the settings of the drive for a dead band or a smallest output.",
                    "It rests a little beside its target and drifts about it."},
       .strength = itself,
       .never_negative = true},
  };
}

}  // namespace pmg::effects
