// Forms of what a sensor does to an angle.
#include <cmath>
#include <numbers>

#include "forms.hpp"

namespace pmg::literature {

namespace {

Planted quantum(Draw& draw, Machine& m, QuantumForm form) {
  m.sensor.quantum_form = form;
  m.sensor.quantum_rad = 2.0 * std::numbers::pi / std::pow(2.0, 7.0 + static_cast<double>(draw.below(2)));
  return {{"sensor.quantum_rad", kIs, m.sensor.quantum_rad}};
}

void play(Draw& draw, Machine& m, SensorPlay form) {
  m.sensor.play_form = form;
  m.sensor.play_rad = draw.spread(0.015, 0.06);
}

void eccentricity(Draw& draw, Machine& m) {
  m.sensor.eccentricity_rad = draw.spread(0.02, 0.08);
  m.sensor.eccentricity_phase_rad = draw.uniform(-3.0, 3.0);
}

const std::vector<Form> kLag = {
    {"sensor_lag", "first order", "Oppenheim, Willsky 1997", kOwnDrive,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.sensor.lag_s = draw.spread(0.006, 0.02);
       return {{"sensor.lag_s", kIs, m.sensor.lag_s}};
     }},
    {"sensor_lag", "moving average", "Smith 1997", kOwnDrive,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.sensor.lag_form = LagForm::kMovingAverage;
       m.sensor.lag_s = draw.spread(0.005, 0.016);
       return {{"sensor.lag_s", kIs, m.sensor.lag_s}};
     }},
    {"sensor_lag", "tracking loop", "Ellis 2002", kCurrent,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.sensor.lag_form = LagForm::kTracking;
       m.sensor.lag_s = draw.spread(0.005, 0.014);
       return {{"sensor.lag_s", kIs, m.sensor.lag_s}};
     }},
};

const std::vector<Form> kQuantisation = {
    {"quantisation", "rounds", "Widrow, Kollar 2008", kAny,
     [](Draw& draw, const Rig&, Machine& m) { return quantum(draw, m, QuantumForm::kRound); }},
    {"quantisation",
     "truncates",  // which is rounding half a step lower
     "Widrow, Kollar 2008",
     kAny,
     [](Draw& draw, const Rig&, Machine& m) { return quantum(draw, m, QuantumForm::kFloor); },
     {"zero_offset"}},
    {"quantisation",
     "with a comparator's hysteresis",
     "Horowitz, Hill 2015",
     kAny,
     [](Draw& draw, const Rig&, Machine& m) { return quantum(draw, m, QuantumForm::kHysteresis); },
     {"hysteresis"}},
};

const std::vector<Form> kZero = {
    {"zero_offset", "constant", "Mooring, Roth, Driels 1991", kWeight,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.sensor.offset_rad = draw.sign() * draw.spread(0.03, 0.12);
       return {{"sensor.zero_offset_rad", kIs, m.sensor.offset_rad}};
     }},
    {"zero_offset", "slips during the session", "Mooring, Roth, Driels 1991", kWeight,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.sensor.slip_rad = draw.sign() * draw.spread(0.05, 0.15);
       m.sensor.slip_at = draw.uniform(0.3, 0.6);
       return {};
     }},
    {"zero_offset", "another one in each run: homing", "Conrad, Shiakolas, Yih 2000", kWeight,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.sensor.offset_rad = draw.sign() * draw.spread(0.03, 0.08);
       m.sensor.offset_spread_rad = draw.uniform(0.02, 0.04);
       return {};
     }},
    {"zero_offset", "drifts along a run", "Fraden 2016", kWeight,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       m.sensor.drift_rad = draw.sign() * draw.spread(0.04, 0.12);
       m.sensor.drift_s = draw.uniform(0.8, 2.5);
       return {};
     }},
};

const std::vector<Form> kHysteresis = {
    {"hysteresis", "play operator", "Krasnosel'skii, Pokrovskii 1989", kOwnDrive,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       play(draw, m, SensorPlay::kPlay);
       return {{"sensor.hysteresis_rad", kIs, m.sensor.play_rad}};
     }},
    {"hysteresis", "winds up exponentially", "Bouc 1967; Wen 1976", kOwnDrive,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       play(draw, m, SensorPlay::kSmooth);
       return {};
     }},
    {"hysteresis", "relay", "Preisach 1935", kOwnDrive,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       play(draw, m, SensorPlay::kRelay);
       m.sensor.play_rad *= 0.6;
       return {};
     }},
};

const std::vector<Form> kEccentricity = {
    {"eccentricity", "of the disc: once a turn", "Sanchez-Brea, Morlanes 2008", kWeight,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       eccentricity(draw, m);
       return {{"sensor.eccentricity_rad", kIs, m.sensor.eccentricity_rad}};
     }},
    {"eccentricity", "and an ellipse: twice a turn", "Sanchez-Brea, Morlanes 2008", kWeight,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       eccentricity(draw, m);
       m.sensor.eccentricity_second = draw.uniform(0.4, 0.8);
       return {{"sensor.eccentricity_rad", kIs, m.sensor.eccentricity_rad},
               {"sensor.ellipticity_rad", kIs, m.sensor.eccentricity_second * m.sensor.eccentricity_rad}};
     }},
    {"eccentricity", "of a disc on the motor's shaft", "Ellin, Dolsak 2008", kAny,
     [](Draw& draw, const Rig&, Machine& m) -> Planted {
       eccentricity(draw, m);
       m.sensor.eccentricity_order = 3.0 + static_cast<double>(draw.below(7));
       m.sensor.eccentricity_rad /= m.sensor.eccentricity_order;
       return {{"sensor.eccentricity_rad", kIs, m.sensor.eccentricity_rad},
               {"sensor.eccentricity_order", kIs, m.sensor.eccentricity_order}};
     }},
};

}  // namespace

std::vector<Form> sensor_forms() {
  std::vector<Form> all;
  for (const auto* forms : {&kLag, &kQuantisation, &kZero, &kHysteresis, &kEccentricity}) {
    all.insert(all.end(), forms->begin(), forms->end());
  }
  return all;
}

}  // namespace pmg::literature
