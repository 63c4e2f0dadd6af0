// The three policies of the paper's Table I, which differ only in the imitated motion and in the observed command; and
// policies of other projects, which imitate none.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace pmg {

enum class Variant {
  kPmg,         ///< generator and ground-aware optimisation; the policy observes u'
  kWithoutGco,  ///< the same references; the policy observes u, the admissible command
  kSingleGait,  ///< the forward clip alone, its gain set by the size of the command; the policy observes u
  kVelocity,    ///< no motion: the reference stands still; the policy observes the velocities of u and steps by itself
};

/// Spellings, in the order of Variant. ONNX metadata and command lines know the first three.
inline constexpr std::array<const char*, 4> kVariantNames = {"pmg", "without_gco", "single_gait", "velocity"};
inline constexpr std::size_t kTrainedVariants = 3;

inline const char* to_string(Variant variant) noexcept { return kVariantNames[static_cast<std::size_t>(variant)]; }

/// There for comparison with the paper's own.
constexpr bool is_baseline(Variant variant) noexcept {
  return variant == Variant::kWithoutGco || variant == Variant::kSingleGait;
}

/// Of those that training makes.
inline std::optional<Variant> variant_named(std::string_view name) noexcept {
  for (std::size_t i = 0; i < kTrainedVariants; ++i) {
    if (name == kVariantNames[i]) return static_cast<Variant>(i);
  }
  return std::nullopt;
}

}  // namespace pmg
