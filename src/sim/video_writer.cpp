#include "sim/video_writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace pmg::sim {

namespace {

std::vector<std::string> ffmpeg_arguments(const std::filesystem::path& path, int width, int height, int frames_per_s) {
  return {"ffmpeg",
          "-y",
          "-loglevel",
          "error",
          "-f",
          "rawvideo",
          "-pix_fmt",
          "rgb24",
          "-s",
          fmt::format("{}x{}", width, height),
          "-r",
          fmt::format("{}", frames_per_s),
          "-i",
          "pipe:0",
          "-an",
          "-c:v",
          "libx264",
          "-preset",
          "veryfast",
          "-crf",
          "21",
          "-pix_fmt",
          "yuv420p",
          "-movflags",
          "+faststart",
          std::filesystem::absolute(path).string()};  // absolute: a path is never read as an option or a protocol
}

/// Starts a program with these as its standard input, and as its standard output and error together, in a process group
/// of its own. A Ctrl-C at the terminal goes to the whole foreground group, and must not end ffmpeg before the last
/// frame is written. Returns 0 or an errno.
int spawn_apart(std::vector<std::string> arguments, int standard_input, int words, pid_t& pid) {
  std::vector<char*> argv;
  for (auto& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, standard_input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, words, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, words, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);  // 0: a group of its own
  const int error = posix_spawnp(&pid, argv[0], &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

/// The exit status as waitpid gives it.
int wait_for(pid_t pid) {
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

bool ended_well(int status) { return WIFEXITED(status) && WEXITSTATUS(status) == 0; }

[[noreturn]] void no_ffmpeg(const char* why) {
  throw std::runtime_error(fmt::format("video: ffmpeg doesn't start ({}); install ffmpeg or leave the video out", why));
}

/// The last line that ffmpeg wrote into this file, as " (LINE)"; empty when it wrote none.
std::string last_words(int file) {
  std::string text;
  std::array<char, 4096> part{};
  for (off_t at = 0;;) {
    const ssize_t got = pread(file, part.data(), part.size(), at);
    if (got <= 0) break;
    text.append(part.data(), static_cast<std::size_t>(got));
    at += got;
  }
  while (!text.empty() && text.back() == '\n') text.pop_back();
  text = text.substr(text.find_last_of('\n') + 1);
  return text.empty() ? "" : " (" + text + ")";
}

}  // namespace

void expect_ffmpeg() {
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  pid_t pid = -1;
  const int error = spawn_apart({"ffmpeg", "-loglevel", "quiet", "-version"}, nothing, nothing, pid);
  if (nothing >= 0) ::close(nothing);
  if (error != 0) no_ffmpeg(std::strerror(error));
  if (!ended_well(wait_for(pid))) no_ffmpeg("ffmpeg -version fails");
}

VideoWriter::VideoWriter(const std::filesystem::path& path, int width, int height, int frames_per_s)
    : path_(path), frame_bytes_(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
  // A socket instead of a pipe, because send() can suppress SIGPIPE.
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw std::runtime_error(fmt::format("video: socketpair: {}", std::strerror(errno)));
  words_ = memfd_create("ffmpeg", MFD_CLOEXEC);
  const int error = spawn_apart(ffmpeg_arguments(path, width, height, frames_per_s), ends[1],
                                words_ >= 0 ? words_ : STDERR_FILENO, ffmpeg_);
  ::close(ends[1]);
  socket_ = ends[0];
  if (error == 0) return;
  ffmpeg_ = -1;
  ::close(socket_);
  if (words_ >= 0) ::close(words_);
  no_ffmpeg(std::strerror(error));
}

VideoWriter::~VideoWriter() {
  try {
    close();
  } catch (const std::runtime_error&) {  // a destructor can't report it
  }
  if (words_ >= 0) ::close(words_);
}

void VideoWriter::write(std::span<const std::uint8_t> rgb) {
  if (rgb.size() != frame_bytes_)
    throw std::runtime_error(fmt::format("video: a frame of {} bytes; expected {}", rgb.size(), frame_bytes_));
  if (ffmpeg_ < 0) throw std::runtime_error(fmt::format("video: {} is closed", path_.string()));
  while (!rgb.empty()) {
    const ssize_t sent = send(socket_, rgb.data(), rgb.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) give_up("stopped while writing");
    rgb = rgb.subspan(static_cast<std::size_t>(sent));
  }
}

void VideoWriter::close() {
  if (ffmpeg_ >= 0 && !ended_well(end())) give_up("could not write");
}

int VideoWriter::end() {
  ::close(socket_);
  return wait_for(std::exchange(ffmpeg_, -1));
}

void VideoWriter::give_up(const char* what) {
  if (ffmpeg_ >= 0) end();
  throw std::runtime_error(fmt::format("video: ffmpeg {} {}{}", what, path_.string(), last_words(words_)));
}

}  // namespace pmg::sim
