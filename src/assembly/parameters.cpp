#include "assembly/parameters.hpp"

#include <array>

namespace pmg::assembly {

namespace {

const AssemblyParameter* found(const std::string& parameter) {
  for (const AssemblyParameter& one : assembly_parameters()) {
    if (parameter == one.name) return &one;
  }
  return nullptr;
}

}  // namespace

// Not listed: what is the same in every copy of a design (laws, limits, quantisation, the shape of a friction curve),
// and what the commands set.
std::span<const AssemblyParameter> assembly_parameters() {
  static constexpr std::array kParameters = {
      AssemblyParameter{"sensor.zero_offset_rad", "zero offset",
                        "the angle at which the arm sits on the shaft, and where the sensor's zero was set",
                        "check how the arm is mounted, and set the zero again"},
      AssemblyParameter{"ripple.offset_Nm", "constant torque", "cables and springs pull to one side",
                        "check cables and springs that pull to one side"},
      AssemblyParameter{"friction.coulomb_Nm", "dry friction",
                        "preload of bearings, seals and gear; grease; how tight the screws are",
                        "check bearings, seals and screws for preload"},
      AssemblyParameter{"friction.viscous_Nm_s_per_rad", "viscous friction",
                        "kind, amount and temperature of the grease", "check the grease"},
      AssemblyParameter{"drive.torque_scale", "motor strength", "magnets, winding and supply of each motor",
                        "check motor, supply and connectors"},
      AssemblyParameter{"load.gravity_scale", "weight", "mass and centre of mass of what is mounted",
                        "weigh what is mounted, and measure its centre of mass"},
      AssemblyParameter{"transmission.backlash_rad", "backlash", "wear of the gear and fit of the arm on the shaft",
                        "check the gear for play, and the fit of the arm on the shaft", Looked::kIfPresent},
      AssemblyParameter{"command.delay_s", "delay of commands", "firmware and bus settings of each drive",
                        "compare firmware and bus settings"},
  };
  return kParameters;
}

std::string title(const std::string& parameter) {
  const AssemblyParameter* one = found(parameter);
  return one == nullptr ? parameter : one->title;
}

std::string check(const std::string& parameter) {
  const AssemblyParameter* one = found(parameter);
  return one == nullptr ? "compare the assemblies" : one->check;
}

}  // namespace pmg::assembly
