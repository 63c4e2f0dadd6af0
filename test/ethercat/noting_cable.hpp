// Both ends of a cable on one computer, which note when the host held them or a frame up.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <span>
#include <thread>
#include <vector>

#include "ethercat/cabled_drives.hpp"
#include "ethercat/master.hpp"
#include "ethercat/packet_wire.hpp"
#include "io/clock.hpp"
#include "model/robots.hpp"
#include "runtime/periodic_thread.hpp"
#include "sim/robots.hpp"

namespace pmg::ethercat {

/// From begin_ns to end_ns on the wall clock.
struct Span {
  std::int64_t begin_ns = 0, end_ns = 0;
  std::int64_t length_ns() const { return end_ns - begin_ns; }
};

/// The longest of the spans that overlap this one [ns]; 0: none.
inline std::int64_t longest_beside(const std::vector<Span>& spans, const Span& span) {
  std::int64_t longest_ns = 0;
  for (const Span& other : spans) {
    if (other.begin_ns <= span.end_ns && other.end_ns >= span.begin_ns)
      longest_ns = std::max(longest_ns, other.length_ns());
  }
  return longest_ns;
}

/// When frames passed an end of the cable [ns of the wall clock], by their first datagram's index: the host may send
/// the next frame before one that was held up comes to the slaves.
struct Passed {
  using Times = std::array<std::atomic<std::int64_t>, 256>;
  Times sent_ns{};      ///< by the host
  Times answered_ns{};  ///< by the slaves' end

  static std::atomic<std::int64_t>& of(Times& times, std::span<const std::uint8_t> frame) { return times[frame[17]]; }
};

/// Half the time that a frame is awaited: what holds one up for longer may be why it is missed.
inline constexpr std::int64_t kHeldUp_ns = Master::kInputsWithin_ns / 2;

/// The host's end. It notes when it was held up while it sent or waited, or an answer on its way to it.
class HostEnd final : public Wire {
 public:
  HostEnd(const std::string& interface, Passed& passed) : wire_(interface), passed_(passed) { stalls_.reserve(10'000); }
  bool send(std::span<const std::uint8_t> frame) noexcept override {
    const std::int64_t begin_ns = clock_.now_ns();
    Passed::of(passed_.sent_ns, frame).store(begin_ns);
    newest_ = frame[17];
    const bool sent = wire_.send(frame);
    if (const std::int64_t end_ns = clock_.now_ns(); end_ns - begin_ns > kHeldUp_ns) note({begin_ns, end_ns});
    return sent;
  }
  std::size_t receive(std::span<std::uint8_t> frame, std::int64_t wait_ns) noexcept override {
    const std::int64_t begin_ns = clock_.now_ns();
    const std::size_t bytes = wire_.receive(frame, wait_ns);
    const std::int64_t end_ns = clock_.now_ns();
    if (end_ns - begin_ns > wait_ns + kHeldUp_ns) note({begin_ns, end_ns});
    const std::uint8_t index = bytes > 0 ? frame[17] : newest_;
    const std::int64_t answered_ns = passed_.answered_ns[index].load();
    const bool answered = answered_ns > passed_.sent_ns[index].load();
    if (answered && end_ns - answered_ns > kHeldUp_ns) note({answered_ns, end_ns});
    return bytes;
  }
  const std::vector<Span>& stalls() const { return stalls_; }

 private:
  void note(const Span& span) noexcept {
    if (stalls_.size() < stalls_.capacity()) stalls_.push_back(span);
  }

  io::WallClock clock_;
  PacketWire wire_;
  Passed& passed_;
  std::uint8_t newest_ = 0;
  std::vector<Span> stalls_;
};

/// Emulated slaves and drives on the far end, in a thread that answers each frame when it comes. It notes when a frame
/// came to it late, or when it was held up itself.
class FarEnd {
 public:
  FarEnd(test::CabledDrives& cabled, Passed& passed) : cabled_(cabled), passed_(passed), wire_("ecat1") {
    stalls_.reserve(10'000);
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }
  /// Ends the thread. When it was held up, or a frame under way to it.
  std::vector<Span> stop() {
    thread_.request_stop();
    thread_.join();
    return stalls_;
  }

 private:
  void run(const std::stop_token& stop) {
    runtime::schedule_this_thread({.name = "slaves", .priority = 60});
    const io::WallClock clock;
    model::JointCommand acting = standing_command(test::z1());
    std::array<std::uint8_t, kMostFrame> frame{};
    std::int64_t next_ns = clock.now_ns();
    while (!stop.stop_requested()) {
      const std::int64_t before_ns = clock.now_ns();
      const std::int64_t wait_ns = std::max<std::int64_t>(next_ns - before_ns, 0);
      const std::size_t bytes = wire_.receive(frame, wait_ns);
      const std::int64_t came_ns = clock.now_ns();
      if (bytes > 0) {
        const std::int64_t sent_ns = Passed::of(passed_.sent_ns, frame).load();
        if (came_ns - sent_ns > kHeldUp_ns) stalls_.push_back({sent_ns, came_ns});
        test::pass(std::span(frame).first(bytes), cabled_.wire.slaves);
        wire_.send(std::span(frame).first(bytes));
        Passed::of(passed_.answered_ns, frame).store(clock.now_ns());
        cabled_.drives->answer();
      }
      if (clock.now_ns() >= next_ns) {
        next_ns += Master::kPeriod_ns;
        cabled_.drives->speak();
        cabled_.drives->tick(acting);
        cabled_.tick_slaves();
      }
      const std::int64_t now_ns = clock.now_ns();
      if (now_ns - came_ns > kHeldUp_ns) stalls_.push_back({came_ns, now_ns});
      if (came_ns - before_ns > wait_ns + kHeldUp_ns) {
        stalls_.push_back({before_ns + wait_ns, came_ns});
        next_ns = std::max(next_ns, now_ns - 10 * Master::kPeriod_ns);
      }
    }
  }

  test::CabledDrives& cabled_;
  Passed& passed_;
  PacketWire wire_;
  std::vector<Span> stalls_;
  std::jthread thread_;
};

}  // namespace pmg::ethercat
