#include "seal/authentication.hpp"

#include <openssl/crypto.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>

#include <cstring>
#include <stdexcept>
#include <string>

namespace pmg::seal {

namespace {

using Context = std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)>;

void expect(bool done, const char* what) {
  if (!done) throw std::runtime_error(std::string("OpenSSL: ") + what);
}

}  // namespace

Secret random_secret() {
  Secret secret{};
  expect(RAND_bytes(secret.data(), static_cast<int>(secret.size())) == 1, "no random numbers");
  return secret;
}

std::int64_t random_number() {
  const Secret bytes = random_secret();
  std::int64_t number = 0;
  std::memcpy(&number, bytes.data(), sizeof(number));
  return number;
}

Code code_of(const Secret& secret, Bytes text) {
  Code code{};
  unsigned size = static_cast<unsigned>(code.size());
  expect(HMAC(EVP_sha256(), secret.data(), static_cast<int>(secret.size()), text.data(), text.size(), code.data(),
              &size) != nullptr,
         "no HMAC-SHA256");
  return code;
}

Digest digest_of(Bytes text) {
  Digest digest{};
  expect(EVP_Digest(text.data(), text.size(), digest.data(), nullptr, EVP_sha256(), nullptr) == 1, "no SHA-256");
  return digest;
}

bool equal(Bytes a, Bytes b) noexcept {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

Signer::Signer(const PrivateKey& key)
    : key_(EVP_PKEY_new_raw_private_key(EVP_PKEY_ED25519, nullptr, key.data(), key.size()), &EVP_PKEY_free) {
  expect(key_ != nullptr, "no Ed25519 key");
}

Signature Signer::sign(Bytes text) const {
  const Context context(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
  Signature signature{};
  std::size_t size = signature.size();
  expect(context != nullptr && EVP_DigestSignInit(context.get(), nullptr, nullptr, nullptr, key_.get()) == 1 &&
             EVP_DigestSign(context.get(), signature.data(), &size, text.data(), text.size()) == 1,
         "no Ed25519 signature");
  return signature;
}

PublicKey Signer::public_key() const {
  PublicKey key{};
  std::size_t size = key.size();
  expect(EVP_PKEY_get_raw_public_key(key_.get(), key.data(), &size) == 1, "no Ed25519 public key");
  return key;
}

bool verified(const PublicKey& key, Bytes text, Bytes signature) noexcept {
  const std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)> parsed(
      EVP_PKEY_new_raw_public_key(EVP_PKEY_ED25519, nullptr, key.data(), key.size()), &EVP_PKEY_free);
  const Context context(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
  return parsed != nullptr && context != nullptr &&
         EVP_DigestVerifyInit(context.get(), nullptr, nullptr, nullptr, parsed.get()) == 1 &&
         EVP_DigestVerify(context.get(), signature.data(), signature.size(), text.data(), text.size()) == 1;
}

}  // namespace pmg::seal
