// Forms of what warmth and time do, and what is off the catalogue.
#include "forms.hpp"

namespace pmg::literature {

namespace {

constexpr RigNeeds kWarm{.warm = true};
constexpr RigNeeds kWarmDrive{.laws = kPd | kServoLaw | kCascadeLaw, .weight = true, .warm = true};
constexpr RigNeeds kWarmServo{.laws = kServoLaw, .warm = true};

/// Friction of some size is there for warmth to act on; the healthy joint has it too.
const std::vector<Form> kThermal = {
    {"thermal_drift", "all friction thins with temperature", "Simoni, Beschi, Legnani, Visioli 2015", kWarm,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.thermal.friction_per_K = -draw.uniform(0.012, 0.035);
       return {{"thermal.friction_per_K", kIs, m.thermal.friction_per_K}};
     }},
    {"thermal_drift",
     "only viscous friction thins",
     "Bittencourt, Gunnarsson 2012",
     {.laws = kPd | kCascadeLaw, .warm = true},
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       m.friction.viscous_Nm_s_per_rad += draw.spread(0.1, 0.25) * rig.scale_Nm() / 2.0;
       m.thermal.viscous_per_K = -draw.uniform(0.02, 0.05);
       return {{"thermal.viscous_per_K", kIs, m.thermal.viscous_per_K}};
     },
     {"viscous"}},
    {"thermal_drift", "magnets lose torque", "Hanselman 2006", kWarmDrive,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.thermal.torque_per_K = -draw.uniform(0.003, 0.007);
       return {{"thermal.torque_per_K", kIs, m.thermal.torque_per_K}};
     }},
    {"thermal_drift", "the winding's resistance grows", "Hughes, Drury 2013", kWarmServo,
     [](Draw&, const Rig&, Machine& m) -> Planted {
       m.thermal.resistance_per_K = 0.0039;  // copper
       return {{"thermal.resistance_per_K", kIs, m.thermal.resistance_per_K}};
     }},
};

const std::vector<Form> kSelfHeating = {
    {"self_heating", "friction falls with the winding's heat", "Simoni, Beschi, Legnani, Visioli 2015", kWeight,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       m.thermal.friction_per_Nm2_s = -draw.spread(0.2, 0.8) / (rig.scale_Nm() * rig.scale_Nm());
       return {{"thermal.friction_per_Nm2_s", kIs, m.thermal.friction_per_Nm2_s}};
     }},
    {"self_heating", "friction falls with its own heat", "Bittencourt, Gunnarsson 2012", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       m.thermal.friction_per_J = -draw.spread(0.8, 3.0) / rig.scale_Nm();
       return {{"thermal.friction_per_J", kIs, m.thermal.friction_per_J}};
     }},
    {"self_heating", "torque falls with the winding's heat", "Urata, Hirose, Namiki, Nakanishi, Mizuuchi, Inaba 2008",
     kWeight,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       m.thermal.torque_per_Nm2_s = draw.spread(0.04, 0.15) / (rig.scale_Nm() * rig.scale_Nm());
       m.thermal.cooling_s = draw.uniform(10.0, 60.0);
       return {{"thermal.torque_per_Nm2_s", kIs, -m.thermal.torque_per_Nm2_s}};
     }},
    {"self_heating", "torque falls with time", "Urata, Hirose, Namiki, Nakanishi, Mizuuchi, Inaba 2008", kWeight,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.thermal.fade_share = draw.uniform(0.12, 0.35);
       m.thermal.fade_s = draw.uniform(0.8, 3.0);
       return {{"thermal.torque_fade_share", kIs, m.thermal.fade_share},
               {"thermal.torque_fade_s", kIs, m.thermal.fade_s}};
     }},
};

}  // namespace

std::vector<Form> heat_forms() {
  std::vector<Form> all = kThermal;
  all.insert(all.end(), kSelfHeating.begin(), kSelfHeating.end());
  return all;
}

