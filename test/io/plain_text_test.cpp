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

TEST(PlainText, NoCellIsAFormula) {
  for (const char* formula : {"=1+1", "+1", "-1", "@sum"}) EXPECT_EQ(csv_text(formula), std::string("'") + formula);
  EXPECT_EQ(csv_text("=a,\"b\""), "\"'=a,\"\"b\"\"\"");
  EXPECT_EQ(csv_text("joint"), "joint");
}

}  // namespace
}  // namespace pmg::io
