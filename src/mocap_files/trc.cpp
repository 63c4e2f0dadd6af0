#include <fmt/format.h>

#include <limits>

#include "files/config_error.hpp"
#include "mocap_files/motion.hpp"
#include "mocap_files/unit_name.hpp"
#include "mocap_files/words.hpp"

namespace pmg::mocap {
namespace {

/// Lines and their cells between tabs, without blanks around them.
class TrcLines {
 public:
  TrcLines(std::string file, std::string_view text) : file_(std::move(file)), rest_(text) {}

  bool next(std::vector<std::string_view>& cells) {
    if (rest_.empty()) return false;
    ++line_;
    const std::size_t stop = std::min(rest_.find('\n'), rest_.size());
    std::string_view line = rest_.substr(0, stop);
    rest_.remove_prefix(std::min(stop + 1, rest_.size()));
    cells.clear();
    for (std::size_t at = 0; at <= line.size();) {
      const std::size_t tab = std::min(line.find('\t', at), line.size());
      std::string_view cell = line.substr(at, tab - at);
      while (!cell.empty() && (cell.front() == ' ')) cell.remove_prefix(1);
      while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\r')) cell.remove_suffix(1);
      cells.push_back(cell);
      at = tab + 1;
    }
    return true;
  }

  void require(std::vector<std::string_view>& cells, const std::string& expected) {
    if (next(cells)) return;
    ++line_;
    fail("the file ends here", expected);
  }
  std::string place() const { return fmt::format("{}:{}", file_, line_); }
  [[noreturn]] void fail(const std::string& wrong, const std::string& expected) const {
    files::raise({file_, line_}, "", wrong, expected);
  }
  double number(std::string_view cell, const std::string& expected) const {
    double value = 0.0;
    if (!to_number(cell, value)) fail(fmt::format("is '{}'", shown_word(cell)), expected);
    return value;
  }

 private:
  std::string file_;
  std::string_view rest_;
  int line_ = 0;
};

/// Lines 2 and 3: keys, and their values below. Some programs write two tabs between values, so empty cells don't
/// count.
void trc_header(const TrcLines& lines, std::vector<std::string_view> keys, std::vector<std::string_view> values,
                Motion& motion) {
  std::erase(keys, std::string_view());
  std::erase(values, std::string_view());
  for (std::size_t i = 0; i < keys.size() && i < values.size(); ++i) {
    if (same_word(keys[i], "DataRate")) motion.rate_hz = lines.number(values[i], "DataRate in Hz");
    if (same_word(keys[i], "Units")) {
      motion.unit_name = values[i];
      motion.unit_m = unit_of_name(values[i]);
    }
  }
  if (!motion.rate_hz || !(*motion.rate_hz > 0.1 && *motion.rate_hz < 1e5)) {
    lines.fail("DataRate is missing or out of range", "DataRate of 0.1 to 1e5 Hz in lines 2 and 3");
  }
}

}  // namespace

Motion parse_trc(const std::string& file, const std::string& text) {
  TrcLines lines(file, text);
  Motion motion;
  motion.format = "TRC";
  motion.markers = true;
  std::vector<std::string_view> cells, keys;
  lines.require(cells, "PathFileType");
  if (!same_word(cells[0].substr(0, 12), "PathFileType")) lines.fail("is no TRC file", "PathFileType in line 1");
  lines.require(keys, "a line of keys: DataRate, Units, ...");
  lines.require(cells, "a line of values");
  trc_header(lines, keys, cells, motion);
  lines.require(cells, "Frame#, Time, names of the markers");
  if (cells.size() < 3 || !same_word(cells[0], "Frame#"))
    lines.fail("is no line of markers' names", "Frame#, Time, names of the markers");
  std::vector<std::size_t> columns;  // of each marker's x
  for (std::size_t c = 2; c < cells.size(); ++c) {
    if (cells[c].empty()) continue;
    columns.push_back(c);
    motion.points.push_back({std::string(cells[c]), -1, {}, {}});
    expect_bounded_samples(lines.place(), 1, motion.points.size());
  }
  if (columns.empty()) lines.fail("names no markers", "names of the markers, one in three columns");
  lines.require(cells, "X1, Y1, Z1, ...");
  while (lines.next(cells)) {
    if (cells.size() < 2 || (cells[0].empty() && cells[1].empty())) continue;  // an empty line
    lines.number(cells[0], "the frame's number");
    expect_bounded_samples(lines.place(), motion.frames + 1, motion.points.size());
    for (std::size_t m = 0; m < columns.size(); ++m) {
      Eigen::Vector3d at = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
      const std::size_t c = columns[m];
      const bool seen = c + 2 < cells.size() && !cells[c].empty() && !cells[c + 1].empty() && !cells[c + 2].empty();
      for (std::size_t i = 0; seen && i < 3; ++i) {
        if (same_word(cells[c + i], "nan")) break;
        at[static_cast<int>(i)] =
            lines.number(cells[c + i], fmt::format("a coordinate of {}", shown_word(motion.points[m].name)));
      }
      motion.points[m].position.push_back(at);
    }
    ++motion.frames;
  }
  if (motion.frames == 0) lines.fail("has no frames", "a row for each frame after line 5");
  return motion;
}

}  // namespace pmg::mocap
