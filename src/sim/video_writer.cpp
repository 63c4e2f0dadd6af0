#include "sim/video_writer.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
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
          std::filesystem::absolute(path).string()};  // absolute: no path is taken for an option or a protocol
}

/// Starts ffmpeg with its standard input at the other end of the returned socket. A socket rather than a pipe, because
/// sending on it can be told not to raise SIGPIPE.
pid_t spawn(const std::vector<std::string>& arguments, int& socket) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw std::runtime_error(fmt::format("video: socketpair: {}", std::strerror(errno)));
  std::vector<char*> argv;
  for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
  pid_t pid = -1;
  const int error = posix_spawnp(&pid, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  if (error != 0) {
    ::close(ends[0]);
    throw std::runtime_error(
        fmt::format("video: ffmpeg doesn't start ({}); install ffmpeg or leave the video out", std::strerror(error)));
  }
  socket = ends[0];
  return pid;
}

}  // namespace

VideoWriter::VideoWriter(const std::filesystem::path& path, int width, int height, int frames_per_s)
    : path_(path), frame_bytes_(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
  ffmpeg_ = spawn(ffmpeg_arguments(path, width, height, frames_per_s), socket_);
}

VideoWriter::~VideoWriter() {
  try {
    close();
  } catch (const std::runtime_error&) {  // a destructor has nobody to tell
  }
}

void VideoWriter::write(std::span<const std::uint8_t> rgb) {
  if (rgb.size() != frame_bytes_)
    throw std::runtime_error(fmt::format("video: a frame of {} bytes; expected {}", rgb.size(), frame_bytes_));
  while (!rgb.empty()) {
    const ssize_t sent = send(socket_, rgb.data(), rgb.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) throw std::runtime_error(fmt::format("video: ffmpeg stopped while writing {}", path_.string()));
    rgb = rgb.subspan(static_cast<std::size_t>(sent));
  }
}

void VideoWriter::close() {
  if (ffmpeg_ < 0) return;
  ::close(socket_);
  int status = 0;
  while (waitpid(ffmpeg_, &status, 0) < 0 && errno == EINTR) {
  }
  ffmpeg_ = -1;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw std::runtime_error(fmt::format("video: ffmpeg could not write {}", path_.string()));
}

}  // namespace pmg::sim
