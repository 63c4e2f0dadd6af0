// Which phones, laptops and headsets may do more than look: a secret token for each, kept as its hash in a file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pmg::web {

/// FOLDER/NAME.pairing. Every call reads the folder anew, so what another process made or revoked counts at once. Any
/// thread may call it. A file that others may read, or that can't be read, pairs nobody. make() and revoke() throw with
/// one line where a file can't be written.
class Pairings {
 public:
  explicit Pairings(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Makes a pairing and returns its token: 26 letters and digits, 130 random bits. It is nowhere else. Throws if there
  /// is one of this name. name: 1 to 15 letters, digits, '_' or '-'.
  std::string make(const std::string& name) const;
  bool revoke(const std::string& name) const;  ///< false: there was none
  std::vector<std::string> names() const;
  /// The name that it was made for; nothing: no such token. Takes as long for each wrong token.
  std::optional<std::string> find(std::string_view token) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace pmg::web
