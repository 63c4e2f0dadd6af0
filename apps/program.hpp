// How every program here begins and ends: command line, interruption, one line for whatever is wrong.
#pragma once

#include <CLI/CLI.hpp>
#include <csignal>
#include <exception>
#include <initializer_list>
#include <iostream>

namespace pmg::apps {

inline volatile std::sig_atomic_t interrupt_requested = 0;

/// From now on these signals only set interrupt_requested.
inline void notice(std::initializer_list<int> signals) {
  for (const int signal : signals) {
    std::signal(signal, [](int /*signal*/) { interrupt_requested = 1; });
  }
}

/// Parses, then runs the body, whose exit code it returns; 0 after --help, 2 and a line on stderr when the command line
/// is wrong or the body throws.
template <typename Body>
int run_program(CLI::App& app, int argc, char** argv, Body&& body) {
  constexpr int kBadInput = 2;
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadInput;
  }
  try {
    return body();
  } catch (const std::exception& error) {
    std::cerr << app.get_name() << ": " << error.what() << '\n';
    return kBadInput;
  }
}

}  // namespace pmg::apps
