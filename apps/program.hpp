// How every program here begins and ends: command line, --version, interruption, one line for whatever is wrong.
#pragma once

#include <CLI/CLI.hpp>
#include <csignal>
#include <functional>
#include <initializer_list>
#include <string>

namespace pmg::apps {

inline volatile std::sig_atomic_t interrupt_requested = 0;

/// From now on these signals only set interrupt_requested. SIGHUP does the same unless it is ignored (nohup). A program
/// that is not done a second later says on stderr what it is doing, and that the signal once more ends it at once.
/// finishing: as in "closing the film"; null for a program that is done in an instant or that nothing may cut short (a
/// terminal to be restored): it says nothing, and more signals change nothing.
void notice(std::initializer_list<int> signals, const char* finishing = "writing what was done until now");

/// Adds --version, parses, then runs the body, whose exit code it returns; 0 after --help and --version, 2 and a line
/// on stderr when the command line is wrong or the body throws. Until the body calls notice(), SIGINT, SIGTERM and
/// SIGHUP end the program at once with 130: there is nothing to keep. bundle: what the program would run on as it was
/// called (model::Bundle), told by --version when --robot is given; may be empty and may throw.
int run_program(CLI::App& app, int argc, char** argv, const std::function<int()>& body,
                const std::function<std::string()>& bundle = {});

}  // namespace pmg::apps
