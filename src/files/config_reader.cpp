#include "files/config_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string_view>

#include "files/bounded_file.hpp"
#include "files/nearest_name.hpp"

namespace pmg::files {
namespace {

Place place_at(const std::string& file, const YAML::Mark& mark) {
  if (mark.is_null()) return {file};
  return {file, mark.line + 1, mark.column + 1};
}

std::string what_it_is(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Null:
      return "is empty";
    case YAML::NodeType::Sequence:
      return "is a list";
    case YAML::NodeType::Map:
      return "is a mapping";
    default:
      return "is '" + node.Scalar() + "'";
  }
}

/// A whole number in YAML's hexadecimal form, 0x1F.
std::optional<double> hexadecimal(std::string_view text) {
  if (!text.starts_with("0x")) return std::nullopt;
  text.remove_prefix(2);
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Plain scalars only: a quoted "1" is a string.
std::optional<double> plain_number(const YAML::Node& node) {
  if (!node.IsScalar() || node.Tag() == "!") return std::nullopt;
  const std::string& text = node.Scalar();
  if (const auto value = hexadecimal(text)) return value;
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// A letter too few or too many, or two that changed places. Another letter may be another key: kp_factor, kd_factor.
bool is_slip(const std::string& key, const std::string& typed) {
  return key.size() > 3 && edit_distance(key, typed) == 1 &&
         (key.size() != typed.size() || std::ranges::is_permutation(key, typed));
}

}  // namespace

NumberCheck any_number() {
  return {"a finite number", [](double) { return true; }};
}
NumberCheck positive() {
  return {"a number above 0", [](double x) { return x > 0.0; }};
}
NumberCheck non_negative() {
  return {"a number of at least 0", [](double x) { return x >= 0.0; }};
}
NumberCheck in_range(double lower, double upper) {
  return {fmt::format("a number from {} to {}", lower, upper), [=](double x) { return x >= lower && x <= upper; }};
}

ConfigReader ConfigReader::from_file(const std::filesystem::path& file) {
  const std::string text = read_bounded_text(file, kLargestYaml_bytes, "a YAML file");
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.empty()) raise({file.string()}, "", "is empty", "a YAML file");
    if (documents.size() != 1) {
      raise({file.string()}, "", fmt::format("holds {} YAML documents", documents.size()), "one");
    }
    return ConfigReader(documents.front(), file.string(), "");
  } catch (const YAML::Exception& error) {
    std::istringstream lines(text);
    std::string line;
    for (int number = 0; number <= error.mark.line && std::getline(lines, line); ++number) {
    }
    if (line.find('\t') < line.find_first_not_of(" \t"))
      raise(place_at(file.string(), error.mark), "", "a tab indents this line", "blanks");
    std::string wrong = error.msg;  // as in "unknown escape character: "
    while (wrong.ends_with(' ') || wrong.ends_with(':')) wrong.pop_back();
    raise(place_at(file.string(), error.mark), "", wrong, "YAML");
  }
}

ConfigReader::ConfigReader(const YAML::Node& node, const std::string& file, std::string path)
    : path_(std::move(path)), place_(place_at(file, node.Mark())) {
  if (!node.IsMap()) raise(place_, path_, what_it_is(node), "a mapping");
  for (const auto& item : node) {
    const Place key_place = place_of(item.first);
    if (!item.first.IsScalar()) raise(key_place, path_, "has a key that " + what_it_is(item.first), "a name");
    const std::string& key = item.first.Scalar();
    if (!entries_.emplace(key, Entry{item.second, key_place}).second) {
      raise(key_place, this->path(key), "is there twice", "it once");
    }
    order_.push_back(key);
  }
}

Place ConfigReader::place_of(const YAML::Node& node) const { return place_at(place_.file, node.Mark()); }

std::string ConfigReader::path(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }

Place ConfigReader::place(const std::string& key) const {
  const auto found = entries_.find(key);
  if (found == entries_.end()) return place_;
  const Place value = place_of(found->second.value);
  return value.line > 0 ? value : found->second.key_place;
}

void ConfigReader::fail(const std::string& key, const std::string& wrong, const std::string& expected) const {
  raise(place(key), path(key), wrong, expected);
}

const YAML::Node& ConfigReader::child(const std::string& key, const std::string& expected) {
  known_.push_back(key);
  const auto found = entries_.find(key);
  if (found == entries_.end()) {
    for (const auto& [name, entry] : entries_) {
      if (!entry.asked && is_slip(key, name))
        raise(entry.key_place, path(key), fmt::format("is missing, and '{}' stands here", name), expected);
    }
    fail(key, "is missing", expected);
  }
  found->second.asked = true;
  return found->second.value;
}

bool ConfigReader::leave(const std::string& key) {
  known_.push_back(key);
  const auto found = entries_.find(key);
  if (found == entries_.end()) return false;
  found->second.asked = true;
  return true;
}

