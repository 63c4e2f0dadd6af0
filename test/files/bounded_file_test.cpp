// Files that are too much are refused in one line, at once, with little memory.
#include "files/bounded_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <utility>

#include "files/config_error.hpp"
#include "files/config_reader.hpp"
#include "files/number_table.hpp"

namespace pmg::files {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

class BoundedFile : public testing::Test {
 protected:
  BoundedFile() { fs::create_directories(folder_); }
  ~BoundedFile() override { fs::remove_all(folder_); }

  fs::path file(const std::string& text) const {
    std::ofstream(folder_ / "file") << text;
    return folder_ / "file";
  }
  static std::string refusal(const std::function<void()>& read) {
    try {
      read();
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "accepted";
  }

  fs::path folder_ = fs::temp_directory_path() / ("pmg_bounded_file_" + std::to_string(getpid()));
};

TEST_F(BoundedFile, WhatIsNoRegularFileIsNamed) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  const auto read = [](const fs::path& path) { return refusal([&] { read_bounded_text(path, 100, "a YAML file"); }); };
  EXPECT_EQ(read("/dev/zero"), "/dev/zero: is a device; expected a YAML file");
  EXPECT_THAT(read(folder_ / "pipe"), HasSubstr("is a pipe; expected a YAML file")) << "without waiting for a writer";
  EXPECT_THAT(read(folder_), HasSubstr("is a folder; expected a YAML file"));
  EXPECT_THAT(read(folder_ / "missing"), HasSubstr("No such file"));
}

TEST_F(BoundedFile, AFileAboveItsBoundIsNotRead) {
  const fs::path sparse = folder_ / "sparse";
  std::ofstream(sparse) << "";
  fs::resize_file(sparse, std::uintmax_t{1} << 34);  // 16 GiB that the disk doesn't hold
  for (const auto& [read, bound] : {std::pair{std::function<void()>([&] { ConfigReader::from_file(sparse); }), "1 MiB"},
                                    {[&] { read_number_table(sparse, {"a"}, "a"); }, "64 MiB"}}) {
    EXPECT_THAT(refusal(read),
                AllOf(HasSubstr("has 1.64e+04 MiB; expected"), HasSubstr(std::string(" of ") + bound + " at most")));
  }
  const fs::path good = file("name: 7\n");
  EXPECT_EQ(read_bounded_text(good, 8, "a YAML file"), "name: 7\n");
  EXPECT_THAT(refusal([&] { read_bounded_text(good, 7, "a YAML file"); }), HasSubstr("at most"));
}

}  // namespace
}  // namespace pmg::files
