#include "can/socket_link.hpp"

#include <fmt/format.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace pmg::can {

namespace {

#ifndef CAN_ERR_CNT
#define CAN_ERR_CNT 0x00000200U
#endif

constexpr unsigned short kCanInterface = 280;  // ARPHRD_CAN; <linux/if_arp.h> and <net/if.h> can't be included together

[[noreturn]] void refuse(const std::string& interface, const std::string& wrong, const std::string& advice) {
  throw std::runtime_error(fmt::format("{}: {}; {}", interface, wrong, advice));
}

[[noreturn]] void refuse(const std::string& interface, const char* what) {
  refuse(interface, fmt::format("{}: {}", what, std::strerror(errno)), "expected a CAN interface that is up");
}

int make_socket(const std::string& interface) {
  const int made = socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  if (made >= 0) return made;
  if (errno == EAFNOSUPPORT || errno == EPROTONOSUPPORT) {
    refuse(interface, "this kernel has no CAN", "expected one with the modules can and can_raw (modprobe can_raw)");
  }
  if (errno == EPERM || errno == EACCES) refuse(interface, "no permission for CAN sockets", "expected CAP_NET_RAW");
  refuse(interface, "no CAN socket");
}

ifreq request(const std::string& interface) {
  ifreq ask{};
  if (interface.empty() || interface.size() >= sizeof ask.ifr_name)
    refuse(interface, "isn't the name of an interface", "expected 1 to 15 characters");
  std::memcpy(static_cast<char*>(ask.ifr_name), interface.data(), interface.size());
  return ask;
}

template <typename T>
void set(int socket, const std::string& interface, int option, const T& value, const char* what) {
  if (setsockopt(socket, SOL_CAN_RAW, option, &value, sizeof value) != 0) refuse(interface, what);
}

}  // namespace

SocketLink::SocketLink(const std::string& interface, const std::vector<std::uint32_t>& ids, bool fd, int most_waiting)
    : interface_(interface) {
  for (Batch* batch : {&out_, &in_}) {
    for (std::size_t i = 0; i < kBatch; ++i) {
      batch->parts[i] = {.iov_base = &batch->frames[i], .iov_len = sizeof(canfd_frame)};
      batch->messages[i].msg_hdr.msg_iov = &batch->parts[i];
      batch->messages[i].msg_hdr.msg_iovlen = 1;
    }
  }
  try {
    open(interface, ids, fd);
    if (most_waiting > 0) bound_waiting(most_waiting);
  } catch (...) {
    if (socket_ >= 0) close(socket_);
    throw;
  }
}

SocketLink::~SocketLink() { close(socket_); }

void SocketLink::open(const std::string& interface, const std::vector<std::uint32_t>& ids, bool fd) {
  ifreq ask = request(interface);
  socket_ = make_socket(interface);
  if (ioctl(socket_, SIOCGIFINDEX, &ask) != 0) {
    refuse(interface, "no such interface", fmt::format("expected a CAN interface (ip link show type can)"));
  }
  const int index = ask.ifr_ifindex;
  if (ioctl(socket_, SIOCGIFHWADDR, &ask) != 0 || ask.ifr_hwaddr.sa_family != kCanInterface) {
    refuse(interface, "isn't a CAN interface", "expected one of `ip link show type can`");
  }
  if (ioctl(socket_, SIOCGIFFLAGS, &ask) != 0 || (static_cast<unsigned>(ask.ifr_flags) & IFF_UP) == 0) {
    refuse(interface, "is down",
           fmt::format("expected it up: ip link set {} up type can bitrate ... restart-ms 100", interface));
  }
  if (fd) {
    if (ioctl(socket_, SIOCGIFMTU, &ask) != 0 || ask.ifr_mtu < static_cast<int>(CANFD_MTU)) {
      refuse(interface, "carries no CAN FD", "expected an interface with `fd on`");
    }
    set(socket_, interface, CAN_RAW_FD_FRAMES, 1, "CAN FD");
  }
  if (!ids.empty()) {
    std::vector<can_filter> filters;
    for (const std::uint32_t id : ids)
      filters.push_back({.can_id = id, .can_mask = CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG});
    if (setsockopt(socket_, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(),
                   static_cast<socklen_t>(filters.size() * sizeof(can_filter))) != 0) {
      refuse(interface, "receive filter");
    }
  }
  const int stamps = 1;
  if (setsockopt(socket_, SOL_SOCKET, SO_TIMESTAMPNS, &stamps, sizeof stamps) != 0) refuse(interface, "time stamps");
  set(socket_, interface, CAN_RAW_ERR_FILTER, can_err_mask_t{CAN_ERR_MASK}, "error frames");
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = index;
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) refuse(interface, "bind");
}

// A kernel charges a socket for each frame that waits with the memory of its sk_buff: 704 to 832 bytes, classic and FD
// alike (Linux 5.10 to 6.12, 64 bits). It doubles what it is told, and takes one frame more once it is beyond it.
void SocketLink::bound_waiting(int frames) {
  constexpr int kCharge_bytes = 768;
  const int half = frames * kCharge_bytes / 2;
  if (setsockopt(socket_, SOL_SOCKET, SO_SNDBUF, &half, sizeof half) != 0) refuse(interface_, "room of the send queue");
}

