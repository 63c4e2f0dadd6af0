// What a simulated robot's hoist said last, to whoever listens.
#pragma once

#include <cstdint>
#include <optional>

#include "io/lcm_link.hpp"
#include "pmg_msgs/hoist_state_t.hpp"
#include "seal/operator_seal.hpp"

namespace pmg::ops {

using SealedHoist = seal::Sealed<pmg_msgs::hoist_state_t, pmg_msgs::proof_t>;

/// Of one robot; stays without a state on a robot without a hoist.
struct HeardHoist {
  /// A hoist sends its state ten times a second. After this time without one there is no hoist.
  static constexpr std::int64_t kSilent_ns = 1'000'000'000;

  /// Takes the state if it is of the start with this boot number, no older than the one before, and the seal believes
  /// it. Times by the listener's clock.
  void hear(const SealedHoist& heard, std::int64_t boot, const seal::OperatorSeal& seal, std::int64_t now_ns);
  /// Nothing: none, or silent for longer than kSilent_ns.
  std::optional<pmg_msgs::hoist_state_t> speaking(std::int64_t now_ns) const noexcept;

  std::optional<pmg_msgs::hoist_state_t> state{};
  std::int64_t heard_ns = 0;
};

/// 0 without a seal.
std::int64_t boot_of(const std::optional<pmg_msgs::proof_t>& proof) noexcept;

}  // namespace pmg::ops
