// Which STATUS messages of a robot are news: none that was recorded.
#pragma once

#include <array>
#include <cstdint>

#include "io/transit.hpp"

namespace pmg::seal {

/// For the believed STATUS of one robot. A message is news if it is later than all before it of the same start of the
/// controller, and hasn't waited. While one start of the controller speaks, another one's messages are recordings, or
/// an impostor's: a controller that starts anew is silent for longer than kSpeaks_ns.
class StatusOrder {
 public:
  static constexpr std::int64_t kSpeaks_ns = 300'000'000;
  /// One that travelled this much longer than the fastest one is no news.
  static constexpr std::int64_t kLate_ns = 500'000'000;
  static constexpr std::size_t kEarlierStarts = 8;

  /// boot: the start's number. stamp_ns: by the controller's clock.
  bool news(std::int64_t boot, std::int64_t stamp_ns, std::int64_t now_ns) const noexcept;
  /// Takes news into account; false: it is none.
  bool take(std::int64_t boot, std::int64_t stamp_ns, std::int64_t now_ns) noexcept;

 private:
  struct Start {
    std::int64_t boot = 0, newest_ns = 0;
  };
  bool is_earlier(std::int64_t boot, std::int64_t stamp_ns) const noexcept;

  bool any_ = false;
  Start start_;
  io::Transit transit_;  // of this start
  std::int64_t heard_ns_ = 0;
  std::array<Start, kEarlierStarts> earlier_{};  // a ring
  std::size_t earlier_count_ = 0;
};

}  // namespace pmg::seal
