// Begin and end of every program: command line, --version, interruption, one line per error.
#pragma once

#include <CLI/CLI.hpp>
#include <csignal>
#include <functional>
#include <initializer_list>
#include <string>

namespace pmg::apps {

inline volatile std::sig_atomic_t interrupt_requested = 0;

/// From now on these signals only set interrupt_requested. So does SIGHUP unless it is ignored (nohup). If the program
/// still runs a second later, stderr names its work, and a second signal ends it at once. finishing: that work, as in
/// "closing the film". Null for a program that ends in an instant or must not be cut short (a terminal to restore): it
/// prints nothing, and further signals have no effect.
void notice(std::initializer_list<int> signals, const char* finishing = "writing what was done until now");

/// Adds --version, parses, runs the body and returns its exit code; 0 after --help and --version; 2 and one line on
/// stderr if the command line is wrong or the body throws. Until the body calls notice(), SIGINT, SIGTERM and SIGHUP
/// end the program at once with 130: there is nothing to keep. bundle: text of the files that the program would run on
/// (model::Bundle), printed by --version if --robot is given; may be empty and may throw.
int run_program(CLI::App& app, int argc, char** argv, const std::function<int()>& body,
                const std::function<std::string()>& bundle = {});

/// How to type another program of the same folder: "build/release/bin/NAME" where this one was typed so, NAME where the
/// shell found it. Once run_program has begun.
std::string typed_beside(const std::string& name);

/// One word of a shell's command, quoted where it must be.
std::string typed_word(const std::string& text);

}  // namespace pmg::apps
