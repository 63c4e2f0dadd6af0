#include "drives/motor.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace pmg::drives {

bool finite(const MotorCommand& command) noexcept {
  return std::isfinite(command.q_rad) && std::isfinite(command.dq_rad_s) && std::isfinite(command.kp_Nm_per_rad) &&
         std::isfinite(command.kd_Nm_s_per_rad) && std::isfinite(command.torque_Nm);
}

const char* to_string(DriveFault fault) noexcept {
  constexpr std::array<const char*, 12> kTexts = {"no fault",
                                                  "over-temperature of the motor",
                                                  "over-current",
                                                  "over-voltage",
                                                  "under-voltage",
                                                  "encoder fault",
                                                  "over-temperature of the bridge",
                                                  "blocked rotor",
                                                  "a fault that the protocol doesn't name",
                                                  "a communication fault",
                                                  "a following error",
                                                  "an overload"};
  return kTexts[static_cast<std::size_t>(fault)];
}

}  // namespace pmg::drives
