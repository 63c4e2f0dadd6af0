#include "seal/key_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "seal/private_file.hpp"

namespace pmg::seal {

namespace {

namespace fs = std::filesystem;

/// Of 64 hexadecimal digits.
std::optional<std::array<std::uint8_t, 32>> from_hex(std::string_view text) {
  std::array<std::uint8_t, 32> bytes{};
  if (text.size() != 2 * bytes.size()) return std::nullopt;
  constexpr std::string_view kDigits = "0123456789abcdef";
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::size_t high = kDigits.find(text[2 * i]), low = kDigits.find(text[2 * i + 1]);
    if (high == std::string_view::npos || low == std::string_view::npos) return std::nullopt;
    bytes[i] = static_cast<std::uint8_t>(high << 4 | low);
  }
  return bytes;
}

/// "word: value" by word; the first line is the title.
std::map<std::string, std::string> read_lines(const fs::path& path, const std::string& title) {
  const std::string whole = read_private_file(path);
  std::string_view text = whole;
  std::map<std::string, std::string> lines;
  bool first = true;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    const std::size_t colon = line.find(": ");
    if (std::exchange(first, false)) {
      if (line != title) break;
    } else if (colon != std::string_view::npos) {
      lines[std::string(line.substr(0, colon))] = line.substr(colon + 2);
    }
  }
  if (lines.empty()) fail_of_key(path, fmt::format("expected a file that begins with \"{}\"", title));
  return lines;
}

std::array<std::uint8_t, 32> bytes_of(const fs::path& path, const std::map<std::string, std::string>& lines,
                                      const std::string& word) {
  const auto found = lines.find(word);
  const auto bytes = found == lines.end() ? std::nullopt : from_hex(found->second);
  if (!bytes) fail_of_key(path, fmt::format("expected \"{}: \" and 64 hexadecimal digits", word));
  return *bytes;
}

constexpr const char* kControllerTitle = "pmg controller key 1";
constexpr const char* kSharedTitle = "pmg shared key 1";
constexpr const char* kOperatorTitle = "pmg operator key 1";

fs::path shared_file(const fs::path& folder, const std::string& name) { return folder / "operators" / (name + ".key"); }

/// Without a point: behind one a program says which of the operator's it is. "anna.4194304", for the highest process
/// number, fits into a source's 23 characters.
constexpr std::size_t kLongestName = 23 - 1 - 7;

bool is_name(std::string_view name) {
  return !name.empty() && name.size() <= kLongestName && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

std::vector<fs::path> key_files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().extension() == ".key") files.push_back(entry->path());
  }
  if (error && error != std::errc::no_such_file_or_directory) fail_of_key(folder, error.message());
  std::ranges::sort(files);
  return files;
}

}  // namespace

bool may_speak_as(std::string_view key, std::string_view source) noexcept {
  return !key.empty() && source.starts_with(key) && (source.size() == key.size() || source[key.size()] == '.');
}

fs::path controller_folder() { return config_folder() / "controller-keys"; }
fs::path operator_folder() { return config_folder() / "operator-keys"; }

std::optional<ControllerKeys> read_controller_keys(const fs::path& folder) {
  const fs::path own = folder / "controller.key";
  std::error_code error;
  if (!fs::exists(own, error)) {
    if (error) fail_of_key(own, error.message());
    return std::nullopt;
  }
  ControllerKeys keys{.own = bytes_of(own, read_lines(own, kControllerTitle), "private"), .operators = {}};
  for (const fs::path& file : key_files_in(folder / "operators")) {
    if (!is_name(file.stem().string())) fail_of_key(file, "expected an operator's name and .key");
    keys.operators[file.stem().string()] = bytes_of(file, read_lines(file, kSharedTitle), "secret");
  }
  return keys;
}

std::vector<OperatorKey> read_operator_keys(const fs::path& folder) {
  std::vector<OperatorKey> keys;
  for (const fs::path& file : key_files_in(folder)) {
    const auto lines = read_lines(file, kOperatorTitle);
    const auto name = lines.find("operator");
    if (name == lines.end() || !is_name(name->second)) fail_of_key(file, "expected \"operator: \" and a name");
    if (!keys.empty() && keys.front().name != name->second) {
      fail_of_key(file, fmt::format("a key of operator {} among keys of {}: expected one operator's in a folder",
                                    name->second, keys.front().name));
    }
    keys.push_back({name->second, bytes_of(file, lines, "controller"), bytes_of(file, lines, "secret")});
  }
  return keys;
}

OperatorKey make_operator_key(const fs::path& folder, const std::string& name) {
  if (!is_name(name)) {
    throw std::runtime_error(
        fmt::format("operator \"{}\": expected 1 to {} letters, digits, '_' or '-'", name, kLongestName));
  }
  make_private_folder(folder);
  make_private_folder(folder / "operators");
  if (!fs::exists(folder / "controller.key")) {
    write_private_file(folder / "controller.key",
                       fmt::format("{}\nprivate: {}\n", kControllerTitle, hex(random_secret())));
  }
  const auto keys = read_controller_keys(folder);
  const OperatorKey key{name, Signer(keys->own).public_key(), random_secret()};
  if (fs::exists(shared_file(folder, name)))
    fail_of_key(shared_file(folder, name), "this operator has a key; revoke it first");
  write_private_file(shared_file(folder, name), fmt::format("{}\nsecret: {}\n", kSharedTitle, hex(key.secret)));
  return key;
}

void write_operator_key(const fs::path& file, const OperatorKey& key) {
  write_private_file(file, fmt::format("{}\noperator: {}\ncontroller: {}\nsecret: {}\n", kOperatorTitle, key.name,
                                       hex(key.controller), hex(key.secret)));
}

bool revoke_operator_key(const fs::path& folder, const std::string& name) {
  if (!is_name(name)) return false;
  std::error_code error;
  const bool removed = fs::remove(shared_file(folder, name), error);
  if (error) fail_of_key(shared_file(folder, name), error.message());
  return removed;
}

}  // namespace pmg::seal
