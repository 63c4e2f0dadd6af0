// A table for a terminal.
#pragma once

#include <string>
#include <vector>

#include "pages/pictures.hpp"

namespace pmg::pages {

/// Header and rows in columns, two spaces apart: as wide as their widest cell, numbers to the right. A header that is
/// wider breaks between its words.
std::vector<std::string> lines_of(const Table& table);

}  // namespace pmg::pages