ConfigReader ConfigReader::map(const std::string& key) {
  const YAML::Node& node = child(key, "a mapping");
  if (!node.IsMap()) fail(key, what_it_is(node), "a mapping");
  return ConfigReader(node, place_.file, path(key));
}

std::vector<ConfigReader> ConfigReader::maps(const std::string& key) {
  const YAML::Node& node = child(key, "a list of mappings");
  if (!node.IsSequence()) fail(key, what_it_is(node), "a list of mappings");
  std::vector<ConfigReader> readers;
  for (const YAML::Node& item : node) {
    readers.push_back(ConfigReader(item, place_.file, fmt::format("{}[{}]", path(key), readers.size())));
  }
  return readers;
}

std::vector<double> ConfigReader::numbers(const std::string& key, std::size_t count, const NumberCheck& check) {
  const std::vector<double> values = required<std::vector<double>>(key, check);
  if (values.size() != count) {
    fail(key, fmt::format("has {} numbers", values.size()), fmt::format("a list of {}", count));
  }
  return values;
}

std::string ConfigReader::one_of(const std::string& key, const std::vector<std::string>& choices) {
  const std::string choice = required<std::string>(key);
  for (const std::string& known : choices) {
    if (choice == known) return choice;
  }
  fail(key, fmt::format("is '{}'; {}", choice, expected_name(choice, choices)), "");
}

void ConfigReader::finish() const {
  for (const std::string& key : order_) {
    const Entry& entry = entries_.at(key);
    if (entry.asked) continue;
    const std::string nearest = nearest_name(key, known_);
    if (!nearest.empty()) raise(entry.key_place, path(key), fmt::format("is unknown; did you mean {}?", nearest), "");
    if (key.find_first_not_of("0123456789") == std::string::npos)  // vx_m_s: 0,3
      raise(entry.key_place, path(key), "is no key but a number", "decimals behind a point; a comma parts two entries");
    raise(entry.key_place, path(key), "is unknown",
          known_.empty() ? "no such key" : fmt::format("nothing besides {}", fmt::join(known_, ", ")));
  }
}

template <>
std::string ConfigReader::describe<double>() {
  return "a number";
}
template <>
std::string ConfigReader::describe<int>() {
  return "a whole number";
}
template <>
std::string ConfigReader::describe<bool>() {
  return "true or false";
}
template <>
std::string ConfigReader::describe<std::string>() {
  return "a string";
}
template <>
std::string ConfigReader::describe<std::vector<double>>() {
  return "a list of numbers";
}
template <>
std::string ConfigReader::describe<std::vector<std::string>>() {
  return "a list of strings";
}

template <>
double ConfigReader::read(const std::string& key, const YAML::Node& node, const NumberCheck& check) const {
  const std::optional<double> value = plain_number(node);
  const Place where = node.Mark().is_null() ? place(key) : place_of(node);
  if (!value) raise(where, path(key), what_it_is(node), check.expected);
  if (!std::isfinite(*value)) raise(where, path(key), what_it_is(node), "a finite number");
  if (!check.holds(*value)) raise(where, path(key), what_it_is(node), check.expected);
  return *value;
}

template <>
int ConfigReader::read(const std::string& key, const YAML::Node& node, const NumberCheck& check) const {
  const double value = read<double>(key, node, check);
  if (value != std::floor(value) || std::abs(value) > 2147483647.0) {
    raise(place_of(node), path(key), what_it_is(node), "a whole number");
  }
  return static_cast<int>(value);
}

template <>
bool ConfigReader::read(const std::string& key, const YAML::Node& node, const NumberCheck&) const {
  const bool plain = node.IsScalar() && node.Tag() != "!";
  if (plain && node.Scalar() == "true") return true;
  if (plain && node.Scalar() == "false") return false;
  fail(key, what_it_is(node), "true or false");
}

template <>
std::string ConfigReader::read(const std::string& key, const YAML::Node& node, const NumberCheck&) const {
  if (!node.IsScalar() || node.Scalar().empty()) fail(key, what_it_is(node), "a string");
  return node.Scalar();
}

template <>
std::vector<double> ConfigReader::read(const std::string& key, const YAML::Node& node, const NumberCheck& check) const {
  if (!node.IsSequence()) fail(key, what_it_is(node), "a list of numbers");
  std::vector<double> values;
  for (const YAML::Node& item : node) values.push_back(read<double>(key, item, check));
  return values;
}

template <>
std::vector<std::string> ConfigReader::read(const std::string& key, const YAML::Node& node,
                                            const NumberCheck& check) const {
  if (!node.IsSequence()) fail(key, what_it_is(node), "a list of strings");
  std::vector<std::string> values;
  for (const YAML::Node& item : node) values.push_back(read<std::string>(key, item, check));
  return values;
}

}  // namespace pmg::files
