#include "files/bounded_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "files/config_error.hpp"
#include "files/nearest_name.hpp"

namespace pmg::files {

namespace {

const char* kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& file) : fd_(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) close(fd_);
  }
  int get() const { return fd_; }

 private:
  int fd_;
};

std::string mebibytes(std::uint64_t bytes) { return fmt::format("{:.3g} MiB", static_cast<double>(bytes) / (1 << 20)); }

/// Its size.
std::uint64_t checked(int fd, const std::filesystem::path& file, std::uint64_t largest_bytes,
                      const std::string& expected) {
  struct stat status {};
  if (fd < 0 || fstat(fd, &status) != 0) {
    const int error = errno;
    const std::filesystem::path meant = error == ENOENT ? nearest_file(file) : "";
    if (!meant.empty()) {
      throw ConfigError(fmt::format("{}: there is no such file; did you mean {}?", file.string(), meant.string()));
    }
    raise({file.string()}, "", fmt::format("cannot be read ({})", std::strerror(error)), expected);
  }
  if (!S_ISREG(status.st_mode)) raise({file.string()}, "", fmt::format("is {}", kind_of(status.st_mode)), expected);
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size > largest_bytes) {
    raise({file.string()}, "", fmt::format("has {}", mebibytes(size)),
          fmt::format("{} of {} at most", expected, mebibytes(largest_bytes)));
  }
  return size;
}

}  // namespace

void expect_bounded_file(const std::filesystem::path& file, std::uint64_t largest_bytes, const std::string& expected) {
  const Descriptor descriptor(file);
  checked(descriptor.get(), file, largest_bytes, expected);
}

std::string read_bounded_text(const std::filesystem::path& file, std::uint64_t largest_bytes,
                              const std::string& expected) {
  std::string text = read_bounded_bytes(file, largest_bytes, expected);
  if (text.find('\0') != std::string::npos) raise({file.string()}, "", "isn't a text", expected);
  return text;
}

std::string read_bounded_bytes(const std::filesystem::path& file, std::uint64_t largest_bytes,
                               const std::string& expected) {
  const Descriptor descriptor(file);
  std::string text(checked(descriptor.get(), file, largest_bytes, expected), '\0');
  std::size_t got = 0;
  while (got < text.size()) {
    const ssize_t count = read(descriptor.get(), text.data() + got, text.size() - got);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) raise({file.string()}, "", fmt::format("cannot be read ({})", std::strerror(errno)), expected);
    if (count == 0) break;  // it shrank meanwhile
    got += static_cast<std::size_t>(count);
  }
  text.resize(got);
  return text;
}

}  // namespace pmg::files
