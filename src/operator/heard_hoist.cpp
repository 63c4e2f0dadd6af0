#include "operator/heard_hoist.hpp"

namespace pmg::ops {

void HeardHoist::hear(const SealedHoist& heard, std::int64_t boot, const seal::OperatorSeal& seal,
                      std::int64_t now_ns) {
  const bool recorded = boot_of(heard.seal) != boot || (state && heard.message.stamp_ns < state->stamp_ns);
  if (recorded || !seal.believe("HOIST_STATE", heard.message_bytes, heard.seal, now_ns)) return;
  state = heard.message;
  heard_ns = now_ns;
}

std::optional<pmg_msgs::hoist_state_t> HeardHoist::speaking(std::int64_t now_ns) const noexcept {
  return now_ns - heard_ns > kSilent_ns ? std::nullopt : state;
}

std::int64_t boot_of(const std::optional<pmg_msgs::proof_t>& proof) noexcept { return proof ? proof->boot : 0; }

}  // namespace pmg::ops
