#include "io/log_writer.hpp"

#include <cstdio>

namespace pmg::io {

namespace {
constexpr std::size_t kFileBufferBytes = 1 << 20;  // some three seconds of a 31-joint log: few system calls
constexpr std::size_t kMessageBytes = 4096;        // more than any message of a 31-joint robot
}  // namespace

LogWriter::LogWriter(const std::filesystem::path& path)
    : path_(path.string()), file_buffer_(kFileBufferBytes), file_(path_, "w"), buffer_(kMessageBytes) {
  if (!file_.good()) throw std::runtime_error(path_ + ": can't be created");
  std::setvbuf(file_.getFilePtr(), file_buffer_.data(), _IOFBF, file_buffer_.size());
}

void LogWriter::append(const std::string& channel, std::int64_t stamp_ns, int size) {
  event_.timestamp = stamp_ns / 1000;  // LCM logs count microseconds
  event_.channel = channel;
  event_.datalen = size;
  event_.data = buffer_.data();
  if (file_.writeEvent(&event_) != 0) throw std::runtime_error(path_ + ": can't be written (disk full?)");
}

void LogWriter::flush() {
  if (std::fflush(file_.getFilePtr()) != 0) throw std::runtime_error(path_ + ": can't be written (disk full?)");
}

}  // namespace pmg::io
