#include "apps/progress_line.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>

#include <csignal>

namespace pmg::apps {
namespace {

using namespace std::chrono_literals;

/// Redirects stderr while it exists.
class Redirected {
 public:
  explicit Redirected(int to) : before_(dup(STDERR_FILENO)) { dup2(to, STDERR_FILENO); }
  ~Redirected() {
    dup2(before_, STDERR_FILENO);
    close(before_);
  }
  Redirected(const Redirected&) = delete;
  Redirected& operator=(const Redirected&) = delete;

 private:
  int before_;
};

/// Reads until the output contains the text; ends after 10 s without output, or with far too much of it.
std::string read_until(int from, const std::string& text) {
  constexpr int kDeadline_ms = 10'000;
  constexpr std::size_t kTooMuch = 10'000;
  std::string got;
  pollfd readable{.fd = from, .events = POLLIN, .revents = 0};
  char buffer[256];
  while (got.find(text) == std::string::npos && got.size() < kTooMuch && poll(&readable, 1, kDeadline_ms) > 0) {
    const ssize_t count = read(from, buffer, sizeof(buffer));
    if (count <= 0) break;
    got.append(buffer, static_cast<std::size_t>(count));
  }
  return got;
}

TEST(ProgressLine, InAPipeALineComesAgainAndAgainWhileTheWorkSaysNothing) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const Redirected redirected(ends[1]);
  ProgressLine progress(1ms);
  progress.show(0.5, "making a clip");
  const std::string first = read_until(ends[0], "\n"), second = read_until(ends[0], "\n");
  EXPECT_THAT(first, testing::StartsWith("[0 s]  50 % making a clip\n"));
  EXPECT_THAT(second, testing::HasSubstr(" 50 % making a clip\n"));
  EXPECT_THAT(first, testing::Not(testing::HasSubstr("\r")));
}

TEST(ProgressLine, InAPipeTheNewestTextIsSaidHoweverSoonItFollowed) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const Redirected redirected(ends[1]);
  ProgressLine progress(1ms);
  progress.show("first");
  progress.show("second");
  EXPECT_THAT(read_until(ends[0], "second\n"), testing::EndsWith("second\n"));
}

TEST(ProgressLine, InAPipeShortWorkSaysNothing) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  {
    const Redirected redirected(ends[1]);
    ProgressLine progress;
    progress.show("short");
  }
  close(ends[1]);
  EXPECT_EQ(read_until(ends[0], "short"), "");
}

TEST(ProgressLine, InAPipeClearedTextIsNeverSaidAgain) {
  constexpr int kManyLines_ms = 100;
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const Redirected redirected(ends[1]);
  ProgressLine progress(1ms);
  progress.show("cleared");
  read_until(ends[0], "cleared\n");
  progress.clear();
  std::cerr << "end" << std::flush;
  EXPECT_THAT(read_until(ends[0], "end"), testing::EndsWith("end"));
  pollfd readable{.fd = ends[0], .events = POLLIN, .revents = 0};
  EXPECT_EQ(poll(&readable, 1, kManyLines_ms), 0);
}

TEST(ProgressLine, OnATerminalOneLineRenewsItself) {
  int terminal = 0, program = 0;
  ASSERT_EQ(openpty(&terminal, &program, nullptr, nullptr, nullptr), 0);
  const Redirected redirected(program);
  ProgressLine progress(1ms);
  progress.show(0.5, "making a clip");
  EXPECT_THAT(read_until(terminal, "clip"),
              testing::StartsWith("\r[===============               ]  50 % making a clip"));
  progress.clear();
  EXPECT_THAT(read_until(terminal, "\r "), testing::Not(testing::HasSubstr("\n")));
}

TEST(ProgressLine, ItsThreadTakesNoSignalFromTheWork) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const Redirected redirected(ends[1]);
  const auto before = std::signal(SIGUSR1, [](int /*signal*/) {});
  ProgressLine progress(1ms);
  progress.show("working");
  read_until(ends[0], "working\n");  // its thread runs
  sigset_t one, pending, mask;
  sigemptyset(&one);
  sigaddset(&one, SIGUSR1);
  pthread_sigmask(SIG_BLOCK, &one, &mask);
  kill(getpid(), SIGUSR1);  // any thread that doesn't block it takes it now
  progress.show("afterwards");
  read_until(ends[0], "afterwards\n");
  sigpending(&pending);
  EXPECT_TRUE(sigismember(&pending, SIGUSR1)) << "nobody took it from this thread";
  pthread_sigmask(SIG_SETMASK, &mask, nullptr);
  std::signal(SIGUSR1, before);
}

}  // namespace
}  // namespace pmg::apps
