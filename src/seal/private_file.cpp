#include "seal/private_file.hpp"

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

namespace pmg::seal {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kLargestFile = 4096;

class File {
 public:
  /// shown: the file that an error names.
  File(const fs::path& path, int flags, const fs::path& shown)
      : fd_(::open(path.c_str(), flags | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0600)) {
    if (fd_ < 0) fail_of_key(shown, std::strerror(errno));
  }
  ~File() { ::close(fd_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int fd() const { return fd_; }

 private:
  int fd_;
};

}  // namespace

void fail_of_key(const fs::path& file, const std::string& what) {
  throw std::runtime_error(fmt::format("key {}: {}", file.string(), what));
}

std::string hex(Bytes bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

std::string read_private_file(const fs::path& file) {
  const File opened(file, O_RDONLY, file);
  struct stat status {};
  if (::fstat(opened.fd(), &status) != 0 || !S_ISREG(status.st_mode)) fail_of_key(file, "expected a file");
  if (status.st_uid != ::geteuid()) fail_of_key(file, "belongs to another user");
  if ((status.st_mode & 077) != 0) {
    fail_of_key(file, fmt::format("others may read or write it: chmod 600 {}", file.string()));
  }
  std::array<char, kLargestFile> buffer{};
  const ssize_t size = ::read(opened.fd(), buffer.data(), buffer.size());
  return {buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0))};
}

void write_private_file(const fs::path& file, const std::string& text) {
  const std::string growing = fmt::format("{}.{}", file.string(), ::getpid());
  const File opened(growing, O_WRONLY | O_CREAT | O_EXCL, file);
  const bool written =
      ::write(opened.fd(), text.data(), text.size()) == static_cast<ssize_t>(text.size()) && ::fsync(opened.fd()) == 0;
  const bool named = written && ::link(growing.c_str(), file.c_str()) == 0;
  const int error = errno;
  ::unlink(growing.c_str());
  if (!named) fail_of_key(file, std::strerror(error));
}

void make_private_folder(const fs::path& folder) {
  std::error_code error;
  const bool made = fs::create_directories(folder, error);
  if (error) fail_of_key(folder, error.message());
  if (made) ::chmod(folder.c_str(), 0700);  // another's folder stays as it is; the keys in it are the owner's alone
}

fs::path config_folder() {
  const char* xdg = std::getenv("XDG_CONFIG_HOME");
  if (xdg != nullptr && *xdg == '/') return fs::path(xdg) / "pmg";
  const char* home = std::getenv("HOME");
  return fs::path(home != nullptr && *home != '\0' ? home : "/") / ".config" / "pmg";
}

}  // namespace pmg::seal
