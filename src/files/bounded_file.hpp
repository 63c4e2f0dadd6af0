// Files that a user names, opened with a bound: a device, a pipe or a giant is one line, not an hour or all memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace pmg::files {

/// The largest files that are read, by kind [bytes]. Each is ten times the largest that the project knows, or more.
inline constexpr std::uint64_t kLargestYaml_bytes = 1 << 20, kLargestUrdf_bytes = 4 << 20,
                               kLargestTable_bytes = 64 << 20, kLargestPolicy_bytes = 32 << 20;

/// Throws ConfigError unless it is a regular file of this size at most that can be opened. expected: what was expected,
/// as "a YAML file". Opening never waits for a pipe's other end.
void expect_bounded_file(const std::filesystem::path& file, std::uint64_t largest_bytes, const std::string& expected);

/// The whole file. Throws as expect_bounded_file does.
std::string read_bounded_bytes(const std::filesystem::path& file, std::uint64_t largest_bytes,
                               const std::string& expected);

/// The same of a text: throws for a file that is none (a picture, a program), too.
std::string read_bounded_text(const std::filesystem::path& file, std::uint64_t largest_bytes,
                              const std::string& expected);

}  // namespace pmg::files
