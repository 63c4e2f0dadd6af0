// A copy of a directory that a test may change; it is removed with the object.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "temporary_folder.hpp"

namespace pmg::model {

class TemporaryCopy {
 public:
  explicit TemporaryCopy(const std::filesystem::path& source) {
    std::filesystem::copy(source, folder_.path(), std::filesystem::copy_options::recursive);
  }

  const std::filesystem::path& directory() const { return folder_.path(); }
  std::filesystem::path file(const std::string& name) const { return folder_.file(name); }

  std::string read(const std::string& name) const {
    std::ifstream stream(file(name));
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(file(name)) << text; }

  /// Number of the first line with this text, from 1; without one the test fails.
  int line_of(const std::string& name, const std::string& text) const {
    const std::string all = read(name);
    const std::size_t at = all.find(text);
    EXPECT_NE(at, std::string::npos) << name << " has no '" << text << "'";
    if (at == std::string::npos) return 0;
    return static_cast<int>(std::count(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(at), '\n')) + 1;
  }

  /// Replaces the first occurrence and returns its line.
  int replace(const std::string& name, const std::string& old_text, const std::string& new_text) const {
    const int line = line_of(name, old_text);
    std::string all = read(name);
    if (line > 0) write(name, all.replace(all.find(old_text), old_text.size(), new_text));
    return line;
  }

 private:
  test::TemporaryFolder folder_;
};

}  // namespace pmg::model
