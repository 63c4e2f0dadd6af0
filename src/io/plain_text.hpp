// Text from other programs, made harmless for terminals, pages and spreadsheets: the one place that escapes it.
#pragma once

#include <string>
#include <string_view>

namespace pmg::io {

/// Letters of well-formed UTF-8 stay. The bytes of all else become \xNN: control characters (ESC, newline, ...),
/// letters without width, those that turn the direction of writing, broken UTF-8. A backslash is doubled, so apply this
/// once.
std::string plain_text(std::string_view text);

/// The same as one CSV cell: quoted where it must be, and with ' before a first = + - @, which spreadsheets would take
/// for a formula.
std::string csv_text(std::string_view text);

}  // namespace pmg::io
