// Progress of long work on stderr: one line that renews itself on a terminal, a line every five seconds in a file or
// pipe.
#pragma once

#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <iostream>
#include <mutex>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>

namespace pmg::apps {

class ProgressLine {
 public:
  /// Work shorter than line_period prints nothing to a file or pipe.
  explicit ProgressLine(std::chrono::milliseconds line_period = std::chrono::seconds(5)) : line_period_(line_period) {
    if (!terminal_) writer_ = std::jthread([this](const std::stop_token& stop) { write_lines(stop); });
  }
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// May be called at any rate: a terminal's line is renewed ten times a second.
  void show(std::string_view text) {
    if (terminal_) {
      renew(text);
    } else {
      const std::lock_guard lock(mutex_);
      text_ = text;
    }
  }

  /// A bar for share in [0, 1], and the present step in words.
  void show(double share, std::string_view text) {
    constexpr int kBar = 30;
    const int done = static_cast<int>(share * kBar);
    if (terminal_) {
      show(fmt::format("[{:=<{}}{:{}}] {:3.0f} % {}", "", done, "", kBar - done, 100.0 * share, text));
    } else {
      show(fmt::format("{:3.0f} % {}", 100.0 * share, text));
    }
  }

  /// Clears the line, so that ordinary text can follow.
  void clear() {
    if (terminal_ && shown_) std::cerr << '\r' << std::string(kWidth, ' ') << '\r' << std::flush;
    shown_ = false;
    const std::lock_guard lock(mutex_);
    text_.clear();
  }

 private:
  void renew(std::string_view text) {
    const auto now = std::chrono::steady_clock::now();
    if (shown_ && now - last_ < std::chrono::milliseconds(100)) return;
    last_ = now;
    shown_ = true;
    std::cerr << fmt::format("\r{:<{}.{}}", text, kWidth, kWidth) << std::flush;
  }

  /// Runs in a thread of its own: lines appear also during a long time between two calls of show.
  void write_lines(const std::stop_token& stop) {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, nullptr);  // signals go to the threads of the work
    const auto start = std::chrono::steady_clock::now();
    std::unique_lock lock(mutex_);
    for (auto next = start + line_period_; !stop.stop_requested(); next += line_period_) {
      wake_.wait_until(lock, stop, next, [] { return false; });
      if (stop.stop_requested() || text_.empty()) continue;
      const auto spent = std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - start);
      std::cerr << fmt::format("[{} s] {}\n", spent.count(), text_) << std::flush;
    }
  }

  static constexpr int kWidth = 79;
  const std::chrono::milliseconds line_period_;
  const bool terminal_ = isatty(STDERR_FILENO) == 1;
  bool shown_ = false;
  std::chrono::steady_clock::time_point last_;
  std::mutex mutex_;  // guards text_
  std::string text_;
  std::condition_variable_any wake_;
  std::jthread writer_;  // declared last: it uses the members above
};

}  // namespace pmg::apps
