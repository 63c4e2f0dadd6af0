// A display for tests that open windows: the desktop's, or else Xvfb's.
#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace pmg::test {

/// A display for this process, or none. Xvfb prints its number when it is ready.
class Display {
 public:
  Display() {
    if (there()) return;
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) return;
    xvfb_ = fork();
    if (xvfb_ == 0) {
      close(ends[0]);
      if (std::freopen("/dev/null", "w", stderr) == nullptr) _exit(126);
      execlp("Xvfb", "Xvfb", "-displayfd", std::to_string(ends[1]).c_str(), "-screen", "0", "1280x1024x24", nullptr);
      _exit(127);
    }
    close(ends[1]);
    std::string number;
    for (char c = 0; read(ends[0], &c, 1) == 1 && c != '\n';) number += c;
    close(ends[0]);
    if (!number.empty()) setenv("DISPLAY", (":" + number).c_str(), 1);
  }
  ~Display() {
    if (xvfb_ <= 0) return;
    kill(xvfb_, SIGTERM);
    waitpid(xvfb_, nullptr, 0);
    unsetenv("DISPLAY");
  }
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  static bool there() {
    const char* display = std::getenv("DISPLAY");
    return display != nullptr && *display != '\0';
  }

 private:
  pid_t xvfb_ = 0;
};

}  // namespace pmg::test
