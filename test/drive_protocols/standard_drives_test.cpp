// The pages name every protocol that robot.yaml may name.
#include "drive_protocols/standard_drives.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "folders.hpp"

namespace pmg::drives {
namespace {

/// The page from this text to the next empty line.
std::string paragraph(const std::string& page, const std::string& from) {
  std::ostringstream read;
  read << std::ifstream(test::project_folder() + "/docs/reference/" + page).rdbuf();
  const std::string text = read.str();
  const std::size_t begin = text.find(from);
  return begin == std::string::npos ? "" : text.substr(begin, text.find("\n\n", begin) - begin);
}

TEST(StandardDrives, EachProtocolIsWhereThePagesTellThemAll) {
  for (const std::string& protocol : standard_drives().protocols()) {
    const std::string name = "`" + protocol + "`";
    const auto tells = [&](const std::string& text) { return text.find(name) != std::string::npos; };
    EXPECT_TRUE(tells(paragraph("file-formats.md", "One kind of drive, `drives.NAME`."))) << name;
    EXPECT_TRUE(tells(paragraph("drives.md", "| `protocol` | switching on |"))) << name;
    if (protocol == "mit") continue;  // another word for cubemars
    EXPECT_TRUE(tells(paragraph("drives.md", "| protocol | source of its facts |"))) << name;
    EXPECT_TRUE(tells(paragraph("drives.md", "| protocol | what a node gets |"))) << name;
  }
}

}  // namespace
}  // namespace pmg::drives
