// A terminal whose keys arrive one by one. Every end of the program except SIGKILL restores its earlier state.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace pmg::apps {

/// At most one per process. Draws on the terminal's second screen, so the first one reappears afterwards. Ctrl-C and
/// Ctrl-Z remain signals; after fg the keys arrive one by one again.
class RawTerminal {
 public:
  /// Throws std::runtime_error if input or output is no terminal.
  RawTerminal() {
    if (isatty(STDIN_FILENO) == 0 || isatty(STDOUT_FILENO) == 0) {
      throw std::runtime_error("needs a terminal for its keys; pmg_send drives from scripts");
    }
    if (tcgetattr(STDIN_FILENO, &cooked()) != 0) {
      throw std::runtime_error(std::string("the terminal can't be set up: ") + std::strerror(errno));
    }
    enter();
    std::atexit(leave);
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(signal, die);
    std::signal(SIGTSTP, suspend);
    std::signal(SIGCONT, resume);
    std::signal(SIGTTOU, SIG_IGN);  // sent if the shell has taken the terminal over
  }
  ~RawTerminal() {
    leave();
    for (const int signal : {SIGTSTP, SIGCONT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(signal, SIG_DFL);
  }
  RawTerminal(const RawTerminal&) = delete;
  RawTerminal& operator=(const RawTerminal&) = delete;

  /// Unread keys, without waiting. Sets ended() once the input is closed.
  std::string read() {
    std::array<char, 256> bytes{};
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (poll(&input, 1, 0) <= 0) return "";
    const ssize_t count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
    if (count > 0) return {bytes.data(), static_cast<std::size_t>(count)};
    ended_ = count == 0 || (errno != EINTR && errno != EAGAIN);
    return "";
  }
  bool ended() const noexcept { return ended_; }
  std::size_t rows() const { return measured().ws_row; }

  /// Draws a picture from the top left corner. Cuts lines that are too long, and surplus lines.
  void draw(const std::vector<std::string>& lines) const {
    const winsize size = measured();
    std::string text = "\x1b[H";
    for (std::size_t i = 0; i < lines.size() && i < size.ws_row; ++i) {
      if (i > 0) text += "\r\n";
      text += lines[i].substr(0, size.ws_col) + "\x1b[K";
    }
    put(text + "\x1b[J");
  }

 private:
  static winsize measured() {
    winsize size{};
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0)
      size = {.ws_row = 24, .ws_col = 80, .ws_xpixel = 0, .ws_ypixel = 0};
    return size;
  }
  static termios& cooked() {
    static termios settings{};
    return settings;
  }
  static void put(std::string_view text) {  // may be called from a signal handler
    while (!text.empty()) {
      const ssize_t count = ::write(STDOUT_FILENO, text.data(), text.size());
      if (count <= 0 && errno != EINTR) return;
      if (count > 0) text.remove_prefix(static_cast<std::size_t>(count));
    }
  }
  static volatile std::sig_atomic_t& raw() {
    static volatile std::sig_atomic_t is_raw = 0;
    return is_raw;
  }
  static void enter() {
    termios settings = cooked();
    settings.c_lflag &= static_cast<tcflag_t>(~(ICANON | ECHO));
    settings.c_iflag &= static_cast<tcflag_t>(~(IXON | ICRNL));
    settings.c_cc[VMIN] = 1;
    settings.c_cc[VTIME] = 0;
    raw() = 1;
    tcsetattr(STDIN_FILENO, TCSANOW, &settings);
    put("\x1b[?1049h\x1b[?25l\x1b[H\x1b[2J");
  }
  static void leave() {
    if (raw() == 0) return;
    raw() = 0;
    put("\x1b[?25h\x1b[?1049l");
    tcsetattr(STDIN_FILENO, TCSANOW, &cooked());
  }
  static void die(int signal) {
    leave();
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  static void suspend(int /*signal*/) {
    const int kept = errno;
    leave();
    std::raise(SIGSTOP);
    errno = kept;
  }
  static void resume(int /*signal*/) {
    const int kept = errno;
    if (raw() == 0 && tcgetpgrp(STDIN_FILENO) == getpgrp()) enter();  // not after bg
    errno = kept;
  }

  bool ended_ = false;
};

}  // namespace pmg::apps
