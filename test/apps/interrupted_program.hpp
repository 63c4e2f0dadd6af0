// A program at a terminal, interrupted in the middle of its work. Ctrl-C reaches it as a user's does: the terminal
// sends SIGINT to the whole foreground group, which is the program and everything that it has started.
#pragma once

#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>

#include "apps/pseudo_terminal.hpp"

namespace pmg::test {

/// The end of a program.
struct Ended {
  int exit_code = 0;         ///< or minus the signal that ended it
  double cpu_after_s = 0.0;  ///< processor time that it used after the signal; the host's load doesn't count
};

/// True if the condition holds while the program runs.
inline bool until(PseudoTerminal& program, const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(4);
  while (!condition()) {
    program.text();  // empties the terminal; a full one would block the program
    siginfo_t ended{};
    waitid(P_PID, static_cast<id_t>(program.id()), &ended, WEXITED | WNOHANG | WNOWAIT);
    if (ended.si_pid != 0 || std::chrono::steady_clock::now() > end) return condition();
    poll(nullptr, 0, 20);
  }
  return true;
}

/// The same for a text in its output.
inline bool wrote(PseudoTerminal& program, const std::string& text) {
  return until(program, [&] { return program.text().find(text) != std::string::npos; });
}

/// CPU time of a running process with its ended children: fields 14 to 17 of /proc/PID/stat.
inline double cpu_s(pid_t process) {
  std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
  const std::string text((std::istreambuf_iterator<char>(stat)), {});
  std::istringstream fields(text.substr(text.rfind(')') + 1));
  std::string skipped;
  for (int i = 0; i < 11; ++i) fields >> skipped;
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    double ticks = 0.0;
    fields >> ticks;
    sum += ticks;
  }
  return sum / static_cast<double>(sysconf(_SC_CLK_TCK));
}

/// CPU time of this process' ended children.
inline double children_cpu_s() {
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// Types Ctrl-C, or sends this signal to the program's whole group; then waits.
inline Ended interrupt(PseudoTerminal& program, int signal = SIGINT) {
  const double others_s = children_cpu_s(), before_s = cpu_s(program.id());
  if (signal == SIGINT) {
    program.type("\x03");
  } else {
    kill(-program.id(), signal);
  }
  const int exit_code = program.wait();
  return {exit_code, children_cpu_s() - others_s - before_s};
}

}  // namespace pmg::test
