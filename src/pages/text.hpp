// Text for pages and other markup: no name from a file or a message may become markup.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pages/pictures.hpp"

namespace pmg::pages {

/// & < > " ' as entities of HTML and XML, for text and for attributes in quotes.
std::string escape_markup(std::string_view text);

/// JSON for a script element: without "<", so without an end tag or a comment.
std::string escape_script(std::string json);

/// A number for people: four significant digits (integers below ten million in full), an exponent only for very small
/// and very large ones; "-" if the number isn't finite.
std::string number(double value);

/// True for a byte that begins a character in UTF-8.
bool begins_character(char byte);

/// The table for a console: columns aligned, the first one at its left end; a header's unit, " [m/s]", stands below it.
/// Its last line is empty.
std::vector<std::string> console_lines(const Table& table);

}  // namespace pmg::pages
