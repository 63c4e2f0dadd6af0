// What is wrong with a command line, in one line: the program, the word, what was expected.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace pmg::apps {

/// app: after app.parse() has thrown this error. Without a newline at the end. An unknown word comes before whatever
/// else is wrong: a mistyped --out is no missing --out.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error);

}  // namespace pmg::apps
