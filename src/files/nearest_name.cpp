#include "files/nearest_name.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <system_error>

namespace pmg::files {

namespace {

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

bool same(char a, char b) { return lower(a) == lower(b); }

/// ("Knee_left") => {"knee", "left"}
std::vector<std::string> parts(std::string_view name) {
  std::vector<std::string> found(1);
  for (const char letter : name) {
    if (letter == '_' || letter == '-')
      found.emplace_back();
    else
      found.back() += lower(letter);
  }
  std::ranges::sort(found);
  return found;
}

/// ("knee", names) => {"left_knee", "right_knee"}: those that have it as a word or as words between others; none if
/// these are more than four, or if it has less than three letters.
std::vector<std::string> names_with(std::string_view word, const std::vector<std::string>& names) {
  constexpr std::size_t kShortest = 3, kMost = 4;
  const auto apart = [](const std::string& name, std::size_t place) {
    return place >= name.size() || std::isalnum(static_cast<unsigned char>(name[place])) == 0;
  };
  std::vector<std::string> found;
  for (const std::string& name : names) {
    const auto begin = std::search(name.begin(), name.end(), word.begin(), word.end(), same);
    const auto place = static_cast<std::size_t>(begin - name.begin());
    if (begin != name.end() && (place == 0 || apart(name, place - 1)) && apart(name, place + word.size()))
      found.push_back(name);
  }
  return word.size() < kShortest || found.size() > kMost ? std::vector<std::string>{} : found;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Row i: the distances between the first i letters of a and every beginning of b.
  std::vector<std::size_t> before_last, last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same(a[i - 1], b[j - 1]) ? 0 : 1)});
      const bool swapped = i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]);
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    before_last = last;
    last = row;
  }
  return last[b.size()];
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& names) {
  if (name.empty()) return "";
  std::string nearest;
  std::size_t least = std::max<std::size_t>(1, name.size() / 3) + 1;
  for (const std::string& known : names) {
    const std::size_t distance = edit_distance(name, known);
    if (distance < least && distance < known.size()) {
      least = distance;
      nearest = known;
    }
  }
  if (!nearest.empty()) return nearest;
  const auto turned = std::ranges::find(names, parts(name), parts);
  if (turned != names.end()) return *turned;
  const auto begins = [&](const std::string& known) {
    return known.size() > name.size() && std::equal(name.begin(), name.end(), known.begin(), same);
  };
  return std::count_if(names.begin(), names.end(), begins) == 1 ? *std::find_if(names.begin(), names.end(), begins)
                                                                : "";
}

std::filesystem::path nearest_file(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().extension() == file.extension()) names.push_back(entry->path().stem().string());
  }
  std::ranges::sort(names);  // directory iterators have no order
  const std::string nearest = nearest_name(file.stem().string(), names);
  return nearest.empty() ? "" : file.parent_path() / (nearest + file.extension().string());
}

std::string expected_name(std::string_view name, const std::vector<std::string>& names) {
  if (const std::string nearest = nearest_name(name, names); !nearest.empty()) {
    return fmt::format("did you mean {}?", nearest);
  }
  if (const auto with = names_with(name, names); !with.empty())
    return fmt::format("did you mean {}?", fmt::join(with, " or "));
  if (names.empty()) return "none is known here";
  if (names.size() == 1) return "expected " + names.front();
  return fmt::format("expected one of {}", fmt::join(names, ", "));
}

}  // namespace pmg::files