std::vector<Form> strange_forms() {
  static const std::vector<Form> kStrange = {
      {"lugre", "bristles that show", "Canudas de Wit, Olsson, Astrom, Lischinsky 1995", kAny,
       [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
         m.friction.dry = DryForm::kLuGre;
         m.friction.coulomb_Nm += draw.uniform(0.1, 0.3) * rig.scale_Nm();
         m.friction.bristle_rad = draw.spread(0.04, 0.2);
         m.friction.bristle_damping_s = draw.spread(0.005, 0.05);
         return {};
       }},
      {"dahl", "bristles that show", "Dahl 1968", kAny,
       [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
         m.friction.dry = DryForm::kDahl;
         m.friction.coulomb_Nm += draw.uniform(0.1, 0.3) * rig.scale_Nm();
         m.friction.bristle_rad = draw.spread(0.05, 0.3);
         return {};
       }},
      {"compliance", "belt with hysteresis", "Bouc 1967; Wen 1976", kAny,
       [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
         m.transmission.stiffness_Nm_per_rad = rig.scale_Nm() / draw.spread(0.03, 0.08);
         m.transmission.damping_Nm_s_per_rad = 0.01 * m.transmission.stiffness_Nm_per_rad;
         m.transmission.belt_share = draw.uniform(0.4, 0.7);
         m.transmission.belt_width_rad = draw.uniform(0.01, 0.03);
         return {{"transmission.stiffness_Nm_per_rad", kIs, m.transmission.stiffness_Nm_per_rad},
                 {"transmission.hysteretic_share", kIs, m.transmission.belt_share},
                 {"transmission.hysteresis_rad", kIs, m.transmission.belt_width_rad}};
       }},
      {"loose_screw", "a mass that creeps outwards", "Junker 1969", kWeight,
       [](Draw& draw, const Rig&, Machine& m) -> Planted {
         m.screw.most_share = draw.uniform(0.25, 0.6);
         m.screw.holds_m_s2 = 9.81 * draw.uniform(1.01, 1.1);
         m.screw.creep_s = draw.spread(0.05, 0.3);
         return {};
       }},
      {"latch", "a magnet at one angle", "Yonnet 1981", kAny,
       [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
         m.ripple.latch_Nm = draw.sign() * draw.spread(0.3, 1.0) * rig.scale_Nm();
         m.ripple.latch_at_rad = draw.sign() * draw.uniform(0.2, 0.6);
         m.ripple.latch_width_rad = draw.uniform(0.08, 0.25);
         return {};
       }},
      {"detent", "a magnetic detent of a broken order", "Bianchi, Bolognani 2002", kAny,
       [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
         m.ripple.cogging_Nm = draw.spread(0.15, 0.5) * rig.scale_Nm();
         m.ripple.cogging_order = draw.uniform(1.3, 2.7);
         m.ripple.second_share = draw.uniform(0.5, 1.0);
         m.ripple.cogging_phase_rad = draw.uniform(-3.0, 3.0);
         return {};
       }},
      {"cable_rub", "a cable that rubs beyond an angle", "Armstrong-Helouvry 1991", kAny,
       [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
         m.friction.rub_Nm_per_rad = draw.spread(0.4, 2.0) * rig.scale_Nm();
         m.friction.rub_from_rad = draw.uniform(-0.2, 0.4);
         return {};
       }},
      {"integral", "an integral term with anti-windup", "Astrom, Hagglund 1995", kOwnDrive,
       [](Draw& draw, const Rig&, Machine& m) -> Planted {
         m.drive.integral_per_s = draw.spread(0.8, 4.0);
         return {};
       }},
      {"lost_commands", "while somebody else has the bus", "Davis, Burns, Bril, Lukkien 2007", kOwnDrive,
       [](Draw& draw, const Rig&, Machine& m) -> Planted {
         m.command.loss_period_s = draw.uniform(0.25, 0.6);
         m.command.loss = draw.uniform(0.2, 0.5);
         return {};
       }},
      {kFrozenReadings, "while somebody else has the bus", "Davis, Burns, Bril, Lukkien 2007", kAny,
       [](Draw& draw, const Rig&, Machine& m) -> Planted {
         m.sensor.loss_period_s = draw.uniform(0.25, 0.6);
         m.sensor.loss = draw.uniform(0.1, 0.35);
         return {};
       }},
      {"dwell", "sticks harder the longer it rests", "Rabinowicz 1958", kAny,
       [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
         m.friction.dwell_Nm = draw.spread(0.8, 2.5) * rig.scale_Nm();
         m.friction.dwell_s = draw.uniform(0.1, 0.5);
         return {};
       }},
  };
  return kStrange;
}

}  // namespace pmg::literature
