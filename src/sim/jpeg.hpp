// Pictures as JPEG files in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace pmg::sim {

/// For one thread.
class JpegEncoder {
 public:
  JpegEncoder();  ///< throws std::runtime_error if there is no memory
  ~JpegEncoder();
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;

  /// rgb: width * height triples, from the top left. The best of a few qualities that gives no more than so many bytes.
  /// Throws std::runtime_error if none does, or rgb has another size.
  std::vector<std::uint8_t> encode(std::span<const std::uint8_t> rgb, int width, int height, std::size_t most_bytes);

 private:
  void* compressor_;  // TurboJPEG's
};

}  // namespace pmg::sim
