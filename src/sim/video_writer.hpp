// Writes frames into an H.264 file through an ffmpeg process.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <span>

namespace pmg::sim {

/// Throws std::runtime_error if no ffmpeg runs. Call it before hours of work.
void expect_ffmpeg();

class VideoWriter {
 public:
  /// Throws std::runtime_error if there is no ffmpeg. path's ending selects the container (mp4).
  VideoWriter(const std::filesystem::path& path, int width, int height, int frames_per_s = 50);
  ~VideoWriter();  ///< closes; errors are not reported
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// width * height RGB triples, from the top left. Throws std::runtime_error, with ffmpeg's last line, when ffmpeg has
  /// ended; nothing can be written after that.
  void write(std::span<const std::uint8_t> rgb);
  /// Waits until ffmpeg has finished the file. Throws std::runtime_error when it reports failure.
  void close();

 private:
  std::filesystem::path path_;
  std::size_t frame_bytes_;
  pid_t ffmpeg_ = -1;
  int socket_ = -1;
  int words_ = -1;  ///< ffmpeg's messages, a file in memory

  int end();  ///< ffmpeg's exit status
  [[noreturn]] void give_up(const char* what);
};

}  // namespace pmg::sim
