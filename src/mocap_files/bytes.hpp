// Numbers in the bytes of a binary file, with bounds.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "files/config_error.hpp"

namespace pmg::mocap {

/// Every read checks that the bytes are there. Errors name file and byte.
class Bytes {
 public:
  Bytes(std::string file, std::string_view bytes) : file_(std::move(file)), bytes_(bytes) {}

  std::size_t size() const { return bytes_.size(); }
  std::string_view at(std::size_t offset, std::size_t count, const std::string& expected) const {
    if (offset > bytes_.size() || count > bytes_.size() - offset) {
      fail(offset, fmt::format("the file ends at byte {}", bytes_.size()), expected);
    }
    return bytes_.substr(offset, count);
  }
  std::uint8_t u8(std::size_t offset, const std::string& expected) const {
    return static_cast<std::uint8_t>(at(offset, 1, expected)[0]);
  }
  std::uint16_t u16(std::size_t offset, const std::string& expected) const {
    return static_cast<std::uint16_t>(little(offset, 2, expected));
  }
  std::uint32_t u32(std::size_t offset, const std::string& expected) const {
    return static_cast<std::uint32_t>(little(offset, 4, expected));
  }

  [[noreturn]] void fail(std::size_t offset, const std::string& wrong, const std::string& expected) const {
    files::raise({file_}, fmt::format("byte {}", offset), wrong, expected);
  }

 private:
  std::uint64_t little(std::size_t offset, std::size_t count, const std::string& expected) const {
    const std::string_view bytes = at(offset, count, expected);
    std::uint64_t value = 0;
    for (std::size_t i = count; i-- > 0;) value = value << 8 | static_cast<std::uint8_t>(bytes[i]);
    return value;
  }

  std::string file_;
  std::string_view bytes_;
};

}  // namespace pmg::mocap
