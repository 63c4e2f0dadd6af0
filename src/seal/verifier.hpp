// Checks controllers' signatures for an operator's program, at a bounded cost however many strangers send.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "seal/authentication.hpp"
#include "seal/key_files.hpp"

namespace pmg::seal {

/// A rate, and how many may come at once.
class Budget {
 public:
  constexpr Budget(std::int64_t period_ns, std::int64_t burst) noexcept : period_ns_(period_ns), burst_(burst) {}
  bool take(std::int64_t now_ns) noexcept;

 private:
  std::int64_t period_ns_, burst_, next_ns_ = 0;
};

/// A signature takes 0.1 ms. Whoever signed for a start of a controller before is asked alone; the starts that nobody
/// signed for yet have a budget of their own, so they take nothing from those that are known. A datagram that several
/// parts of a program look at is checked once.
class Verifier {
 public:
  static constexpr std::size_t kStarts = 64;  ///< as many robots as an operator's program shows

  explicit Verifier(std::vector<OperatorKey> keys) : keys_(std::move(keys)) {}

  const std::vector<OperatorKey>& keys() const noexcept { return keys_; }
  /// (text, signature of it, the start that claims it) => (the key's number; nothing: none's, or no time left for it).
  std::optional<std::size_t> signer(std::int64_t boot, Bytes text, Bytes signature, std::int64_t now_ns);
  std::int64_t checked() const noexcept { return checked_; }  ///< signatures since the start

 private:
  struct Start {
    std::int64_t boot = 0;
    std::size_t key = 0;
  };
  bool signed_by(std::size_t key, Bytes text, Bytes signature);

  std::vector<OperatorKey> keys_;
  std::array<Start, kStarts> starts_{};  // a ring
  std::size_t start_count_ = 0;
  Budget known_{1'000'000, 100}, unknown_{10'000'000, 40};
  std::int64_t checked_ = 0;
  Digest last_{};  // of text and signature that were checked last
  std::optional<std::size_t> last_signer_;
};

}  // namespace pmg::seal
