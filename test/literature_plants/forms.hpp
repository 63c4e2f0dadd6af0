// Lists of forms by the part of the joint that they change; planting.hpp joins them.
#pragma once

#include <vector>

#include "planting.hpp"

namespace pmg::literature {

std::vector<Form> friction_forms();
std::vector<Form> mechanics_forms();
std::vector<Form> drive_forms();
std::vector<Form> sensor_forms();
std::vector<Form> heat_forms();

using Planted = std::vector<PlantedParameter>;

inline constexpr RigNeeds kAny{};
inline constexpr RigNeeds kWeight{.weight = true};
inline constexpr RigNeeds kCurrent{.laws = kPd};                             ///< a drive that regulates its current
inline constexpr RigNeeds kOwnDrive{.laws = kPd | kServoLaw | kCascadeLaw};  ///< a drive that closes a loop

inline constexpr PlantedParameter::How kAdds = PlantedParameter::How::kAdds;
inline constexpr PlantedParameter::How kScales = PlantedParameter::How::kScales;
inline constexpr PlantedParameter::How kIs = PlantedParameter::How::kIs;

}  // namespace pmg::literature
