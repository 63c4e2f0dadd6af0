#include "sim/jpeg.hpp"

#include <fmt/format.h>
#include <turbojpeg.h>

#include <stdexcept>

namespace pmg::sim {

namespace {

// 80 shows no blocks on a rendered picture; a picture that needs less than 10 isn't one of a robot's surroundings.
constexpr int kQualities[] = {80, 40, 10};

struct FreeJpeg {
  void operator()(unsigned char* bytes) const { tjFree(bytes); }
};

}  // namespace

JpegEncoder::JpegEncoder() : compressor_(tjInitCompress()) {
  if (compressor_ == nullptr) throw std::runtime_error("JPEG: no encoder can be made");
}

JpegEncoder::~JpegEncoder() { tjDestroy(compressor_); }

std::vector<std::uint8_t> JpegEncoder::encode(std::span<const std::uint8_t> rgb, int width, int height,
                                              std::size_t most_bytes) {
  if (width <= 0 || height <= 0 ||
      rgb.size() != 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    throw std::runtime_error(fmt::format("JPEG: {} bytes for {} x {} pixels", rgb.size(), width, height));
  }
  for (const int quality : kQualities) {
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    const int failed = tjCompress2(compressor_, rgb.data(), width, 0, height, TJPF_RGB, &bytes, &size, TJSAMP_420,
                                   quality, TJFLAG_FASTDCT);
    const std::unique_ptr<unsigned char, FreeJpeg> owner(bytes);
    if (failed != 0) throw std::runtime_error(fmt::format("JPEG: {}", tjGetErrorStr2(compressor_)));
    if (size <= most_bytes) return {bytes, bytes + size};
  }
  throw std::runtime_error(fmt::format("JPEG: {} x {} pixels don't fit into {} bytes", width, height, most_bytes));
}

}  // namespace pmg::sim
