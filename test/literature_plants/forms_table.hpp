// Every form with its source, as docs/explanation/hidden-plants.md has it.
#pragma once

#include <string>

namespace pmg::literature {

/// A Markdown table: a row an effect of the catalogue, then a row a thing off the catalogue.
std::string forms_table();

}  // namespace pmg::literature
