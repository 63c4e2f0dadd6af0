#include "seal/verifier.hpp"

#include <algorithm>
#include <span>

namespace pmg::seal {

bool Budget::take(std::int64_t now_ns) noexcept {
  if (next_ns_ > now_ns + (burst_ - 1) * period_ns_) return false;
  next_ns_ = std::max(next_ns_, now_ns) + period_ns_;
  return true;
}

std::optional<std::size_t> Verifier::signer(std::int64_t boot, Bytes text, Bytes signature, std::int64_t now_ns) {
  std::vector<std::uint8_t> whole(text.begin(), text.end());
  whole.insert(whole.end(), signature.begin(), signature.end());
  const Digest digest = digest_of(whole);
  if (checked_ > 0 && digest == last_) return last_signer_;
  const auto known = std::span(starts_).first(std::min(start_count_, kStarts));
  const auto start = std::ranges::find(known, boot, &Start::boot);
  std::optional<std::size_t> found;
  if (start != known.end()) {
    if (!known_.take(now_ns)) return std::nullopt;
    if (signed_by(start->key, text, signature)) found = start->key;
  } else {
    for (std::size_t key = 0; key < keys_.size() && !found; ++key) {
      if (!unknown_.take(now_ns)) return std::nullopt;
      if (signed_by(key, text, signature)) found = key;
    }
    if (found) starts_[start_count_++ % kStarts] = {.boot = boot, .key = *found};
  }
  last_ = digest;
  last_signer_ = found;
  return found;
}

bool Verifier::signed_by(std::size_t key, Bytes text, Bytes signature) {
  ++checked_;
  return verified(keys_[key].controller, text, signature);
}

}  // namespace pmg::seal
