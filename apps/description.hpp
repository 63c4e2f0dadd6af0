// A command line as data: man pages and shell completions are made of it (cmake/manuals.py).
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace pmg::apps {

/// JSON: name, description, footer, options (names, type, description, default, required, many, values), positionals
/// (the same) and commands (each as the program itself).
std::string description(const CLI::App& app);

}  // namespace pmg::apps
