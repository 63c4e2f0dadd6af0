// A number that decides something, with what it is and why: one row in the struct that holds it.
#pragma once

#include <cstddef>
#include <string_view>
#include <type_traits>

namespace pmg::work {

/// Used as the plain number. Assigning a number keeps what the row says of it.
template <typename Number>
struct ThresholdOf {
  Number value;
  std::string_view unit;    ///< "" for a share, a count or a number of standard deviations
  std::string_view reason;  ///< the decision that depends on it
  std::string_view set_on;  ///< the data it was tuned on; or "assumed", and what would settle it

  constexpr operator Number() const noexcept { return value; }  // NOLINT(google-explicit-constructor): it is a number
  constexpr ThresholdOf& operator=(Number number) noexcept {
    value = number;
    return *this;
  }
};

using Threshold = ThresholdOf<double>;
using CountThreshold = ThresholdOf<int>;

/// Calls visit(name, member) for each member of a PMG_THRESHOLDS; names is the list as it is written there.
template <typename Visit, typename... Members>
void visit_named(std::string_view names, Visit& visit, Members&... members) {
  const auto next = [&names] {
    if (names.starts_with(' ')) names = names.substr(1);
    const std::string_view name = names.substr(0, names.find(','));
    names = names.size() > name.size() ? names.substr(name.size() + 1) : "";
    return name;
  };
  (visit(next(), members), ...);
}

/// Within a struct of thresholds and of such structs: gives it each_threshold(visit), which calls visit(name, member)
/// for all of them in this order. A member that is left out doesn't compile.
#define PMG_THRESHOLDS(...)                                                         \
  template <typename Visit>                                                         \
  void each_threshold(Visit&& visit) {                                              \
    ::pmg::work::expect_all<std::remove_reference_t<decltype(*this)>>(__VA_ARGS__); \
    ::pmg::work::visit_named(#__VA_ARGS__, visit, __VA_ARGS__);                     \
  }

/// Refuses to compile where the members don't fill the struct.
template <typename Struct, typename... Members>
constexpr void expect_all(const Members&...) {
  static_assert((sizeof(Members) + ... + 0U) == sizeof(Struct), "PMG_THRESHOLDS doesn't name every member");
}

}  // namespace pmg::work
