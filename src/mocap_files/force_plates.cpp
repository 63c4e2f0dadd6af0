#include "mocap_files/force_plates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "files/bounded_file.hpp"
#include "mocap_files/motion.hpp"
#include "mocap_files/words.hpp"

namespace pmg::mocap {
namespace {

constexpr const char* kHeader = "an OpenSim table: lines of a header, `endheader`, names of columns, numbers";

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> names;
  Words words("", line);
  while (!words.end()) names.emplace_back(words.next("a name"));
  return names;
}

std::size_t column(const Words& words, const std::vector<std::string>& names, std::string_view wanted) {
  const auto found = std::ranges::find_if(names, [&](const std::string& name) { return same_word(name, wanted); });
  if (found == names.end())
    words.fail(fmt::format("has no column {}", wanted), "time, ground_force_l_vy, ground_force_r_vy");
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace

ForcePlates read_force_plates(const std::filesystem::path& file) {
  const std::string text = files::read_bounded_text(file, kLargestMotion_bytes, "a table of force plates");
  Words words(file.string(), text);
  while (!same_word(words.next(kHeader), "endheader")) words.rest_of_line();
  if (words.end()) words.fail("the file ends here", kHeader);
  // The first name is taken, because rest_of_line begins behind the last word.
  const std::string first(words.next(kHeader));
  std::vector<std::string> names = split(words.rest_of_line());
  names.insert(names.begin(), first);
  const std::size_t time = column(words, names, "time");
  const std::array<std::size_t, 2> force = {column(words, names, "ground_force_l_vy"),
                                            column(words, names, "ground_force_r_vy")};
  ForcePlates plates;
  std::array<bool, 2> stood{};
  std::vector<double> row(names.size());
  bool begun = false;
  int line = words.line();
  while (!words.end()) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      row[i] = words.number("a number for each column");
      // Only a row's first number is on another line than the one before it.
      if ((words.line() == line) == (i == 0))
        words.fail(fmt::format("a row has not {} numbers", row.size()), "a number for each column");
      line = words.line();
    }
    const double time_s = row[time];
    if (begun && time_s <= plates.to_s)
      words.fail(fmt::format("time {} doesn't increase", time_s), "rows in the order of time");
    if (!begun) plates.from_s = time_s;
    plates.to_s = time_s;
    for (std::size_t side = 0; side < 2; ++side) {
      const bool stands = row[force[side]] > kPlateContact_N;
      std::vector<PlateContact>& contacts = plates.contacts[side];
      if (stands && !stood[side]) contacts.push_back({begun ? std::optional(time_s) : std::nullopt, std::nullopt});
      if (!stands && stood[side]) contacts.back().off_s = time_s;
      stood[side] = stands;
    }
    begun = true;
  }
  if (!begun) words.fail("has no rows", kHeader);
  return plates;
}

}  // namespace pmg::mocap
