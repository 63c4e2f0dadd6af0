// A copy of a directory that a test may change; it is removed with the object.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace pmg::model {

class TemporaryCopy {
 public:
  explicit TemporaryCopy(const std::filesystem::path& source) {
    std::string pattern = (std::filesystem::temp_directory_path() / "pmg_test_XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary directory");
    directory_ = pattern;
    std::filesystem::copy(source, directory_, std::filesystem::copy_options::recursive);
  }
  ~TemporaryCopy() { std::filesystem::remove_all(directory_); }
  TemporaryCopy(const TemporaryCopy&) = delete;
  TemporaryCopy& operator=(const TemporaryCopy&) = delete;

  const std::filesystem::path& directory() const { return directory_; }
  std::filesystem::path file(const std::string& name) const { return directory_ / name; }

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
  std::filesystem::path directory_;
};

}  // namespace pmg::model
