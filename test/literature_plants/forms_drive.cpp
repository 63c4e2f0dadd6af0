// Forms of what a drive does to its command and its output.
#include <cmath>

#include "forms.hpp"

namespace pmg::literature {

namespace {

constexpr RigNeeds kServo{.laws = kServoLaw};
constexpr RigNeeds kHoldable{.laws = kPd | kServoLaw};  // a cascade holds already

double band_rad(Draw& draw) { return draw.spread(0.02, 0.08); }

/// What a drive that looks at the clock once in a tick makes of a period.
double whole_ticks_s(double period_s, const Machine& m) {
  return std::ceil(period_s * m.drive.loop_hz - 1e-6) / m.drive.loop_hz;
}

double factor(Draw& draw) { return std::pow(draw.spread(1.12, 1.6), draw.sign()); }

const std::vector<Form> kDelay = {
    {"delay", "of commands", "Smith 1957", kAny,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       const double more_s = draw.spread(0.006, 0.03);
       m.command.delay_s += more_s;
       return {{"command.delay_s", kAdds, more_s}};
     }},
    {"delay", "of readings", "Nilsson 1998", kOwnDrive,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.sensor.delay_s = draw.spread(0.004, 0.016);
       return {{"sensor.delay_s", kIs, m.sensor.delay_s}};
     }},
    {"delay", "of both: the loop's computation", "Astrom, Wittenmark 1997", kOwnDrive,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.drive.torque_delay_s = draw.spread(0.004, 0.016);
       return {{"drive.torque_delay_s", kIs, m.drive.torque_delay_s}};
     }},
    {"delay", "of commands, another for each", "Nilsson 1998", kAny,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       const double more_s = draw.spread(0.01, 0.03);
       m.command.delay_s += more_s;
       m.command.delay_jitter = draw.uniform(0.3, 0.8);
       return {{"command.delay_s", kAdds, more_s}};
     }},
};

const std::vector<Form> kRateLimit = {
    {"rate_limit", "of the command", "Duda 1997", kOwnDrive,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.command.rate_limit_rad_s = draw.spread(1.2, 5.0);
       return {{"command.rate_limit_rad_s", kIs, m.command.rate_limit_rad_s}};
     }},
    {"rate_limit", "a profile that accelerates and brakes", "Biagiotti, Melchiorri 2008", kOwnDrive,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.command.rate_limit_rad_s = draw.spread(1.5, 5.0);
       m.command.acceleration_rad_s2 = m.command.rate_limit_rad_s * draw.uniform(5.0, 15.0);
       return {{"command.rate_limit_rad_s", kIs, m.command.rate_limit_rad_s},
               {"command.acceleration_limit_rad_s2", kIs, m.command.acceleration_rad_s2}};
     }},
    {"rate_limit", "of the output", "Klyde, McRuer, Myers 1997", kOwnDrive,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       const double one = m.drive.law == Law::kPositionPd ? rig.scale_Nm() : m.drive.law == Law::kServo ? 1.0 : 10.0;
       m.drive.output_rate_per_s = draw.spread(8.0, 40.0) * one;
       return {{"drive.output_rate_limit_per_s", kIs, m.drive.output_rate_per_s}};
     }},
};

const std::vector<Form> kHold = {
    {"hold", "of the drive's output", "Astrom, Wittenmark 1997", kHoldable,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.drive.hold_s = draw.spread(0.008, 0.025);
       return {{"command.hold_s", kIs, whole_ticks_s(m.drive.hold_s, m)}};
     }},
    {"hold", "of commands", "Franklin, Powell, Workman 1998", kOwnDrive,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.command.hold_s = draw.spread(0.03, 0.1);
       return {{"command.update_s", kIs, whole_ticks_s(m.command.hold_s, m)}};
     }},
    {"hold", "of readings", "Franklin, Powell, Workman 1998", kHoldable,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.sensor.hold_s = draw.spread(0.008, 0.025);
       return {{"sensor.hold_s", kIs, whole_ticks_s(m.sensor.hold_s, m)}};
     }},
};

