#include "program.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>

#include "description.hpp"
#include "io/plain_text.hpp"
#include "software_version.hpp"
#include "usage.hpp"

namespace pmg::apps {

namespace {

constexpr int kBadInput = 2;
constexpr int kInterrupted = 130;
constexpr unsigned kPatience_s = 1;  ///< work that takes longer after Ctrl-C is announced

std::filesystem::path typed;  // NOLINT: this program, as it was called
std::string program_name;     // NOLINT: signal handlers reach nothing else
std::string finishing_line;   // NOLINT

void end_at_once(int /*signal*/) { _exit(kInterrupted); }

void keep_in_mind(int /*signal*/) {
  if (interrupt_requested == 0) alarm(kPatience_s);
  interrupt_requested = 1;
}

/// Called while the program is still at work. From now on a second signal ends the program at once. An earlier one does
/// not, because one Ctrl-C can reach a program twice (timeout signals its child and then the group).
void say_what_goes_on(int /*signal*/) {
  const ssize_t written = write(STDERR_FILENO, finishing_line.data(), finishing_line.size());
  static_cast<void>(written);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, end_at_once);
}

/// Keeps ignoring SIGHUP if it is already ignored (nohup).
void handle(int signal, void (*handler)(int)) {
  const auto before = std::signal(signal, handler);
  if (signal == SIGHUP && before == SIG_IGN) std::signal(signal, SIG_IGN);
}

std::string version(const CLI::App& app, const std::function<std::string()>& bundle) {
  std::string text = fmt::format("{} {}", app.get_name(), PMG_SOFTWARE_VERSION);
  if (bundle && app.count("--robot") > 0) text += fmt::format("\nbundle {}", bundle());
  return text;
}

int parse_and_run(CLI::App& app, int argc, char** argv, const std::function<int()>& body) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    std::cerr << usage_error(app, error) << '\n';
    return kBadInput;
  }
  if (const std::string misread = misread_value(app); !misread.empty()) {
    std::cerr << misread << '\n';
    return kBadInput;
  }
  return body();
}

}  // namespace

void notice(std::initializer_list<int> signals, const char* finishing) {
  if (finishing == nullptr) {
    std::signal(SIGALRM, SIG_IGN);
  } else {
    finishing_line = fmt::format("{}{}: interrupted; {} (Ctrl-C again ends at once and loses that)\n",
                                 isatty(STDERR_FILENO) == 1 ? "\r\x1b[K" : "", program_name, finishing);
    std::signal(SIGALRM, say_what_goes_on);
  }
  for (const int signal : signals) handle(signal, keep_in_mind);
  handle(SIGHUP, keep_in_mind);
}

std::string typed_beside(const std::string& name) { return (typed.parent_path() / name).string(); }

std::string typed_word(const std::string& text) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || std::strchr("_./-+=:,@%", c) != nullptr; };
  if (!text.empty() && std::ranges::all_of(text, plain)) return text;
  std::string quoted = "'";
  for (const char letter : text) quoted += letter == '\'' ? "'\\''" : std::string(1, letter);
  return quoted + "'";
}

int run_program(CLI::App& app, int argc, char** argv, const std::function<int()>& body,
                const std::function<std::string()>& bundle) {
  program_name = app.get_name();
  if (argc > 0) typed = argv[0];
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) handle(signal, end_at_once);
  app.set_version_flag(
      "--version", [&] { return version(app, bundle); },
      bundle ? "print version and revision, with --robot the bundle too, and exit"
             : "print version and revision, and exit");  // added last: it needs the value of --robot
  app.add_flag_callback("--describe-as-json",
                        [&] {
                          std::cout << description(app) << '\n';
                          throw CLI::Success();
                        })
      ->group("");  // hidden: for cmake/manuals.py
  try {
    return parse_and_run(app, argc, argv, body);
  } catch (const std::filesystem::filesystem_error& error) {
    const bool file = error.code() == std::errc::not_a_directory || error.code() == std::errc::file_exists;
    std::cerr << fmt::format("{}: {}: {}\n", program_name, error.path1().string(),
                             file ? "a file has this name; expected a folder, or a new name"
                                  : fmt::format("cannot be read or written ({})", error.code().message()));
  } catch (const std::exception& error) {
    std::cerr << program_name << ": " << io::plain_text(error.what()) << '\n';
  }
  return kBadInput;
}

}  // namespace pmg::apps
