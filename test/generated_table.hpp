// A table of a page that the code gives. PMG_WRITE_RECORDS=1 writes it anew.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "folders.hpp"

namespace pmg::test {

/// Expects these rows below the table's header in a page of docs/.
inline void expect_table(const std::string& page, const std::string& header, const std::string& rows) {
  const std::string file = project_folder() + "/docs/" + page;
  std::ostringstream read;
  read << std::ifstream(file).rdbuf();
  std::string text = read.str();
  const std::size_t head = text.find("\n" + header + "\n");
  ASSERT_NE(head, std::string::npos) << page << " lacks " << header;
  const std::size_t from = text.find('\n', text.find("|---", head)) + 1, to = text.find("\n\n", from) + 1;
  if (std::getenv("PMG_WRITE_RECORDS") != nullptr)
    std::ofstream(file) << text.replace(from, to - from, rows);
  else
    EXPECT_EQ(text.substr(from, to - from), rows) << page;
}

}  // namespace pmg::test
