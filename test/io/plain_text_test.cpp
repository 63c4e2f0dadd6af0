// Text of other programs does no harm on a terminal or in a spreadsheet.
#include "io/plain_text.hpp"

#include <gtest/gtest.h>

#include <string>

namespace pmg::io {
namespace {

TEST(PlainText, EscapesEveryByteThatATerminalActsOn) {
  EXPECT_EQ(plain_text("operator-7 (left)"), "operator-7 (left)");
  EXPECT_EQ(plain_text("\x1b[2Jgone"), "\\x1b[2Jgone");
  EXPECT_EQ(plain_text("two\nlines\r"), "two\\x0alines\\x0d");
  EXPECT_EQ(plain_text("\\x1b"), "\\\\x1b") << "what looks escaped is told apart";
  for (int byte = 0; byte < 256; ++byte) {
    for (const char letter : plain_text(std::string(1, static_cast<char>(byte)))) {
      EXPECT_TRUE(letter >= 0x20 && letter < 0x7f) << byte;
    }
  }
}

TEST(PlainText, LettersOfEveryLanguageStayAndNothingUnseen) {
  for (const char* name : {"J\u00fcrgen", "\u85e4\u7530", "\u0410\u043d\u043d\u0430", "\U0001f916"}) {
    EXPECT_EQ(plain_text(name), name);
  }
  EXPECT_EQ(plain_text("\u009b2J"), "\\xc2\\x9b2J") << "the ESC [ of 8-bit terminals";
  EXPECT_EQ(plain_text("a\u202eb"), "a\\xe2\\x80\\xaeb") << "text from right to left";
  EXPECT_EQ(plain_text("\u200b\u2028"), "\\xe2\\x80\\x8b\\xe2\\x80\\xa8") << "no width, a new line";
  EXPECT_EQ(plain_text("\xc0\x9b"), "\\xc0\\x9b") << "ESC in two bytes";
  EXPECT_EQ(plain_text("\xe0\x80\x9b"), "\\xe0\\x80\\x9b") << "in three";
  EXPECT_EQ(plain_text("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "half a pair";
  EXPECT_EQ(plain_text("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond the last letter";
  EXPECT_EQ(plain_text("\xe2\x82"), "\\xe2\\x82") << "cut short";
}

TEST(PlainText, LinesAreBrokenBetweenWords) {
  using Lines = std::vector<std::string>;
  EXPECT_EQ(wrapped("", 5, 2), Lines{""});
  EXPECT_EQ(wrapped("a bc", 4, 2), Lines{"a bc"});
  EXPECT_EQ(wrapped("one two three", 7, 2), (Lines{"one two", "  three"}));
  EXPECT_EQ(wrapped("one  two", 5, 2), (Lines{"one ", "  two"}));
  EXPECT_EQ(wrapped("longer than it", 4, 1), (Lines{"longer", " than", " it"})) << "no word is broken";
}

TEST(PlainText, NoCellIsAFormula) {
  for (const char* formula : {"=1+1", "+1", "-1", "@sum"}) EXPECT_EQ(csv_text(formula), std::string("'") + formula);
  EXPECT_EQ(csv_text("=a,\"b\""), "\"'=a,\"\"b\"\"\"");
  EXPECT_EQ(csv_text("joint"), "joint");
}

}  // namespace
}  // namespace pmg::io
