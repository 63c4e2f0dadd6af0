#include "io/log_writer.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "io/log_format.hpp"

namespace pmg::io {

namespace {

constexpr std::size_t kBufferBytes = 1 << 20;  // some two seconds of a 31-joint log: few system calls

std::uint8_t* put(std::uint8_t* to, std::uint64_t value, int bytes) {
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) *to++ = static_cast<std::uint8_t>(value >> shift);
  return to;
}

[[noreturn]] void refuse(const std::filesystem::path& path, const char* what) {
  throw std::runtime_error(path.string() + ": " + what + ": " + std::strerror(errno));
}

}  // namespace

LogWriter::LogWriter(const std::filesystem::path& path) : path_(path) {
  file_ = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file_ < 0) refuse(path_, "can't be created");
  buffer_.reserve(kBufferBytes + kBufferBytes / 8);
}

LogWriter::~LogWriter() {
  try {
    flush();
  } catch (const std::exception&) {  // a destructor can't report; a caller that must know flushes first
  }
  close(file_);
}

std::uint8_t* LogWriter::append(std::string_view channel, std::int64_t stamp_ns, int size) {
  const std::size_t start = buffer_.size();
  buffer_.resize(start + kLogHeaderBytes + channel.size() + static_cast<std::size_t>(size));
  std::uint8_t* to = buffer_.data() + start;
  to = put(to, kLogSync, 4);
  to = put(to, static_cast<std::uint64_t>(events_++), 8);
  to = put(to, static_cast<std::uint64_t>(stamp_ns / 1000), 8);
  to = put(to, channel.size(), 4);
  to = put(to, static_cast<std::uint64_t>(size), 4);
  std::memcpy(to, channel.data(), channel.size());
  return to + channel.size();
}

void LogWriter::flush_when_large() {
  if (buffer_.size() >= kBufferBytes) flush();
}

void LogWriter::flush() {
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t written = ::write(file_, buffer_.data() + done, buffer_.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      const int error = written < 0 ? errno : EIO;
      buffer_.clear();
      // Removes the half-written event. Where that is impossible, the reader skips it.
      if (ftruncate(file_, flushed_bytes_) == 0) lseek(file_, flushed_bytes_, SEEK_SET);
      errno = error;
      refuse(path_, "can't be written");
    }
    done += static_cast<std::size_t>(written);
  }
  flushed_bytes_ += static_cast<std::int64_t>(done);
  buffer_.clear();
}

bool LogWriter::in_place() const noexcept {
  struct stat named {
  }, open_file{};
  return stat(path_.c_str(), &named) == 0 && fstat(file_, &open_file) == 0 && named.st_ino == open_file.st_ino &&
         named.st_dev == open_file.st_dev;
}

void LogWriter::sync() {
  flush();
  if (fdatasync(file_) != 0 && errno != EINVAL && errno != EROFS) refuse(path_, "can't be written");
}

}  // namespace pmg::io
