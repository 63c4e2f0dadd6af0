// Frames into an H.264 file, by an ffmpeg process.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <span>

namespace pmg::sim {

/// Throws std::runtime_error when there is no ffmpeg that runs: to be said before hours of work, not after.
void expect_ffmpeg();

class VideoWriter {
 public:
  /// Throws std::runtime_error when there is no ffmpeg. path's ending chooses the container (mp4).
  VideoWriter(const std::filesystem::path& path, int width, int height, int frames_per_s = 50);
  ~VideoWriter();  ///< closes, errors unheard
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// width * height RGB triples, from the top left. Throws std::runtime_error, with ffmpeg's last line, when ffmpeg has
  /// given up; nothing can be written after that.
  void write(std::span<const std::uint8_t> rgb);
  /// Waits for ffmpeg to finish the file. Throws std::runtime_error when it reports failure.
  void close();

 private:
  std::filesystem::path path_;
  std::size_t frame_bytes_;
  pid_t ffmpeg_ = -1;
  int socket_ = -1;
  int words_ = -1;  ///< what ffmpeg says, a file in memory

  int end();  ///< ffmpeg's exit status
  [[noreturn]] void give_up(const char* what);
};

}  // namespace pmg::sim
