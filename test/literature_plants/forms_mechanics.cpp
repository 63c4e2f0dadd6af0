// Forms of shaft, ripple, constant torque and load.
#include <cmath>

#include "forms.hpp"

namespace pmg::literature {

namespace {

/// Damping by which the rotor rings against a held load with this damping ratio.
void damp(Machine& m, double ratio) {
  m.transmission.damping_Nm_s_per_rad =
      2.0 * ratio * std::sqrt(m.transmission.stiffness_Nm_per_rad * m.body.rotor_inertia_kg_m2);
}

PlantedParameter play(Draw& draw, const Rig& rig, Machine& m) {
  m.transmission.backlash_rad = draw.spread(0.015, 0.07);
  m.transmission.stiffness_Nm_per_rad = rig.scale_Nm() / draw.spread(0.003, 0.006);  // teeth hardly bend
  damp(m, draw.uniform(0.1, 0.3));
  return {"transmission.backlash_rad", kIs, m.transmission.backlash_rad};
}

PlantedParameter spring(Draw& draw, const Rig& rig, Machine& m) {
  m.transmission.stiffness_Nm_per_rad = rig.scale_Nm() / draw.spread(0.02, 0.08);
  damp(m, draw.uniform(0.03, 0.12));
  return {"transmission.stiffness_Nm_per_rad", kIs, m.transmission.stiffness_Nm_per_rad};
}

void cogging(Draw& draw, const Rig& rig, Machine& m) {
  m.ripple.cogging_Nm = draw.spread(0.06, 0.35) * rig.scale_Nm();
  m.ripple.cogging_order = std::round(draw.uniform(4.0, 20.0));
  m.ripple.cogging_phase_rad = draw.uniform(-3.0, 3.0);
}

const std::vector<Form> kOffset = {
    {"offset", "constant", "Craig 2005", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       m.ripple.offset_Nm = draw.sign() * draw.spread(0.05, 0.3) * rig.scale_Nm();
       return {{"ripple.offset_Nm", kIs, m.ripple.offset_Nm}};
     }},
    {"offset", "spring with preload", "Wahl 1963", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       m.ripple.offset_Nm = draw.sign() * draw.spread(0.06, 0.3) * rig.scale_Nm();
       m.ripple.preload_Nm_per_rad = std::abs(m.ripple.offset_Nm) / draw.uniform(2.5, 5.0);
       return {{"ripple.offset_Nm", kIs, m.ripple.offset_Nm},
               {"ripple.spring_Nm_per_rad", kIs, m.ripple.preload_Nm_per_rad}};
     }},
    {"offset", "of the current sensor: only while the drive is on", "Chung, Sul 1998", kOwnDrive,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       m.drive.offset_when_on_Nm = draw.sign() * draw.spread(0.05, 0.3) * rig.scale_Nm();
       return {{"drive.offset_Nm", kIs, m.drive.offset_when_on_Nm}};
     }},
};

const std::vector<Form> kBacklash = {
    {"backlash", "damped flanks", "Nordin, Galic, Gutman 1997", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted { return {play(draw, rig, m)}; }},
    {"backlash", "flanks by Hunt and Crossley", "Hunt, Crossley 1975", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       const PlantedParameter width = play(draw, rig, m);
       m.transmission.contact = ContactForm::kHuntCrossley;
       return {width};
     }},
    {"backlash", "friction behind the play", "Nordin, Gutman 2002", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       const PlantedParameter width = play(draw, rig, m);
       m.friction.at_load = true;
       return {width};
     }},
    {"backlash",
     "soft spring in the gap",
     "Nordin, Gutman 2002",
     kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       play(draw, rig, m);
       m.transmission.contact = ContactForm::kSoftGap;
       m.transmission.gap_stiffness_Nm_per_rad = rig.scale_Nm() / draw.uniform(0.1, 0.3);
       return {};
     },
     {"compliance"}},
    {"backlash", "sensor before the gear", "Nordin, Gutman 2002", kOwnDrive,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       const PlantedParameter width = play(draw, rig, m);
       m.sensor.before_gear = true;
       return {width};
     }},
};

