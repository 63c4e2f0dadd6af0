// Strict reading of YAML: every key must be asked for, every value is checked, every error names its place.
#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "files/config_error.hpp"

namespace pmg::files {

/// A condition on a number, besides being finite. `expected` completes "expected ..." in the error.
struct NumberCheck {
  std::string expected;
  std::function<bool(double)> holds;
};
NumberCheck any_number();
NumberCheck positive();
NumberCheck non_negative();
NumberCheck in_range(double lower, double upper);  ///< both ends included

/// One YAML mapping of a file. Ask for its keys, then call finish(): keys that nobody asked for are errors, and so are
/// repeated ones. Every error is a ConfigError that names file, line, column and the key's path
/// ("joints.left_knee.kp_Nm_per_rad").
class ConfigReader {
 public:
  /// Reads the file. Throws ConfigError when it is missing, isn't YAML, or isn't one mapping.
  static ConfigReader from_file(const std::filesystem::path& file);

  /// T: double, int, bool, std::string, std::vector<double>, std::vector<std::string>. The check applies to each
  /// number.
  template <typename T>
  T required(const std::string& key, const NumberCheck& check = any_number()) {
    return read<T>(key, child(key, describe<T>()), check);
  }
  template <typename T>
  T optional(const std::string& key, const T& otherwise, const NumberCheck& check = any_number()) {
    if (has(key)) return required<T>(key, check);
    known_.push_back(key);
    return otherwise;
  }
  /// A list of exactly this many numbers.
  std::vector<double> numbers(const std::string& key, std::size_t count, const NumberCheck& check = any_number());

  ConfigReader map(const std::string& key);                ///< a nested mapping
  std::vector<ConfigReader> maps(const std::string& key);  ///< a list of mappings
  std::string one_of(const std::string& key, const std::vector<std::string>& choices);

  bool has(const std::string& key) const { return entries_.contains(key); }
  /// Another part of the program reads this key, and finds what is wrong with its value. => has(key)
  bool leave(const std::string& key);
  const std::vector<std::string>& keys() const { return order_; }  ///< in the file's order
  Place place() const { return place_; }                           ///< of the mapping itself
  Place place(const std::string& key) const;                       ///< of the key's value, or of the mapping
  std::string path(const std::string& key) const;                  ///< the key's full path

  /// Throws at the key's place.
  [[noreturn]] void fail(const std::string& key, const std::string& wrong, const std::string& expected) const;

  void finish() const;  ///< throws on the first key that was never asked for

 private:
  struct Entry {
    YAML::Node value;
    Place key_place;
    bool asked = false;
  };
  ConfigReader(const YAML::Node& node, const std::string& file, std::string path);

  const YAML::Node& child(const std::string& key, const std::string& expected);
  Place place_of(const YAML::Node& node) const;
  template <typename T>
  T read(const std::string& key, const YAML::Node& node, const NumberCheck& check) const;
  template <typename T>
  static std::string describe();

  std::string path_;
  Place place_;
  std::map<std::string, Entry> entries_;
  std::vector<std::string> order_;
  std::vector<std::string> known_;  ///< every key that was asked for, whether it exists or not
};

// The supported types; any other type doesn't link.
#define PMG_CONFIG_TYPE(...)                         \
  template <>                                        \
  std::string ConfigReader::describe<__VA_ARGS__>(); \
  template <>                                        \
  __VA_ARGS__ ConfigReader::read(const std::string& key, const YAML::Node& node, const NumberCheck& check) const
PMG_CONFIG_TYPE(double);
PMG_CONFIG_TYPE(int);
PMG_CONFIG_TYPE(bool);
PMG_CONFIG_TYPE(std::string);
PMG_CONFIG_TYPE(std::vector<double>);
PMG_CONFIG_TYPE(std::vector<std::string>);
#undef PMG_CONFIG_TYPE

}  // namespace pmg::files
