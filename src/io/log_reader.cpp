#include "io/log_reader.hpp"

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "io/log_format.hpp"

namespace pmg::io {

namespace {

constexpr std::size_t kBlockBytes = 1 << 20;
constexpr std::uint64_t kLongestChannel = 255;        // LCM allows 63
constexpr std::uint64_t kLargestMessage = 64u << 20;  // far above any message of a robot

std::uint64_t number(const std::uint8_t* from, int bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value = value << 8 | from[i];
  return value;
}

/// Opens files only: a pipe would be waited for, and a device may have no end.
std::FILE* open_file(const std::filesystem::path& path) {
  std::error_code none;
  const std::filesystem::file_type type = std::filesystem::status(path, none).type();
  const auto refuse = [&](const char* what) {
    throw std::runtime_error(path.string() + ": is " + what + "; expected a log");
  };
  if (type == std::filesystem::file_type::directory) refuse("a folder");
  if (type == std::filesystem::file_type::fifo) refuse("a pipe");
  if (type == std::filesystem::file_type::socket) refuse("a socket");
  if (type == std::filesystem::file_type::character || type == std::filesystem::file_type::block) refuse("a device");
  return std::fopen(path.c_str(), "rbe");
}

}  // namespace

LogReader::LogReader(const std::filesystem::path& path) : file_(open_file(path), std::fclose) {
  if (!file_) throw std::runtime_error(path.string() + ": can't be opened: " + std::strerror(errno));
}

bool LogReader::next() {
  bool tail_cut = false;
  while (true) {
    const Outcome outcome = parse();
    if (outcome == Outcome::kEvent) return true;
    if (outcome == Outcome::kEnd) {
      if (at_ == window_.size()) {
        cut_short_ = tail_cut;
        return false;
      }
      tail_cut = true;  // unless another event follows
    }
    ++at_;  // no event begins here
    ++skipped_bytes_;
  }
}

/// kEnd: the file ends before the event that seems to begin here.
LogReader::Outcome LogReader::parse() {
  if (!available(kLogHeaderBytes)) return Outcome::kEnd;
  const std::uint8_t* header = window_.data() + at_;
  if (number(header, 4) != kLogSync) return Outcome::kNoEvent;
  const std::uint64_t stamp_us = number(header + 12, 8);
  const std::uint64_t channel_bytes = number(header + 20, 4), data_bytes = number(header + 24, 4);
  if (channel_bytes == 0 || channel_bytes > kLongestChannel || data_bytes > kLargestMessage) return Outcome::kNoEvent;
  if (!available(kLogHeaderBytes + channel_bytes + data_bytes)) return Outcome::kEnd;

  const std::uint8_t* channel = window_.data() + at_ + kLogHeaderBytes;
  channel_.assign(channel, channel + channel_bytes);
  data_.assign(channel + channel_bytes, channel + channel_bytes + data_bytes);
  stamp_us_ = static_cast<std::int64_t>(stamp_us);
  at_ += kLogHeaderBytes + channel_bytes + data_bytes;
  return Outcome::kEvent;
}

/// Loads this many bytes from at_ on into the window.
bool LogReader::available(std::size_t bytes) {
  while (window_.size() - at_ < bytes) {
    window_.erase(window_.begin(), window_.begin() + static_cast<std::ptrdiff_t>(at_));
    at_ = 0;
    const std::size_t held = window_.size();
    window_.resize(held + kBlockBytes);
    const std::size_t got = std::fread(window_.data() + held, 1, kBlockBytes, file_.get());
    window_.resize(held + got);
    if (got == 0) return false;
  }
  return true;
}

}  // namespace pmg::io
