// A URDF that is too much is refused in one line, at once, with little memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "files/config_error.hpp"
#include "model/urdf_tree.hpp"
#include "temporary_folder.hpp"

namespace pmg::model {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class UrdfBounds : public testing::Test {
 protected:
  std::string refusal() const {
    try {
      read_urdf(file_);
    } catch (const files::ConfigError& error) {
      return error.what();
    }
    return "accepted";
  }
  std::string refusal_of(const std::string& body) const {
    std::ofstream(file_) << "<robot name=\"r\">\n" << body << "</robot>\n";
    return refusal();
  }

  test::TemporaryFolder folder_;
  fs::path file_ = folder_.file("robot.urdf");
};

std::string link(const std::string& name) {
  return "<link name=\"" + name +
         "\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" "
         "izz=\"1\"/></inertial></link>\n";
}

std::string joint(const std::string& parent, const std::string& child) {
  return "<joint name=\"" + parent + "_" + child + "\" type=\"fixed\"><parent link=\"" + parent + "\"/><child link=\"" +
         child + "\"/></joint>\n";
}

TEST_F(UrdfBounds, AFileAboveItsBoundIsNotRead) {
  std::ofstream(file_) << "";
  fs::resize_file(file_, std::uintmax_t{1} << 34);  // 16 GiB that the disk doesn't hold
  EXPECT_THAT(refusal(), HasSubstr("has 1.64e+04 MiB; expected a URDF file of 4 MiB at most"));
}

TEST_F(UrdfBounds, ARobotOfTenThousandLinksIsRefusedAtItsFirstLinkTooMany) {
  std::string chain = link("l0"), flat = link("l0");
  for (int k = 1; k < 10'000; ++k) {
    const std::string name = "l" + std::to_string(k);
    chain += link(name) + joint("l" + std::to_string(k - 1), name);
    flat += link(name) + joint("l0", name);
  }
  for (const std::string& robot : {chain, flat})
    EXPECT_THAT(refusal_of(robot), HasSubstr("link: is number 257; expected 256"));
}

TEST_F(UrdfBounds, XmlThatIsTooDeepIsRefused) {
  std::string deep;
  for (int k = 0; k < 100'000; ++k) deep += "<a>";
  EXPECT_THAT(refusal_of(deep), HasSubstr("elements deep; expected 32 at most"));
  EXPECT_THAT(refusal_of("<!-- " + deep + " -->" + link("l0")), HasSubstr("accepted")) << "comments nest nothing";
  EXPECT_THAT(refusal_of("<a><![CDATA[" + deep + "]]></a>" + link("l0")), HasSubstr("accepted")) << "nor does raw text";
}

std::string exchanged(std::string text, const std::string& what, const std::string& instead) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += instead.size()) {
    text.replace(at, what.size(), instead);
  }
  return text;
}

TEST_F(UrdfBounds, HoldHoweverTheXmlIsWritten) {
  std::string robot = link("l0");
  for (int k = 1; k < 300; ++k) {
    const std::string name = "l" + std::to_string(k);
    robot += link(name) + joint("l" + std::to_string(k - 1), name);
  }
  for (const char* begin : {"<link\t", "<link\n", "<link\r\n  ", "< link "}) {
    EXPECT_THAT(refusal_of(exchanged(robot, "<link ", begin)), HasSubstr("link: is number 257; expected 256"));
  }
  std::string quoted, closed;
  for (int k = 0; k < 40; ++k) {
    quoted += "<a b=\"/>\" c='/>'>";
    closed += "<a><![CDATA[</a>]]>";
  }
  EXPECT_THAT(refusal_of(quoted), HasSubstr("is 33 elements deep; expected 32 at most"));
  EXPECT_THAT(refusal_of(closed), HasSubstr("is 33 elements deep; expected 32 at most"));
  EXPECT_THAT(refusal_of("<link name='/>'><a b=\">"), testing::Not(HasSubstr("accepted"))) << "no end";
}

TEST_F(UrdfBounds, LinksInACycleOfTheirOwnAreNamed) {
  EXPECT_EQ(refusal_of(link("root") + link("a") + joint("root", "a")), "accepted");
  EXPECT_THAT(refusal_of(link("root") + link("a") + link("b") + joint("a", "b") + joint("b", "a")),
              HasSubstr("is not connected to the root link; expected a chain of joints from root"));
}

}  // namespace
}  // namespace pmg::model
