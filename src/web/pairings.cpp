#include "web/pairings.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "seal/private_file.hpp"

namespace pmg::web {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kTitle = "pmg pairing 1\ntoken_sha256: ";
constexpr std::size_t kLetters = 26, kLongestName = 15;

bool is_name(std::string_view name) {
  return !name.empty() && name.size() <= kLongestName && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

/// 5 bits a letter, without 0, 1, l and o, which look like others.
std::string random_token() {
  constexpr std::string_view kAlphabet = "abcdefghijkmnpqrstuvwxyz23456789";
  static_assert(kAlphabet.size() == 32);
  const seal::Secret bytes = seal::random_secret();
  std::string token;
  for (std::size_t i = 0; i < kLetters; ++i) token += kAlphabet[bytes[i] & 31U];
  return token;
}

std::string file_text(std::string_view token) {
  seal::Code digest{};
  if (EVP_Digest(token.data(), token.size(), digest.data(), nullptr, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("OpenSSL: no SHA-256");
  return fmt::format("{}{}\n", kTitle, seal::hex(digest));
}

seal::Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

std::string Pairings::make(const std::string& name) const {
  if (!is_name(name))
    throw std::runtime_error(fmt::format("\"{}\": expected 1 to {} letters, digits, '_' or '-'", name, kLongestName));
  seal::make_private_folder(folder_);
  const fs::path file = folder_ / (name + ".pairing");
  if (fs::exists(file)) seal::fail_of_key(file, "this name is paired; revoke it first");
  const std::string token = random_token();
  seal::write_private_file(file, file_text(token));
  return token;
}

bool Pairings::revoke(const std::string& name) const {
  return is_name(name) && fs::remove(folder_ / (name + ".pairing"));
}

std::vector<std::string> Pairings::names() const {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path& file = entry->path();
    if (file.extension() == ".pairing" && is_name(file.stem().string())) names.push_back(file.stem().string());
  }
  std::ranges::sort(names);
  return names;
}

std::optional<std::string> Pairings::find(std::string_view token) const {
  const std::string wanted = file_text(token);
  std::optional<std::string> found;
  for (const std::string& name : names()) {
    std::string text;
    try {
      text = seal::read_private_file(folder_ / (name + ".pairing"));
    } catch (const std::runtime_error&) {  // revoked meanwhile, or others may read it: it pairs nobody
    }
    if (text.size() == wanted.size() && seal::equal(bytes_of(text), bytes_of(wanted))) found = name;
  }
  return found;
}

}  // namespace pmg::web
