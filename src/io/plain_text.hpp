// Text from other programs, made harmless for terminals, pages and spreadsheets: the one place that escapes it.
#pragma once

#include <string>
#include <string_view>

namespace pmg::io {

/// Control characters (ESC, newline, ...) and bytes above ASCII as \xNN, backslashes doubled. Printable ASCII stays.
std::string plain_text(std::string_view text);

/// The same as one CSV cell: quoted where it must be, and with ' before a first = + - @, which spreadsheets would take
/// for a formula.
std::string csv_text(std::string_view text);

}  // namespace pmg::io
