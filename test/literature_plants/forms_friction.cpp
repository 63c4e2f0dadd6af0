// Forms of friction. Strengths are shares of what the load weighs.
#include "forms.hpp"

namespace pmg::literature {

namespace {

constexpr RigNeeds kLoads{.weight = true, .two_loads = true};

double torque_Nm(Draw& draw, const Rig& rig, double low, double high) {
  return draw.spread(low, high) * rig.scale_Nm();
}

/// A level that a healthy joint with sharp or bristly friction of the same size wouldn't have.
double more_coulomb_Nm(Draw& draw, const Rig& rig, Machine& m) {
  const double more_Nm = torque_Nm(draw, rig, 0.08, 0.4);
  m.friction.coulomb_Nm += more_Nm;
  return more_Nm;
}

Planted stribeck(Draw& draw, const Rig& rig, Machine& m, double exponent) {
  const double more_Nm = torque_Nm(draw, rig, 0.1, 0.4);
  m.friction.stribeck_Nm += more_Nm;
  m.friction.stribeck_rad_s = draw.spread(0.15, 0.7);
  m.friction.stribeck_exponent = exponent;
  return {{"friction.stribeck_Nm", kAdds, more_Nm}, {"friction.stribeck_rad_s", kIs, m.friction.stribeck_rad_s}};
}

Planted load_friction(Draw& draw, Machine& m, LoadForm form) {
  m.friction.load_form = form;
  m.friction.load_driving = m.friction.load_backdriving = draw.uniform(0.12, 0.4);
  return {{"friction.load_driving", kIs, m.friction.load_driving},
          {"friction.load_backdriving", kIs, m.friction.load_driving}};
}

const std::vector<Form> kCoulomb = {
    {"coulomb", "holds or slides", "Coulomb 1785", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       return {{"friction.coulomb_Nm", kAdds, more_coulomb_Nm(draw, rig, m)}};
     }},
    {"coulomb",
     "hyperbolic tangent of speed",
     "Andersson, Soderberg, Bjorklund 2007",
     kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       more_coulomb_Nm(draw, rig, m);
       m.friction.dry = DryForm::kTanh;
       m.friction.smoothing_rad_s = draw.spread(0.03, 0.15);
       return {};
     },
     {"stribeck", "viscous"}},
    {"coulomb", "short bristle", "Dahl 1968", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       const double more_Nm = more_coulomb_Nm(draw, rig, m);
       m.friction.dry = DryForm::kDahl;
       m.friction.bristle_rad = draw.spread(0.003, 0.01);
       return {{"friction.coulomb_Nm", kAdds, more_Nm}};
     }},
    {"coulomb", "differs from run to run", "Armstrong-Helouvry 1991", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       more_coulomb_Nm(draw, rig, m);
       m.friction.coulomb_spread = draw.uniform(0.05, 0.12);
       return {};
     }},
};

const std::vector<Form> kViscous = {
    {"viscous", "linear", "Stokes 1851", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       const double more = torque_Nm(draw, rig, 0.08, 0.5) / 2.0;  // that torque at 2 rad/s
       m.friction.viscous_Nm_s_per_rad += more;
       return {{"friction.viscous_Nm_s_per_rad", kAdds, more}};
     }},
    {"viscous", "square of speed: churning oil", "Changenet, Oviedo-Marlot, Velex 2006", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       m.friction.power_Nm = torque_Nm(draw, rig, 0.1, 0.5) / 4.0;
       m.friction.power_exponent = 2.0;
       return {{"friction.viscous_quadratic_Nm_s2_per_rad2", kIs, m.friction.power_Nm}};
     }},
    {"viscous",
     "power below 1: grease",
     "Waiboer, Aarts, Jonker 2005",
     kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       m.friction.power_Nm = torque_Nm(draw, rig, 0.06, 0.3);
       m.friction.power_exponent = draw.uniform(0.5, 0.7);
       return {};
     },
     {"coulomb", "stribeck"}},
};

const std::vector<Form> kStribeck = {
    {"stribeck", "exponent 2", "Armstrong-Helouvry 1991", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) { return stribeck(draw, rig, m, 2.0); }},
    {"stribeck", "exponent 1", "Tustin 1947", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) { return stribeck(draw, rig, m, 1.0); }},
    {"stribeck",
     "exponent 0.5",
     "Bo, Pavelescu 1982",
     kAny,
     [](Draw& draw, const Rig& rig, Machine& m) { return stribeck(draw, rig, m, 0.5); },
     {"coulomb", "viscous"}},
    {"stribeck", "Lorentz's curve", "Hess, Soom 1990", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       stribeck(draw, rig, m, 2.0);
       m.friction.stribeck_lorentz = true;
       return {};
     }},
};

const std::vector<Form> kLoadFriction = {
    {"load_friction", "net torque", "Duclusaud, Passault, Padois, Ly 2025", kLoads,
     [](Draw& draw, const Rig&, Machine& m) { return load_friction(draw, m, LoadForm::kNet); }},
    {"load_friction", "motor torque", "Duclusaud, Passault, Padois, Ly 2025", kLoads,
     [](Draw& draw, const Rig&, Machine& m) { return load_friction(draw, m, LoadForm::kMotor); }},
    {"load_friction", "transmitted torque", "Dohring, Lee, Newman 1993; Hamon, Gautier, Garrec 2010", kLoads,
     [](Draw& draw, const Rig&, Machine& m) { return load_friction(draw, m, LoadForm::kTransmitted); }},
    {"load_friction", "direction of power flow", "Verstraten et al. 2015", kLoads,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       load_friction(draw, m, LoadForm::kPowerFlow);
       const double efficiency = draw.uniform(0.6, 0.88), back = draw.uniform(0.3, 0.9);
       m.friction.load_driving = 1.0 / efficiency - 1.0;
       m.friction.load_backdriving = back * m.friction.load_driving;
       return {{"friction.load_driving", kIs, m.friction.load_driving},
               {"friction.load_backdriving", kIs, m.friction.load_backdriving}};
     }},
};

const std::vector<Form> kDirection = {
    {"direction_friction", "dry", "Armstrong-Helouvry, Dupont, Canudas de Wit 1994", kAny,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.friction.asymmetry = draw.sign() * draw.uniform(0.3, 0.7);
       return {{"friction.asymmetry", kIs, m.friction.asymmetry}};
     }},
    {"direction_friction",
     "viscous",
     "Canudas de Wit, Astrom, Braun 1987",
     kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       m.friction.viscous_Nm_s_per_rad += torque_Nm(draw, rig, 0.05, 0.15) / 2.0;
       m.friction.viscous_asymmetry = draw.sign() * draw.uniform(0.5, 0.9);
       return {{"friction.viscous_asymmetry", kIs, m.friction.viscous_asymmetry}};
     },
     {"viscous"}},
    {"direction_friction",
     "Stribeck",
     "Armstrong-Helouvry 1991",
     kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       m.friction.stribeck_Nm += torque_Nm(draw, rig, 0.05, 0.15);
       m.friction.stribeck_rad_s = draw.spread(0.2, 0.6);
       m.friction.stribeck_asymmetry = draw.sign() * draw.uniform(0.6, 1.0);
       return {{"friction.stribeck_asymmetry", kIs, m.friction.stribeck_asymmetry}};
     },
     {"stribeck"}},
};

}  // namespace

std::vector<Form> friction_forms() {
  std::vector<Form> all;
  for (const auto* forms : {&kCoulomb, &kViscous, &kStribeck, &kLoadFriction, &kDirection}) {
    all.insert(all.end(), forms->begin(), forms->end());
  }
  return all;
}

}  // namespace pmg::literature
