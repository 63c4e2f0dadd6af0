#include "drives/motor.hpp"

#include <array>
#include <cstddef>

namespace pmg::drives {

const char* to_string(DriveFault fault) noexcept {
  constexpr std::array<const char*, 9> kTexts = {"no fault",
                                                 "over-temperature of the motor",
                                                 "over-current",
                                                 "over-voltage",
                                                 "under-voltage",
                                                 "encoder fault",
                                                 "over-temperature of the bridge",
                                                 "blocked rotor",
                                                 "a fault that the protocol doesn't name"};
  return kTexts[static_cast<std::size_t>(fault)];
}

}  // namespace pmg::drives