const std::vector<Form> kTorqueSpeed = {
    {"torque_speed", "a line to the speed without load", "Hughes, Drury 2013", kCurrent,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       m.drive.stall_torque_Nm = draw.spread(1.3, 2.5) * rig.loads.back().gravity_Nm;
       m.drive.no_load_rad_s = draw.spread(3.0, 8.0);
       return {{"drive.stall_torque_Nm", kIs, m.drive.stall_torque_Nm},
               {"drive.no_load_rad_s", kIs, m.drive.no_load_rad_s}};
     }},
    {"torque_speed", "constant power: field weakening", "Krishnan 2001", kCurrent,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       m.drive.speed_form = SpeedForm::kPower;
       m.drive.power_W = draw.spread(1.0, 4.0) * rig.scale_Nm();
       return {{"drive.most_power_W", kIs, m.drive.power_W}};
     }},
    {"torque_speed", "a guard against overspeed", "Leonhard 2001", kCurrent,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.drive.speed_form = SpeedForm::kCut;
       m.drive.stall_torque_Nm = m.drive.limit;
       m.drive.no_load_rad_s = draw.spread(2.0, 4.5);
       return {{"drive.cut_speed_rad_s", kIs, m.drive.no_load_rad_s}};
     }},
};

const std::vector<Form> kSag = {
    {"supply_sag", "resistance of the source", "Horowitz, Hill 2015", kServo,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       m.drive.sag_per_Nm = draw.spread(0.1, 0.4) / rig.scale_Nm();
       return {{"drive.supply_sag_per_Nm", kIs, m.drive.sag_per_Nm}};
     }},
    {"supply_sag", "a battery with a capacitance", "Chen, Rincon-Mora 2006", kServo,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       m.drive.sag_per_Nm = draw.spread(0.1, 0.4) / rig.scale_Nm();
       m.drive.sag_form = SagForm::kBattery;
       m.drive.sag_time_s = draw.uniform(0.2, 1.0);
       return {{"drive.supply_sag_per_Nm", kIs, m.drive.sag_per_Nm},
               {"drive.supply_sag_time_s", kIs, m.drive.sag_time_s}};
     }},
    {"supply_sag", "a supply with a current limit", "Horowitz, Hill 2015", kServo,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       m.drive.sag_form = SagForm::kLimit;
       m.drive.sag_limit_Nm = draw.spread(0.25, 1.0) * rig.scale_Nm();
       return {{"drive.supply_limit_Nm", kIs, m.drive.sag_limit_Nm}};
     }},
};

const std::vector<Form> kGains = {
    {"gain", "of the position loop", "Ljung 1999", kOwnDrive,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       const double by = factor(draw);
       m.drive.kp_factor *= by;
       return {{"drive.kp_scale", kScales, by}};
     }},
    {"gain",
     "of all torque",
     "Gautier, Briot 2014",
     {.laws = kPd | kCascadeLaw, .weight = true},
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.drive.torque_factor = factor(draw);
       return {{"drive.torque_scale", kIs, m.drive.torque_factor}};
     }},
    {"gain",
     "falls with torque: a saturated core",
     "Hanselman 2006",
     {.laws = kPd, .weight = true},
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       m.drive.saturation_per_Nm = draw.spread(0.1, 0.4) / rig.scale_Nm();
       return {{"drive.saturation_per_Nm", kIs, m.drive.saturation_per_Nm}};
     }},
};

const std::vector<Form> kDeadBand = {
    {"dead_band", "jumps", "Gelb, Vander Velde 1968", kOwnDrive,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.drive.dead_band_rad = band_rad(draw);
       return {{"drive.dead_band_rad", kIs, m.drive.dead_band_rad}};
     }},
    {"dead_band", "subtracts", "Tao, Kokotovic 1994", kOwnDrive,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.drive.dead_form = DeadBandForm::kSubtract;
       m.drive.dead_band_rad = band_rad(draw);
       return {{"drive.dead_band_rad", kIs, m.drive.dead_band_rad}};
     }},
    {"dead_band", "of the output: dead time of a bridge", "Leggate, Kerkman 1997", kOwnDrive,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       m.drive.dead_form = DeadBandForm::kOutput;
       const double one = rig.scale_Nm() / m.drive.torque_per_unit / (m.drive.law == Law::kServo ? rig.bus_V : 1.0);
       m.drive.dead_output = draw.spread(0.12, 0.5) * one;
       return {{"drive.output_dead_band", kIs, m.drive.dead_output}};
     }},
    {"dead_band", "wakes up later than it falls asleep", "Gelb, Vander Velde 1968", kOwnDrive,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.drive.dead_form = DeadBandForm::kHysteresis;
       m.drive.dead_band_rad = draw.spread(0.015, 0.05);
       return {{"drive.dead_band_rad", kIs, m.drive.dead_band_rad},
               {"drive.dead_band_wake_rad", kIs, m.drive.dead_band_rad}};
     }},
};

}  // namespace

std::vector<Form> drive_forms() {
  std::vector<Form> all;
  for (const auto* forms : {&kDelay, &kRateLimit, &kHold, &kTorqueSpeed, &kSag, &kGains, &kDeadBand}) {
    all.insert(all.end(), forms->begin(), forms->end());
  }
  return all;
}

}  // namespace pmg::literature
