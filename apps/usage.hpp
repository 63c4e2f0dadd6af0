// One line about a wrong command line: the program, the wrong word, the expected one.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace pmg::apps {

/// app: its parse() has thrown this error. The result has no newline at the end. An unknown word is reported before any
/// other error: a mistyped --out would otherwise be reported as a missing --out.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error);

}  // namespace pmg::apps
