// One line about a wrong command line: the program, the wrong word, the expected one.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace pmg::apps {

/// app: its parse() has thrown this error. The result has no newline at the end. An unknown word is reported before any
/// other error: a mistyped --out would otherwise be reported as a missing --out.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error);

/// The same line for a value that CLI11 misreads and may be content with: an option in the place of another one's
/// value, as in "--out --json", and a number below 0 for a seed, which would become a huge one. Empty: none.
std::string misread_value(const CLI::App& app);

}  // namespace pmg::apps
