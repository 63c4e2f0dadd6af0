// The server's certificate: made by itself and for itself, once, and kept.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace pmg::web {

struct Certificate {
  std::string pem;          ///< private key (P-256), then certificate
  std::string fingerprint;  ///< SHA-256 of the certificate: "3F:0A:...", as browsers show it
};

/// Days for which it is good: browsers refuse certificates of more than 825.
inline constexpr int kCertificateDays = 800;

/// Reads FOLDER/server.pem; makes it if it isn't there, or if it is good for less than 30 days more. names: hosts and
/// IP addresses that it is for when it is made. unix_s: the time now [s since 1970]. Throws std::runtime_error with one
/// line.
Certificate load_certificate(const std::filesystem::path& folder, std::span<const std::string> names,
                             std::int64_t unix_s);

}  // namespace pmg::web