std::size_t SocketLink::send(std::span<const drives::Message> frames) noexcept {
  const std::size_t all = frames.size();
  while (!frames.empty()) {
    const std::size_t count = std::min(frames.size(), kBatch);
    for (std::size_t i = 0; i < count; ++i) {
      const drives::Message& frame = frames[i];
      canfd_frame& raw = out_.frames[i];
      raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U);
      raw.len = frame.length;
      raw.flags = frame.fd ? CANFD_BRS : 0;
      std::memcpy(static_cast<unsigned char*>(raw.data), frame.data.data(), frame.fd ? 64 : 8);
      out_.parts[i].iov_len = frame.fd ? CANFD_MTU : CAN_MTU;
    }
    const int sent = sendmmsg(socket_, out_.messages.data(), static_cast<unsigned>(count), MSG_DONTWAIT);
    if (sent > 0) {
      counts_.sent += static_cast<std::uint64_t>(sent);
      frames = frames.subspan(static_cast<std::size_t>(sent));
      continue;
    }
    if (errno == EINTR) continue;
    if (errno == ENETDOWN || errno == ENODEV || errno == ENXIO) health_ = BusHealth::kOff;
    counts_.not_sent += frames.size();  // full queue: newer commands follow in 2 ms
    break;
  }
  return all - frames.size();
}

std::size_t SocketLink::receive(std::span<drives::Message> frames) noexcept {
  std::size_t taken = 0;
  while (taken < frames.size()) {
    const unsigned count = static_cast<unsigned>(std::min(frames.size() - taken, kBatch));
    const int got = recvmmsg(socket_, in_.messages.data(), count, MSG_DONTWAIT, nullptr);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && (errno == ENETDOWN || errno == ENODEV)) health_ = BusHealth::kOff;
    if (got <= 0) break;
    for (int i = 0; i < got; ++i) {
      const canfd_frame& raw = in_.frames[static_cast<std::size_t>(i)];
      const std::size_t size = in_.messages[static_cast<std::size_t>(i)].msg_len;
      if (size != CAN_MTU && size != CANFD_MTU) continue;
      if ((raw.can_id & CAN_ERR_FLAG) != 0) {
        heed(raw);
        continue;
      }
      if ((raw.can_id & CAN_RTR_FLAG) != 0) continue;
      health_ = BusHealth::kGood;
      ++counts_.received;
      drives::Message& frame = frames[taken++];
      frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
      frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
      frame.fd = size == CANFD_MTU;
      frame.length = std::min<std::uint8_t>(raw.len, frame.fd ? 64 : 8);
      std::memcpy(frame.data.data(), static_cast<const unsigned char*>(raw.data), frame.fd ? 64 : 8);
    }
    if (static_cast<unsigned>(got) < count) break;
  }
  return taken;
}

bool SocketLink::record(RecordedFrame& recorded) noexcept {
  canfd_frame raw{};
  iovec part{.iov_base = &raw, .iov_len = sizeof raw};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(timespec))> control{};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  ssize_t got = -1;
  do {
    got = recvmsg(socket_, &message, MSG_DONTWAIT);
  } while (got < 0 && errno == EINTR);
  if (got != static_cast<ssize_t>(CAN_MTU) && got != static_cast<ssize_t>(CANFD_MTU)) return false;
  recorded.stamp_ns = 0;
  for (cmsghdr* part_of = CMSG_FIRSTHDR(&message); part_of != nullptr; part_of = CMSG_NXTHDR(&message, part_of)) {
    if (part_of->cmsg_level != SOL_SOCKET || part_of->cmsg_type != SCM_TIMESTAMPNS) continue;
    timespec stamp{};
    std::memcpy(&stamp, CMSG_DATA(part_of), sizeof stamp);
    recorded.stamp_ns = static_cast<std::int64_t>(stamp.tv_sec) * 1'000'000'000 + stamp.tv_nsec;
  }
  recorded.interface = interface_;
  using Kind = RecordedFrame::Kind;
  recorded.kind = (raw.can_id & CAN_ERR_FLAG) != 0   ? Kind::kError
                  : (raw.can_id & CAN_RTR_FLAG) != 0 ? Kind::kRemote
                                                     : Kind::kData;
  if (recorded.kind == Kind::kError) heed(raw);
  drives::Message& frame = recorded.frame;
  frame.fd = got == static_cast<ssize_t>(CANFD_MTU);
  frame.extended = recorded.kind != Kind::kError && (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.id = raw.can_id & (frame.extended || recorded.kind == Kind::kError ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.length = std::min<std::uint8_t>(raw.len, frame.fd ? 64 : 8);
  std::memcpy(frame.data.data(), static_cast<const unsigned char*>(raw.data), frame.fd ? 64 : 8);
  ++counts_.received;
  return true;
}

// Error classes: linux/can/error.h. Kernels from 6.0 on say with CAN_ERR_CNT that bytes 6 and 7 are the counters.
void SocketLink::heed(const canfd_frame& error) noexcept {
  ++counts_.error_frames;
  if ((error.can_id & CAN_ERR_ACK) != 0) ++counts_.ack_errors;
  if ((error.can_id & (CAN_ERR_CRTL | CAN_ERR_CNT)) != 0) {
    counts_.sending_errors = error.data[6];
    counts_.receiving_errors = error.data[7];
  }
  if ((error.can_id & CAN_ERR_BUSOFF) != 0) {
    ++counts_.bus_offs;
    health_ = BusHealth::kOff;
  } else if ((error.can_id & CAN_ERR_RESTARTED) != 0) {
    health_ = BusHealth::kGood;
  } else if ((error.can_id & CAN_ERR_CRTL) != 0) {
    if ((error.data[1] & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) health_ = BusHealth::kPassive;
    if ((error.data[1] & CAN_ERR_CRTL_ACTIVE) != 0) health_ = BusHealth::kGood;
  }
}

}  // namespace pmg::can
