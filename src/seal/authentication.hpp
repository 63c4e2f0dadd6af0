// HMAC-SHA256 and Ed25519, both from OpenSSL.
#pragma once

#include <openssl/evp.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace pmg::seal {

using Bytes = std::span<const std::uint8_t>;
using Secret = std::array<std::uint8_t, 32>;      ///< an operator's, shared with the controller
using Code = std::array<std::uint8_t, 32>;        ///< HMAC-SHA256 (RFC 2104)
using PublicKey = std::array<std::uint8_t, 32>;   ///< Ed25519 (RFC 8032)
using PrivateKey = std::array<std::uint8_t, 32>;  ///< likewise: the seed
using Signature = std::array<std::uint8_t, 64>;   ///< likewise

/// From the system's generator. Throws std::runtime_error if it has none.
Secret random_secret();
std::int64_t random_number();

Code code_of(const Secret& secret, Bytes text);
using Digest = std::array<std::uint8_t, 32>;  ///< SHA-256 (FIPS 180-4)
Digest digest_of(Bytes text);
/// In a time that does not depend on where the codes differ.
bool equal(Bytes a, Bytes b) noexcept;

/// Ed25519 with one private key. For one thread at a time.
class Signer {
 public:
  explicit Signer(const PrivateKey& key);
  Signature sign(Bytes text) const;
  PublicKey public_key() const;

 private:
  std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)> key_;
};

bool verified(const PublicKey& key, Bytes text, Bytes signature) noexcept;

}  // namespace pmg::seal
