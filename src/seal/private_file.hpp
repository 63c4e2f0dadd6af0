// Files that their owner alone can read: keys, and whatever else gives somebody a right.
#pragma once

#include <filesystem>
#include <string>

#include "seal/authentication.hpp"

namespace pmg::seal {

/// All of these throw std::runtime_error with one line: file, fault, expectation.

/// The whole text, of at most 4096 bytes. Throws if the file is another user's or if others may read or write it.
std::string read_private_file(const std::filesystem::path& file);
/// Never over another file, and never half a file under this name: a running program may read it at any time.
void write_private_file(const std::filesystem::path& file, const std::string& text);
/// A folder that is made is its owner's alone; one that is there stays as it is.
void make_private_folder(const std::filesystem::path& folder);
[[noreturn]] void fail_of_key(const std::filesystem::path& file, const std::string& what);

/// XDG_CONFIG_HOME or ~/.config, with pmg.
std::filesystem::path config_folder();

std::string hex(Bytes bytes);  ///< lower-case digits

}  // namespace pmg::seal
