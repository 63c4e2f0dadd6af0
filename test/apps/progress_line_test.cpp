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

/// Reads one end of a pipe or a terminal; what comes in one piece with a text stays for the next call.
class Output {
 public:
  explicit Output(int from) : from_(from) {}

  /// Up to the end of this text; ends after 10 s without output, or with far too much of it.
  std::string until(const std::string& text) {
    constexpr int kDeadline_ms = 10'000;
    constexpr std::size_t kTooMuch = 10'000;
    pollfd readable{.fd = from_, .events = POLLIN, .revents = 0};
    char buffer[256];
    while (rest_.find(text) == std::string::npos && rest_.size() < kTooMuch && poll(&readable, 1, kDeadline_ms) > 0) {
      const ssize_t count = read(from_, buffer, sizeof(buffer));
      if (count <= 0) break;
      rest_.append(buffer, static_cast<std::size_t>(count));
    }
    const std::size_t at = rest_.find(text);
    const std::size_t size = at == std::string::npos ? rest_.size() : at + text.size();
    const std::string got = rest_.substr(0, size);
    rest_.erase(0, size);
    return got;
  }

  /// Nothing is left, and nothing comes for so long.
  bool stays_quiet(int for_ms) const {
    pollfd readable{.fd = from_, .events = POLLIN, .revents = 0};
    return rest_.empty() && poll(&readable, 1, for_ms) == 0;
  }

 private:
  int from_;
  std::string rest_;
};

TEST(ProgressLine, InAPipeALineComesAgainAndAgainWhileTheWorkSaysNothing) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const Redirected redirected(ends[1]);
  ProgressLine progress(1ms);
  progress.show(0.5, "making a clip");
  Output output(ends[0]);
  for (const char* which : {"first", "second"})
    EXPECT_THAT(output.until("\n"), testing::MatchesRegex("\\[[0-9]+ s\\]  50 % making a clip\n")) << which;
}

TEST(ProgressLine, InAPipeTheNewestTextIsSaidHoweverSoonItFollowed) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const Redirected redirected(ends[1]);
  ProgressLine progress(1ms);
  progress.show("first");
  progress.show("second");
  EXPECT_THAT(Output(ends[0]).until("second\n"), testing::EndsWith("second\n"));
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
  EXPECT_EQ(Output(ends[0]).until("short"), "");
}

TEST(ProgressLine, InAPipeClearedTextIsNeverSaidAgain) {
  constexpr int kManyLines_ms = 100;
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const Redirected redirected(ends[1]);
  ProgressLine progress(1ms);
  progress.show("cleared");
  Output output(ends[0]);
  output.until("cleared\n");
  progress.clear();
  std::cerr << "end" << std::flush;
  EXPECT_THAT(output.until("end"), testing::EndsWith("end"));
  EXPECT_TRUE(output.stays_quiet(kManyLines_ms));
}

TEST(ProgressLine, OnATerminalOneLineRenewsItself) {
  int terminal = 0, program = 0;
  ASSERT_EQ(openpty(&terminal, &program, nullptr, nullptr, nullptr), 0);
  const Redirected redirected(program);
  ProgressLine progress(1ms);
  progress.show(0.5, "making a clip");
  Output output(terminal);
  EXPECT_THAT(output.until("clip"), testing::StartsWith("\r[===============               ]  50 % making a clip"));
  progress.clear();
  EXPECT_THAT(output.until("\r "), testing::Not(testing::HasSubstr("\n")));
}

TEST(ProgressLine, ItsThreadTakesNoSignalFromTheWork) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const Redirected redirected(ends[1]);
  const auto before = std::signal(SIGUSR1, [](int /*signal*/) {});
  ProgressLine progress(1ms);
  progress.show("working");
  Output output(ends[0]);
  output.until("working\n");  // its thread runs
  sigset_t one, pending, mask;
  sigemptyset(&one);
  sigaddset(&one, SIGUSR1);
  pthread_sigmask(SIG_BLOCK, &one, &mask);
  kill(getpid(), SIGUSR1);  // any thread that doesn't block it takes it now
  progress.show("afterwards");
  output.until("afterwards\n");
  sigpending(&pending);
  EXPECT_TRUE(sigismember(&pending, SIGUSR1)) << "nobody took it from this thread";
  pthread_sigmask(SIG_SETMASK, &mask, nullptr);
  std::signal(SIGUSR1, before);
}

}  // namespace
}  // namespace pmg::apps
