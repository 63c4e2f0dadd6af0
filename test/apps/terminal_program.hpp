// One of the executables at a terminal of its own: its progress can be read, and keys typed. Ctrl-C reaches it as it
// does a user's: the terminal sends SIGINT to the whole foreground group, to the program and to whatever it has
// started.
#pragma once

#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

namespace pmg::test {

inline constexpr char kCtrlC = '\x03';

/// How a program ended.
struct Ended {
  int exit_code = 0;         ///< or minus the signal that ended it
  double cpu_after_s = 0.0;  ///< processor time that it and its children used after end() began: load doesn't count
};

class TerminalProgram {
 public:
  /// Standard output goes to a file, standard error to the terminal, 80 columns wide.
  TerminalProgram(const std::string& name, std::vector<std::string> arguments, const std::filesystem::path& folder)
      : out_(folder / (name + ".out")) {
    const std::string program = std::string(PMG_BIN_DIR) + "/" + name;
    std::vector<char*> argv{const_cast<char*>(program.c_str())};
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    child_ = forkpty(&terminal_, nullptr, nullptr, nullptr);
    if (child_ == 0) {
      if (std::freopen(out_.c_str(), "w", stdout) == nullptr) _exit(126);
      execv(program.c_str(), argv.data());
      _exit(127);
    }
  }
  ~TerminalProgram() {
    if (child_ > 0) {
      kill(-child_, SIGKILL);
      waitpid(child_, nullptr, 0);
    }
    close(terminal_);
  }
  TerminalProgram(const TerminalProgram&) = delete;
  TerminalProgram& operator=(const TerminalProgram&) = delete;

  /// True when the terminal showed this text while the program ran.
  bool shows(const std::string& text) {
    while (shown_.find(text) == std::string::npos) {
      if (!read_some()) return false;
    }
    return true;
  }
  /// True when the condition came true while the program ran; it is asked whenever the terminal shows something new.
  bool until(const std::function<bool()>& condition) {
    while (!condition()) {
      if (!read_some()) return false;
    }
    return true;
  }

  /// Ctrl-C as if typed, or this signal to the whole group; then waits.
  Ended interrupt(int signal = SIGINT) {
    const double before_s = cpu_s();
    if (signal == SIGINT) {
      const ssize_t typed = write(terminal_, &kCtrlC, 1);
      static_cast<void>(typed);
    } else {
      kill(-child_, signal);
    }
    while (read_some()) {
    }
    int status = 0;
    rusage used{};
    wait4(child_, &status, 0, &used);
    child_ = 0;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status),
            seconds(used.ru_utime) + seconds(used.ru_stime) - before_s};
  }

  const std::string& shown() const { return shown_; }
  std::string out() const {
    std::ifstream in(out_, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  }

 private:
  static double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
  }
  /// Of the child until now, its ended children included: fields 14 to 17 of /proc/PID/stat.
  double cpu_s() const {
    std::ifstream stat("/proc/" + std::to_string(child_) + "/stat");
    std::string text((std::istreambuf_iterator<char>(stat)), {});
    std::istringstream fields(text.substr(text.rfind(')') + 1));
    std::string skipped;
    for (int i = 0; i < 11; ++i) fields >> skipped;
    double ticks = 0.0, sum = 0.0;
    for (int i = 0; i < 4; ++i) {
      fields >> ticks;
      sum += ticks;
    }
    return sum / static_cast<double>(sysconf(_SC_CLK_TCK));
  }
  /// False when the program has closed its terminal, or shows nothing for two minutes.
  bool read_some() {
    pollfd waiting{terminal_, POLLIN, 0};
    constexpr int kLongest_ms = 120'000;
    if (poll(&waiting, 1, kLongest_ms) <= 0) return false;
    char part[4096];
    const ssize_t got = read(terminal_, part, sizeof part);
    if (got <= 0) return false;
    shown_.append(part, static_cast<std::size_t>(got));
    return true;
  }

  std::filesystem::path out_;
  int terminal_ = -1;
  pid_t child_ = 0;
  std::string shown_;
};

}  // namespace pmg::test
