// One line on stderr that renews itself during long work, when somebody watches; nothing otherwise.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <iostream>
#include <string>
#include <string_view>

namespace pmg::apps {

class ProgressLine {
 public:
  ~ProgressLine() { clear(); }

  /// As often as one likes: it is written ten times a second.
  void show(std::string_view text) {
    if (!watched_) return;
    const auto now = std::chrono::steady_clock::now();
    if (shown_ && now - last_ < std::chrono::milliseconds(100)) return;
    last_ = now;
    shown_ = true;
    std::cerr << fmt::format("\r{:<{}.{}}", text, kWidth, kWidth) << std::flush;
  }

  /// share in [0, 1] as a bar, and what is being done.
  void show(double share, std::string_view text) {
    constexpr int kBar = 30;
    const int done = static_cast<int>(share * kBar);
    show(fmt::format("[{:=<{}}{:{}}] {:3.0f} % {}", "", done, "", kBar - done, 100.0 * share, text));
  }

  /// Makes room for ordinary text.
  void clear() {
    if (shown_) std::cerr << '\r' << std::string(kWidth, ' ') << '\r' << std::flush;
    shown_ = false;
  }

 private:
  static constexpr int kWidth = 79;
  bool watched_ = isatty(STDERR_FILENO) == 1;
  bool shown_ = false;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace pmg::apps
