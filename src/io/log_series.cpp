#include "io/log_series.hpp"

#include <charconv>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

namespace pmg::io {

namespace {

namespace fs = std::filesystem;

std::optional<int> rotation_number(const fs::path& file) {
  const std::string stem = file.stem().string();
  if (file.extension() != ".lcm" || !stem.starts_with("log-")) return std::nullopt;
  int number = 0;
  const char* end = stem.data() + stem.size();
  const auto parsed = std::from_chars(stem.data() + 4, end, number);
  if (parsed.ec != std::errc() || parsed.ptr != end || number < 0) return std::nullopt;
  return number;
}

}  // namespace

std::map<int, fs::path> rotated_log_files(const fs::path& folder) {
  std::map<int, fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (const auto number = rotation_number(entry.path())) files[*number] = entry.path();
  }
  return files;
}

std::vector<fs::path> log_files(const std::vector<fs::path>& paths) {
  std::vector<fs::path> files;
  for (const fs::path& path : paths) {
    if (!fs::exists(path)) throw std::runtime_error(path.string() + ": there is no such file or folder");
    if (!fs::is_directory(path)) {
      files.push_back(path);
      continue;
    }
    const std::size_t before = files.size();
    if (fs::exists(path / "log.lcm")) files.push_back(path / "log.lcm");
    for (const auto& [number, file] : rotated_log_files(path)) files.push_back(file);
    if (files.size() == before) {
      throw std::runtime_error(path.string() +
                               ": no log in this folder; expected log.lcm or log-NNNN.lcm (name a flight recorder's "
                               "fault-*.lcm itself)");
    }
  }
  return files;
}

LogSeries::LogSeries(std::vector<fs::path> files) : files_(std::move(files)) {
  if (files_.empty()) throw std::runtime_error("no log is given");
  reader_.emplace(files_.front());
}

bool LogSeries::next() {
  while (!reader_->next()) {
    cut_short_ = cut_short_ || reader_->cut_short();
    if (at_ + 1 == files_.size()) return false;
    skipped_before_ += reader_->skipped_bytes();
    reader_.emplace(files_[++at_]);
  }
  return true;
}

}  // namespace pmg::io
