#include "seal/key_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace pmg::seal {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestFile = 4096;

[[noreturn]] void fail(const fs::path& file, const std::string& what) {
  throw std::runtime_error(fmt::format("key {}: {}", file.string(), what));
}

std::string hex(Bytes bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

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

class File {
 public:
  /// shown: the file that an error names.
  File(const fs::path& path, int flags, const fs::path& shown)
      : fd_(::open(path.c_str(), flags | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0600)) {
    if (fd_ < 0) fail(shown, std::strerror(errno));
  }
  ~File() { ::close(fd_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int fd() const { return fd_; }

 private:
  int fd_;
};

/// "word: value" by word; the first line is the title.
std::map<std::string, std::string> read_lines(const fs::path& path, const std::string& title) {
  const File file(path, O_RDONLY, path);
  struct stat status {};
  if (::fstat(file.fd(), &status) != 0 || !S_ISREG(status.st_mode)) fail(path, "expected a file");
  if (status.st_uid != ::geteuid()) fail(path, "belongs to another user");
  if ((status.st_mode & 077) != 0) {
    fail(path, fmt::format("others may read or write it: chmod 600 {}", path.string()));
  }
  std::array<char, kLargestFile> buffer{};
  const ssize_t size = ::read(file.fd(), buffer.data(), buffer.size());
  std::string_view text(buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
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
  if (lines.empty()) fail(path, fmt::format("expected a file that begins with \"{}\"", title));
  return lines;
}

std::array<std::uint8_t, 32> bytes_of(const fs::path& path, const std::map<std::string, std::string>& lines,
                                      const std::string& word) {
  const auto found = lines.find(word);
  const auto bytes = found == lines.end() ? std::nullopt : from_hex(found->second);
  if (!bytes) fail(path, fmt::format("expected \"{}: \" and 64 hexadecimal digits", word));
  return *bytes;
}

/// Never half a file under this name: a running controller may read it at any time.
void write_new(const fs::path& path, const std::string& text) {
  const std::string growing = fmt::format("{}.{}", path.string(), ::getpid());
  const File file(growing, O_WRONLY | O_CREAT | O_EXCL, path);
  const bool written =
      ::write(file.fd(), text.data(), text.size()) == static_cast<ssize_t>(text.size()) && ::fsync(file.fd()) == 0;
  const bool named = written && ::link(growing.c_str(), path.c_str()) == 0;
  const int error = errno;
  ::unlink(growing.c_str());
  if (!named) fail(path, std::strerror(error));
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  const bool made = fs::create_directories(folder, error);
  if (error) fail(folder, error.message());
  if (made) ::chmod(folder.c_str(), 0700);  // another's folder stays as it is; the keys in it are the owner's alone
}

fs::path config_folder() {
  const char* xdg = std::getenv("XDG_CONFIG_HOME");
  if (xdg != nullptr && *xdg == '/') return fs::path(xdg) / "pmg";
  const char* home = std::getenv("HOME");
  return fs::path(home != nullptr && *home != '\0' ? home : "/") / ".config" / "pmg";
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
  if (error && error != std::errc::no_such_file_or_directory) fail(folder, error.message());
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
    if (error) fail(own, error.message());
    return std::nullopt;
  }
  ControllerKeys keys{.own = bytes_of(own, read_lines(own, kControllerTitle), "private"), .operators = {}};
  for (const fs::path& file : key_files_in(folder / "operators")) {
    if (!is_name(file.stem().string())) fail(file, "expected an operator's name and .key");
    keys.operators[file.stem().string()] = bytes_of(file, read_lines(file, kSharedTitle), "secret");
  }
  return keys;
}

std::vector<OperatorKey> read_operator_keys(const fs::path& folder) {
  std::vector<OperatorKey> keys;
  for (const fs::path& file : key_files_in(folder)) {
    const auto lines = read_lines(file, kOperatorTitle);
    const auto name = lines.find("operator");
    if (name == lines.end() || !is_name(name->second)) fail(file, "expected \"operator: \" and a name");
    if (!keys.empty() && keys.front().name != name->second) {
      fail(file, fmt::format("a key of operator {} among keys of {}: expected one operator's in a folder", name->second,
                             keys.front().name));
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
  make_folder(folder);
  make_folder(folder / "operators");
  if (!fs::exists(folder / "controller.key")) {
    write_new(folder / "controller.key", fmt::format("{}\nprivate: {}\n", kControllerTitle, hex(random_secret())));
  }
  const auto keys = read_controller_keys(folder);
  const OperatorKey key{name, Signer(keys->own).public_key(), random_secret()};
  if (fs::exists(shared_file(folder, name)))
    fail(shared_file(folder, name), "this operator has a key; revoke it first");
  write_new(shared_file(folder, name), fmt::format("{}\nsecret: {}\n", kSharedTitle, hex(key.secret)));
  return key;
}

void write_operator_key(const fs::path& file, const OperatorKey& key) {
  write_new(file, fmt::format("{}\noperator: {}\ncontroller: {}\nsecret: {}\n", kOperatorTitle, key.name,
                              hex(key.controller), hex(key.secret)));
}

bool revoke_operator_key(const fs::path& folder, const std::string& name) {
  if (!is_name(name)) return false;
  std::error_code error;
  const bool removed = fs::remove(shared_file(folder, name), error);
  if (error) fail(shared_file(folder, name), error.message());
  return removed;
}

}  // namespace pmg::seal
