#include "files/config_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "refusal.hpp"
#include "temporary_folder.hpp"

namespace pmg::files {
namespace {

using ::testing::HasSubstr;

class Reader : public ::testing::Test {
 protected:
  ConfigReader reader(const std::string& text) const {
    std::ofstream(directory_ / "a.yaml") << text;
    return ConfigReader::from_file(directory_ / "a.yaml");
  }

  /// The message that the action throws, from the file's name on.
  template <typename Action>
  std::string refusal(Action action) const {
    const std::string text = test::refusal_by<ConfigError>(action);
    const std::size_t file = text.find("a.yaml");
    return file == std::string::npos ? text : text.substr(file);
  }

  test::TemporaryFolder folder_;
  std::filesystem::path directory_ = folder_.path();
};

TEST_F(Reader, GivesWhatTheFileSays) {
  ConfigReader r = reader("a: 0.5\nb: -3\nc: true\nd: text\ne: [1, 2.5]\nf: [x, y]\ng: {h: 1}\ni: [{j: 1}, {j: 2}]\n");
  EXPECT_EQ(r.required<double>("a"), 0.5);
  EXPECT_EQ(r.required<int>("b"), -3);
  EXPECT_TRUE(r.required<bool>("c"));
  EXPECT_EQ(r.required<std::string>("d"), "text");
  EXPECT_EQ(r.required<std::vector<double>>("e"), (std::vector<double>{1.0, 2.5}));
  EXPECT_EQ(r.required<std::vector<std::string>>("f"), (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(r.map("g").required<int>("h"), 1);
  EXPECT_EQ(r.maps("i")[1].required<int>("j"), 2);
  EXPECT_EQ(r.optional<double>("k", 7.0), 7.0);
  EXPECT_EQ(r.keys().front(), "a");
  r.finish();
}

TEST_F(Reader, TakesHexadecimalNumbersAndNoOthersThatOnlyLookLikeThem) {
  ConfigReader hex = reader("{identifier: 0x7E, vendor: 0xFFFFFFFF, decimal: 010}");
  EXPECT_EQ(hex.required<int>("identifier"), 126);
  EXPECT_EQ(hex.required<double>("vendor"), 4294967295.0);
  EXPECT_EQ(hex.required<int>("decimal"), 10) << "no octal numbers";
  for (const char* text : {"0x", "0xG", "7Eh", "-0x1", "0x1.8", "0x100000000", "'0x1'"}) {
    EXPECT_THAT(refusal([&] { reader(std::string("a: ") + text).required<int>("a"); }), HasSubstr("a: is '")) << text;
  }
}

TEST_F(Reader, RefusesUnknownKeysAndSaysWhichAreKnown) {
  ConfigReader r = reader("a: 1\n  \nbb: 2\n");
  r.required<double>("a");
  r.optional<double>("c", 0.0);
  EXPECT_EQ(refusal([&] { r.finish(); }), "a.yaml:3:1: bb: is unknown; expected nothing besides a, c");
}

TEST_F(Reader, ADecimalCommaIsSaidToBeOne) {
  EXPECT_THAT(refusal([&] {
                ConfigReader r = reader("{vx_m_s: 0,3}");
                r.required<double>("vx_m_s");
                r.finish();
              }),
              HasSubstr("3: is no key but a number; expected decimals behind a point"));
}

TEST_F(Reader, RefusesMissingKeysWithTheirPath) {
  ConfigReader r = reader("a:\n  b: 1\n");
  ConfigReader nested = r.map("a");
  EXPECT_EQ(refusal([&] { nested.required<double>("c"); }), "a.yaml:2:3: a.c: is missing; expected a number");
}

TEST_F(Reader, AMissingKeysMistypedNameIsShown) {
  ConfigReader r = reader("rate: 3\nkp_factor: 1\ndrvie: {kd: 2}\n");
  EXPECT_EQ(refusal([&] { r.map("drive"); }),
            "a.yaml:3:1: drive: is missing, and 'drvie' stands here; expected a mapping");
  EXPECT_EQ(refusal([&] { r.required<double>("kd_factor"); }), "a.yaml:1:1: kd_factor: is missing; expected a number")
      << "another letter may be another key";
}

TEST_F(Reader, RefusesWrongTypes) {
  ConfigReader r = reader("n: \"1\"\nw: 1.5\nb: yes\ns: [1]\nl: 3\nm: 4\ne:\nx: 12abc\n");
  EXPECT_EQ(refusal([&] { r.required<double>("n"); }), "a.yaml:1:4: n: is '1'; expected a finite number");
  EXPECT_EQ(refusal([&] { r.required<int>("w"); }), "a.yaml:2:4: w: is '1.5'; expected a whole number");
  EXPECT_EQ(refusal([&] { r.required<bool>("b"); }), "a.yaml:3:4: b: is 'yes'; expected true or false");
  EXPECT_EQ(refusal([&] { r.required<std::string>("s"); }), "a.yaml:4:4: s: is a list; expected a string");
  EXPECT_EQ(refusal([&] { r.maps("l"); }), "a.yaml:5:4: l: is '3'; expected a list of mappings");
  EXPECT_EQ(refusal([&] { r.map("m"); }), "a.yaml:6:4: m: is '4'; expected a mapping");
  EXPECT_THAT(refusal([&] { r.required<double>("e"); }), HasSubstr("e: is empty; expected a finite number"));
  EXPECT_EQ(refusal([&] { r.required<double>("x"); }), "a.yaml:8:4: x: is '12abc'; expected a finite number");
}

TEST_F(Reader, RefusesNumbersThatAreNotFiniteOrOutOfRange) {
  ConfigReader r = reader("a: .nan\nb: nan\nc: inf\nd: -1\ne: 1e999\nf: [1, 2, -3]\n");
  for (const std::string key : {"a", "b", "c", "e"}) {
    EXPECT_THAT(refusal([&] { r.required<double>(key); }), HasSubstr(key + ": is ")) << key;
    EXPECT_THAT(refusal([&] { r.required<double>(key); }), HasSubstr("expected a finite number")) << key;
  }
  EXPECT_EQ(refusal([&] { r.required<double>("d", positive()); }), "a.yaml:4:4: d: is '-1'; expected a number above 0");
  EXPECT_THAT(refusal([&] { r.required<double>("d", in_range(0, 2)); }), HasSubstr("expected a number from 0 to 2"));
  EXPECT_EQ(refusal([&] { r.numbers("f", 3, positive()); }), "a.yaml:6:11: f: is '-3'; expected a number above 0");
  EXPECT_EQ(refusal([&] { r.numbers("f", 2); }), "a.yaml:6:4: f: has 3 numbers; expected a list of 2");
}

TEST_F(Reader, RefusesRepeatedKeys) {
  EXPECT_EQ(refusal([&] { reader("a: 1\na: 2\n"); }), "a.yaml:2:1: a: is there twice; expected it once");
}

TEST_F(Reader, RefusesChoicesThatAreNotOnOffer) {
  ConfigReader r = reader("a: red\n");
  EXPECT_EQ(refusal([&] { r.one_of("a", {"blue", "green"}); }), "a.yaml:1:4: a: is 'red'; expected one of blue, green");
}

TEST_F(Reader, RefusesWhatIsNotOneMapping) {
  EXPECT_THAT(refusal([&] { reader("a: [1\nb: 2\n"); }), HasSubstr("a.yaml:2:"));
  EXPECT_THAT(refusal([&] { reader("- 1\n"); }), HasSubstr("is a list; expected a mapping"));
  EXPECT_THAT(refusal([&] { reader(""); }), HasSubstr("a.yaml: "));
  EXPECT_THAT(refusal([&] { reader("a: 1\n---\na: 2\n"); }), HasSubstr("holds 2 YAML documents; expected one"));
}

TEST_F(Reader, ATabAnEmptyFileAndAPictureAreCalledWhatTheyAre) {
  const auto refused = [&](const std::string& text) {
    std::ofstream(directory_ / "x.yaml") << text;
    const std::string words = refusal([&] { ConfigReader::from_file(directory_ / "x.yaml"); });
    return words.substr(words.find("x.yaml"));
  };
  EXPECT_EQ(refused("a:\n  b: 1\n\tc: 2\n"), "x.yaml:3:1: a tab indents this line; expected blanks");
  EXPECT_EQ(refused(""), "x.yaml: is empty; expected a YAML file");
  EXPECT_EQ(refused(std::string("\x89PNG\0\0", 6)), "x.yaml: isn't a text; expected a YAML file");
  EXPECT_EQ(refused("a: \"\\q\"\n"), "x.yaml:1:7: unknown escape character: q; expected YAML");
}

TEST_F(Reader, SaysThatAFileIsMissing) {
  try {
    ConfigReader::from_file(directory_ / "none.yaml");
    FAIL() << "nothing was thrown";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("none.yaml: cannot be read (No such file or directory)"));
  }
}

}  // namespace
}  // namespace pmg::files
