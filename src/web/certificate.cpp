#include "web/certificate.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <openssl/bio.h>
#include <openssl/ec.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>

#include <array>
#include <cstring>
#include <memory>
#include <optional>
#include <stdexcept>

#include "seal/private_file.hpp"

namespace pmg::web {

namespace {

namespace fs = std::filesystem;

template <auto kFree>
struct Freed {
  template <typename T>
  void operator()(T* object) const {
    kFree(object);
  }
};
using Key = std::unique_ptr<EVP_PKEY, Freed<EVP_PKEY_free>>;
using X509Ptr = std::unique_ptr<X509, Freed<X509_free>>;
using Bio = std::unique_ptr<BIO, Freed<BIO_free>>;
using Extension = std::unique_ptr<X509_EXTENSION, Freed<X509_EXTENSION_free>>;

constexpr std::int64_t kDay_s = 86400;
constexpr std::int64_t kRenewBefore_s = 30 * kDay_s;

void expect(bool done, const char* what) {
  if (!done) throw std::runtime_error(fmt::format("OpenSSL: the certificate's {} can't be made", what));
}

bool is_address(const std::string& name) {
  in6_addr address{};
  return inet_pton(AF_INET, name.c_str(), &address) == 1 || inet_pton(AF_INET6, name.c_str(), &address) == 1;
}

void extend(X509* certificate, int what, const std::string& value) {
  X509V3_CTX context{};
  X509V3_set_ctx(&context, certificate, certificate, nullptr, nullptr, 0);
  const Extension extension(X509V3_EXT_conf_nid(nullptr, &context, what, value.c_str()));
  expect(extension && X509_add_ext(certificate, extension.get(), -1) == 1, "extension");
}

std::string text_of(BIO* bio) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(bio, &data);
  return {data, static_cast<std::size_t>(size)};
}

X509Ptr certificate_in(const std::string& pem) {
  const Bio bio(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())));
  return X509Ptr(PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr));
}

Key key_in(const std::string& pem) {
  const Bio bio(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())));
  return Key(PEM_read_bio_PrivateKey(bio.get(), nullptr, nullptr, nullptr));
}

std::string make(std::span<const std::string> names, std::int64_t unix_s) {
  const Key key(EVP_EC_gen("P-256"));
  const X509Ptr certificate(X509_new());
  expect(key && certificate, "key");
  expect(X509_set_version(certificate.get(), 2) == 1, "version");
  std::int64_t serial = 0;
  expect(RAND_bytes(reinterpret_cast<unsigned char*>(&serial), sizeof serial) == 1, "number");
  serial &= 0x7fffffffffffffff;
  expect(ASN1_INTEGER_set_int64(X509_get_serialNumber(certificate.get()), serial) == 1, "number");
  time_t now = unix_s;
  X509_time_adj_ex(X509_getm_notBefore(certificate.get()), -1, 0, &now);  // clocks of phones may be behind
  X509_time_adj_ex(X509_getm_notAfter(certificate.get()), kCertificateDays - 1, 0, &now);
  expect(X509_set_pubkey(certificate.get(), key.get()) == 1, "key");
  X509_NAME* subject = X509_get_subject_name(certificate.get());
  constexpr std::string_view kName = "pmg_web";
  expect(X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_ASC, reinterpret_cast<const unsigned char*>(kName.data()),
                                    static_cast<int>(kName.size()), -1, 0) == 1,
         "subject");
  X509_set_issuer_name(certificate.get(), subject);
  std::string alternatives;
  for (const std::string& name : names)
    alternatives += fmt::format("{}{}:{}", alternatives.empty() ? "" : ",", is_address(name) ? "IP" : "DNS", name);
  if (!alternatives.empty()) extend(certificate.get(), NID_subject_alt_name, alternatives);
  extend(certificate.get(), NID_basic_constraints, "critical,CA:FALSE");
  extend(certificate.get(), NID_key_usage, "critical,digitalSignature");
  extend(certificate.get(), NID_ext_key_usage, "serverAuth");
  expect(X509_sign(certificate.get(), key.get(), EVP_sha256()) > 0, "signature");
  const Bio bio(BIO_new(BIO_s_mem()));
  expect(bio && PEM_write_bio_PrivateKey(bio.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) == 1 &&
             PEM_write_bio_X509(bio.get(), certificate.get()) == 1,
         "text");
  return text_of(bio.get());
}

std::string fingerprint_of(const X509* certificate) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  expect(X509_digest(certificate, EVP_sha256(), digest.data(), &size) == 1, "fingerprint");
  std::string text;
  for (unsigned i = 0; i < size; ++i) text += fmt::format("{}{:02X}", i == 0 ? "" : ":", digest.at(i));
  return text;
}

/// What the file holds; nothing: it ends soon.
std::optional<Certificate> read(const fs::path& file, std::int64_t unix_s) {
  const std::string pem = seal::read_private_file(file);
  const X509Ptr certificate = certificate_in(pem);
  const Key key = key_in(pem);
  if (!certificate || !key || X509_check_private_key(certificate.get(), key.get()) != 1)
    seal::fail_of_key(file, "expected a private key and its certificate; remove the file, and a new one is made");
  time_t renew_at = unix_s + kRenewBefore_s;
  if (X509_cmp_time(X509_get0_notAfter(certificate.get()), &renew_at) < 0) return std::nullopt;
  return Certificate{pem, fingerprint_of(certificate.get())};
}

}  // namespace

Certificate load_certificate(const fs::path& folder, std::span<const std::string> names, std::int64_t unix_s) {
  const fs::path file = folder / "server.pem";
  if (fs::exists(file)) {
    if (auto certificate = read(file, unix_s)) return *certificate;
    fs::remove(file);
  }
  seal::make_private_folder(folder);
  seal::write_private_file(file, make(names, unix_s));
  if (auto certificate = read(file, unix_s)) return *certificate;
  seal::fail_of_key(file, "ends before it begins: this computer's clock is wrong");
}

}  // namespace pmg::web
