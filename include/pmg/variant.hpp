// The three policies of the paper's Table I differ in what they imitate and which command they observe, in nothing
// else.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace pmg {

enum class Variant {
  kPmg,         ///< generator and ground-aware optimisation: u' is what the policy observes
  kWithoutGco,  ///< the same references; it observes u, the admissible command
  kSingleGait,  ///< the forward clip alone, played as strongly as the command is large; it observes u
};

/// As ONNX metadata and command lines spell them, in the order of Variant.
inline constexpr std::array<const char*, 3> kVariantNames = {"pmg", "without_gco", "single_gait"};

inline const char* to_string(Variant variant) noexcept { return kVariantNames[static_cast<std::size_t>(variant)]; }

inline std::optional<Variant> variant_named(std::string_view name) noexcept {
  for (std::size_t i = 0; i < kVariantNames.size(); ++i) {
    if (name == kVariantNames[i]) return static_cast<Variant>(i);
  }
  return std::nullopt;
}

}  // namespace pmg
