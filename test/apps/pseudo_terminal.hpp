// A program in its own terminal, with typed input and read output as a user's.
#pragma once

#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>
#include <utmp.h>

#include <array>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "folders.hpp"

namespace pmg::test {

inline constexpr double kDeadline_s = 90.0;  ///< for what a program is expected to show

/// A child process; killed when the object is destroyed.
class PseudoTerminal {
 public:
  PseudoTerminal(const std::string& program, std::vector<std::string> arguments) {
    winsize size{.ws_row = 40, .ws_col = 120, .ws_xpixel = 0, .ws_ypixel = 0};
    int slave = -1;
    if (openpty(&master_, &slave, nullptr, nullptr, &size) != 0) return;
    tcgetattr(slave, &before_);
    std::string path = pmg::test::program_folder() + "/" + program;
    std::vector<char*> argv{path.data()};
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    child_ = fork();
    if (child_ == 0) {
      login_tty(slave);
      execv(path.c_str(), argv.data());
      _exit(127);
    }
    slave_ = slave;  // kept open: the test reads its settings after the program has ended
  }
  ~PseudoTerminal() {
    if (child_ > 0) {
      kill(child_, SIGKILL);
      waitpid(child_, nullptr, 0);
    }
    close(master_);
    close(slave_);
  }
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  bool type(const std::string& keys) {
    return write(master_, keys.data(), keys.size()) == static_cast<ssize_t>(keys.size());
  }
  void send(int signal) const { kill(child_, signal); }
  pid_t id() const { return child_; }  ///< also its process group's
  /// Its output so far, newest picture last; reads all available bytes.
  const std::string& text() {
    std::array<char, 4096> bytes{};
    pollfd output{.fd = master_, .events = POLLIN, .revents = 0};
    while (poll(&output, 1, 0) > 0 && (output.revents & POLLIN) != 0) {
      const ssize_t count = read(master_, bytes.data(), bytes.size());
      if (count <= 0) break;
      text_.append(bytes.data(), static_cast<std::size_t>(count));
    }
    return text_;
  }
  /// The output from the beginning of the last picture.
  std::string picture() {
    const std::string& all = text();
    const std::size_t end = all.rfind("\x1b[J"), begin = end == std::string::npos ? end : all.rfind("\x1b[H", end);
    return begin == std::string::npos ? "" : all.substr(begin, end - begin);
  }
  /// True if the picture shows the words before the deadline; runs `errand` every 50 ms meanwhile.
  bool shows(const std::string& words, double deadline_s, const std::function<void()>& errand = {}) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(deadline_s);
    while (std::chrono::steady_clock::now() < end) {
      if (picture().find(words) != std::string::npos) return true;
      if (errand) errand();
      pollfd output{.fd = master_, .events = POLLIN, .revents = 0};
      poll(&output, 1, 50);
    }
    return false;
  }
  /// The exit code, or minus the signal that ended it.
  int wait() {
    int status = 0;
    while (waitpid(child_, &status, WNOHANG) == 0) {
      text();  // empties the terminal; a full one would block the program
      pollfd output{.fd = master_, .events = POLLIN, .revents = 0};
      poll(&output, 1, 20);
    }
    child_ = 0;
    text();
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  bool as_before() const {
    termios now{};
    return tcgetattr(slave_, &now) == 0 && now.c_lflag == before_.c_lflag && now.c_iflag == before_.c_iflag;
  }
  bool stopped() const {
    siginfo_t info{};
    return waitid(P_PID, static_cast<id_t>(child_), &info, WSTOPPED | WNOHANG | WNOWAIT) == 0 && info.si_pid == child_;
  }

 private:
  int master_ = -1, slave_ = -1;
  termios before_{};
  pid_t child_ = 0;
  std::string text_;
};

}  // namespace pmg::test
