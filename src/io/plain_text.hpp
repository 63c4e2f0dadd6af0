// Text from other programs, made harmless for terminals, pages and spreadsheets: the one place that escapes it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace pmg::io {

/// Letters of well-formed UTF-8 stay. The bytes of all else become \xNN: control characters (ESC, newline, ...),
/// letters without width, those that turn the direction of writing, broken UTF-8. A backslash is doubled, so apply this
/// once.
std::string plain_text(std::string_view text);

/// Lines of at most `width` bytes, broken between words where a word isn't longer itself; all but the first begin with
/// `indent` spaces. At least one line.
std::vector<std::string> wrapped(std::string_view text, std::size_t width, std::size_t indent);

/// The same as one CSV cell: quoted where it must be, and with ' before a first = + - @, which spreadsheets would take
/// for a formula.
std::string csv_text(std::string_view text);

}  // namespace pmg::io