const std::vector<Form> kCompliance = {
    {"compliance", "spring behind the friction", "Spong 1987", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted { return {spring(draw, rig, m)}; }},
    {"compliance", "spring before the friction", "Albu-Schaffer, Ott, Hirzinger 2007", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       const PlantedParameter stiffness = spring(draw, rig, m);
       m.friction.at_load = true;
       return {stiffness};
     }},
    {"compliance", "hardening spring", "Tuttle, Seering 1996", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       spring(draw, rig, m);
       m.transmission.stiffness_Nm_per_rad *= 0.6;
       const double twist_rad = rig.scale_Nm() / m.transmission.stiffness_Nm_per_rad;
       m.transmission.hardening_Nm_per_rad3 =
           draw.uniform(1.0, 4.0) * m.transmission.stiffness_Nm_per_rad / (twist_rad * twist_rad);
       return {{"transmission.stiffness_Nm_per_rad", kIs, m.transmission.stiffness_Nm_per_rad},
               {"transmission.hardening_Nm_per_rad3", kIs, m.transmission.hardening_Nm_per_rad3}};
     }},
    {"compliance", "sensor before the gear", "Sweet, Good 1985", kOwnDrive,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       const PlantedParameter stiffness = spring(draw, rig, m);
       m.sensor.before_gear = true;
       return {stiffness};
     }},
};

const std::vector<Form> kCogging = {
    {"cogging", "one sine", "Jahns, Soong 1996", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       cogging(draw, rig, m);
       return {{"ripple.amplitude_Nm", kIs, m.ripple.cogging_Nm}, {"ripple.order", kIs, m.ripple.cogging_order}};
     }},
    {"cogging", "two harmonics", "Zhu, Howe 2000", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       cogging(draw, rig, m);
       m.ripple.cogging_Nm *= 0.8;
       m.ripple.second_share = draw.uniform(0.4, 0.9);
       return {{"ripple.amplitude_Nm", kIs, m.ripple.cogging_Nm},
               {"ripple.order", kIs, m.ripple.cogging_order},
               {"ripple.second_Nm", kIs, m.ripple.second_share * m.ripple.cogging_Nm}};
     }},
    {"cogging", "in proportion to the current", "Holtz, Springob 1996", kWeight,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       cogging(draw, rig, m);
       m.ripple.cogging_Nm = 0.0;
       m.ripple.current_share = draw.uniform(0.15, 0.45);
       return {{"ripple.torque_share", kIs, m.ripple.current_share}, {"ripple.order", kIs, m.ripple.cogging_order}};
     }},
};

const std::vector<Form> kLoad = {
    {"load", "another mass", "Atkeson, An, Hollerbach 1986", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       const double factor = draw.chance(0.7) ? 1.0 + draw.spread(0.1, 0.4) : 1.0 - draw.spread(0.1, 0.25);
       m.body.inertia_factor = m.body.gravity_factor = factor;
       Planted planted = {{"load.inertia_scale", kScales, factor}};
       if (!rig.horizontal) planted.push_back({"load.gravity_scale", kScales, factor});
       return planted;
     }},
    {"load", "mass elsewhere", "Atkeson, An, Hollerbach 1986", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       const double factor = draw.chance(0.7) ? 1.0 + draw.spread(0.06, 0.25) : 1.0 - draw.spread(0.06, 0.18);
       m.body.inertia_factor = factor * factor;
       m.body.gravity_factor = factor;
       Planted planted = {{"load.inertia_scale", kScales, factor * factor}};
       if (!rig.horizontal) planted.push_back({"load.gravity_scale", kScales, factor});
       return planted;
     }},
    {"load", "a balanced pulley that nobody weighed", "Armstrong, Khatib, Burdick 1986", kAny,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       m.body.more_inertia_kg_m2 = draw.spread(0.2, 0.8) * rig.loads.front().inertia_kg_m2;
       return {};
     }},
    {"load", "an arm that nobody weighed", "Armstrong, Khatib, Burdick 1986", kWeight,
     [](Draw& draw, const Rig& rig, Machine& m) -> Planted {
       const Load& load = rig.loads.front();
       const double arm_kg = draw.spread(0.15, 0.6) * load.mass_kg;
       m.body.more_inertia_kg_m2 = arm_kg * load.length_m * load.length_m / 3.0;
       m.body.more_gravity_Nm = arm_kg * 9.81 * load.length_m / 2.0;
       return {};
     }},
};

}  // namespace

std::vector<Form> mechanics_forms() {
  std::vector<Form> all;
  for (const auto* forms : {&kOffset, &kBacklash, &kCompliance, &kCogging, &kLoad}) {
    all.insert(all.end(), forms->begin(), forms->end());
  }
  return all;
}

}  // namespace pmg::literature
