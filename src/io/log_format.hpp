// LCM's event log. Each event is a header, the channel's name and the message's bytes. Numbers are big-endian.
#pragma once

#include <cstddef>
#include <cstdint>

namespace pmg::io {

inline constexpr std::uint32_t kLogSync = 0xEDA1DA01;
/// sync (4), event number (8), stamp in microseconds (8), length of the channel's name (4) and of the message (4).
inline constexpr std::size_t kLogHeaderBytes = 28;

}  // namespace pmg::io
