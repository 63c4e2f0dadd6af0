#include "model/actuator_parameters.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "files/nearest_name.hpp"

namespace pmg::model {

namespace {

using enum Quantity;

struct QuantityRow {
  Quantity quantity;
  std::string_view unit;
  double factor_on_linear_axis = 1.0;
  bool follows_torque = false;
};

constexpr std::array kQuantities = {
    QuantityRow{kFactor, ""},
    QuantityRow{kOrder, ""},
    QuantityRow{kDelay, "s"},
    QuantityRow{kPeriod, "s"},
    QuantityRow{kLag, "s"},
    QuantityRow{kTimeConstant, "s"},
    QuantityRow{kAngle, "rad"},
    QuantityRow{kPhase, "rad"},
    QuantityRow{kQuantum, "rad"},
    QuantityRow{kPlace, ""},
    QuantityRow{kSpeed, "rad/s"},
    QuantityRow{kAcceleration, "rad/s^2"},
    QuantityRow{kTorque, "Nm", 100.0, true},
    QuantityRow{kDamping, "Nm s/rad", 100.0, true},
    QuantityRow{kQuadraticDamping, "Nm s^2/rad^2", 100.0, true},
    QuantityRow{kStiffness, "Nm/rad", 100.0, true},
    QuantityRow{kSpringRate, "Nm/rad", 100.0, true},
    QuantityRow{kHardening, "Nm/rad^3", 100.0, true},
    QuantityRow{kTorquePerOutput, "Nm/unit", 100.0, true},
    QuantityRow{kInertia, "kg m^2", 1000.0, true},
    QuantityRow{kPower, "W", 100.0},
    QuantityRow{kPerTorque, "1/Nm", 0.01},
    QuantityRow{kPerHeat, "1/(Nm^2 s)", 1e-4},
    QuantityRow{kPerEnergy, "1/J", 0.01},
    QuantityRow{kPerKelvin, "1/K"},
    QuantityRow{kOutput, "unit"},
    QuantityRow{kOutputRate, "unit/s"},
    QuantityRow{kBackEmf, "unit s/rad"},
};

constexpr const QuantityRow& row(Quantity quantity) { return kQuantities[static_cast<std::size_t>(quantity)]; }

static_assert(std::ranges::all_of(kQuantities, [](const QuantityRow& one) { return &row(one.quantity) == &one; }),
              "the rows stand in the order of the enum");

}  // namespace

std::string_view unit(Quantity quantity) { return row(quantity).unit; }

double factor_on_linear_axis(Quantity quantity) { return row(quantity).factor_on_linear_axis; }

bool follows_torque(Quantity quantity) { return row(quantity).follows_torque; }

const ActuatorParameter& actuator_parameter(std::string_view name) {
  const auto* const found = std::ranges::find(kActuatorParameters, name, &ActuatorParameter::name);
  if (found != kActuatorParameters.end()) return *found;
  std::vector<std::string> names;
  for (const ActuatorParameter& parameter : kActuatorParameters) names.emplace_back(parameter.name);
  throw std::invalid_argument("no actuator parameter is called '" + std::string(name) + "'; " +
                              files::expected_name(name, names));
}

}  // namespace pmg::model
