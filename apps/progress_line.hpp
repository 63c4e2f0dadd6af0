// How far long work is, on stderr: on a terminal one line that renews itself, in a file or a pipe a line every five
// seconds.
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
  /// Work that is over before line_period says nothing in a file or a pipe.
  explicit ProgressLine(std::chrono::milliseconds line_period = std::chrono::seconds(5)) : line_period_(line_period) {
    if (!terminal_) writer_ = std::jthread([this](const std::stop_token& stop) { write_lines(stop); });
  }
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// As often as one likes: a terminal's line is renewed ten times a second.
  void show(std::string_view text) {
    if (terminal_) {
      renew(text);
    } else {
      const std::lock_guard lock(mutex_);
      text_ = text;
    }
  }

  /// share in [0, 1] as a bar, and what is being done.
  void show(double share, std::string_view text) {
    constexpr int kBar = 30;
    const int done = static_cast<int>(share * kBar);
    if (terminal_) {
      show(fmt::format("[{:=<{}}{:{}}] {:3.0f} % {}", "", done, "", kBar - done, 100.0 * share, text));
    } else {
      show(fmt::format("{:3.0f} % {}", 100.0 * share, text));
    }
  }

  /// Makes room for ordinary text.
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

  /// A thread of its own: a line comes also while the work is long between two calls of show.
  void write_lines(const std::stop_token& stop) {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, nullptr);  // interruption is the work's to notice
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
  std::mutex mutex_;  // of text_
  std::string text_;
  std::condition_variable_any wake_;
  std::jthread writer_;  // last: it uses what stands above
};

}  // namespace pmg::apps
