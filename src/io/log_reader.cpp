#include "io/log_reader.hpp"

#include <stdexcept>

namespace pmg::io {

LogReader::LogReader(const std::filesystem::path& path) : file_(path.string(), "r") {
  if (!file_.good()) throw std::runtime_error(path.string() + ": can't be opened");
}

bool LogReader::next() {
  event_ = file_.readNextEvent();
  return event_ != nullptr;
}

}  // namespace pmg::io
