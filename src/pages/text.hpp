// Text for pages: nothing that a file or a message is called may become markup.
#pragma once

#include <string>
#include <string_view>

namespace pmg::pages {

/// & < > " ' as entities of HTML and XML: for text and for attributes in quotes.
std::string escape_markup(std::string_view text);

/// JSON that may stand inside a script element: no "<", so no end tag and no comment.
std::string escape_script(std::string json);

/// A number for people: four significant digits (integers below ten million whole), no exponent where a few zeros do;
/// "-" when it isn't finite.
std::string number(double value);

}  // namespace pmg::pages
