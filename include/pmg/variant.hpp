// The three policies of the paper's Table I. They differ only in the imitated motion and in the observed command.
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
};

/// Spellings in ONNX metadata and on command lines, in the order of Variant.
inline constexpr std::array<const char*, 3> kVariantNames = {"pmg", "without_gco", "single_gait"};

inline const char* to_string(Variant variant) noexcept { return kVariantNames[static_cast<std::size_t>(variant)]; }

inline std::optional<Variant> variant_named(std::string_view name) noexcept {
  for (std::size_t i = 0; i < kVariantNames.size(); ++i) {
    if (name == kVariantNames[i]) return static_cast<Variant>(i);
  }
  return std::nullopt;
}

}  // namespace pmg
