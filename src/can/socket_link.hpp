// A Linux CAN socket (SocketCAN).
#pragma once

#include <linux/can.h>
#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "can/candump.hpp"
#include "can/link.hpp"

namespace pmg::can {

class SocketLink final : public Link {
 public:
  static constexpr std::size_t kBatch = 32;  ///< frames a system call

  /// ids: the only ones to be received; empty: all. fd: the interface must carry CAN FD. most_waiting: frames of this
  /// socket that wait for the wire at most, whatever the interface's queue has room for; 0: as many as the kernel
  /// takes. Throws std::runtime_error, one
  /// line: the kernel has no CAN, no permission, no such interface, an interface that is down or isn't CAN's.
  SocketLink(const std::string& interface, const std::vector<std::uint32_t>& ids, bool fd, int most_waiting = 0);
  ~SocketLink() override;
  SocketLink(const SocketLink&) = delete;
  SocketLink& operator=(const SocketLink&) = delete;

  std::size_t send(std::span<const drives::Message> frames) noexcept override;
  std::size_t receive(std::span<drives::Message> frames) noexcept override;
  BusHealth health() const noexcept override { return health_; }
  const LinkCounts& counts() const noexcept override { return counts_; }
  int descriptor() const noexcept override { return socket_; }

  /// The next frame of any kind that has arrived, remote frames and the controller's error reports included, with the
  /// time at which the kernel got it. False: nothing more. For who records; frames are not to be received otherwise.
  bool record(RecordedFrame& recorded) noexcept;

 private:
  struct Batch {  // what one sendmmsg() or recvmmsg() points to; it points into itself
    std::array<canfd_frame, kBatch> frames{};
    std::array<iovec, kBatch> parts{};
    std::array<mmsghdr, kBatch> messages{};
  };
  void open(const std::string& interface, const std::vector<std::uint32_t>& ids, bool fd);
  void bound_waiting(int frames);
  void heed(const canfd_frame& error) noexcept;

  std::string interface_;
  int socket_ = -1;
  BusHealth health_ = BusHealth::kGood;
  LinkCounts counts_;
  Batch out_, in_;
};

}  // namespace pmg::can
