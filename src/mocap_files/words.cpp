#include "mocap_files/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "files/config_error.hpp"

namespace pmg::mocap {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\0' || c == '\v' || c == '\f'; }

}  // namespace

std::string shown_word(std::string_view word) {
  std::string shown;
  for (const char c : word.substr(0, 40)) shown += std::isprint(static_cast<unsigned char>(c)) != 0 ? c : '?';
  return word.size() > 40 ? shown + "..." : shown;
}

bool to_number(std::string_view word, double& value) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() && std::isfinite(value);
}

bool same_word(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

void Words::skip_blanks() {
  for (; at_ < text_.size() && is_blank(text_[at_]); ++at_) line_ += text_[at_] == '\n' ? 1 : 0;
}

bool Words::end() {
  skip_blanks();
  return at_ == text_.size();
}

std::string_view Words::peek() {
  skip_blanks();
  std::size_t stop = at_;
  while (stop < text_.size() && !is_blank(text_[stop])) ++stop;
  return text_.substr(at_, stop - at_);
}

std::string_view Words::next(const std::string& expected) {
  const std::string_view word = peek();
  word_line_ = line_;
  if (word.empty()) fail("the file ends here", expected);
  at_ += word.size();
  return word;
}

void Words::expect(std::string_view word) {
  const std::string_view found = next(std::string(word));
  if (!same_word(found, word)) fail(fmt::format("is '{}'", shown_word(found)), fmt::format("'{}'", word));
}

double Words::number(const std::string& expected) {
  const std::string_view word = next(expected);
  double value = 0.0;
  if (!to_number(word, value)) fail(fmt::format("is '{}'", shown_word(word)), expected);
  return value;
}

long Words::whole(const std::string& expected, long lower, long upper) {
  const std::string_view word = next(expected);
  long value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || value < lower || value > upper) {
    fail(fmt::format("is '{}'", shown_word(word)), fmt::format("{}, {} to {}", expected, lower, upper));
  }
  return value;
}

std::string_view Words::rest_of_line() {
  const std::size_t stop = std::min(text_.find('\n', at_), text_.size());
  std::string_view rest = text_.substr(at_, stop - at_);
  at_ = stop;
  while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
  while (!rest.empty() && is_blank(rest.back())) rest.remove_suffix(1);
  return rest;
}

void Words::fail(const std::string& wrong, const std::string& expected) const {
  files::raise({file_, word_line_}, "", wrong, expected);
}

}  // namespace pmg::mocap
