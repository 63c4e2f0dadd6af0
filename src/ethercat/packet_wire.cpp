#include "ethercat/packet_wire.hpp"

#include <arpa/inet.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <stdexcept>

#ifndef PACKET_IGNORE_OUTGOING
#define PACKET_IGNORE_OUTGOING 23
#endif

namespace pmg::ethercat {

namespace {

constexpr std::uint16_t kEtherType = 0x88A4;

std::string error_text() { return std::strerror(errno); }

}  // namespace

PacketWire::PacketWire(const std::string& interface) {
  const auto fail = [&](const std::string& what) {
    if (socket_ >= 0) close(socket_);
    throw std::runtime_error(interface + ": " + what);
  };
  const unsigned index = if_nametoindex(interface.c_str());
  if (index == 0) fail("no such interface; expected the network card of the EtherCAT slaves");
  socket_ = socket(AF_PACKET, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, htons(kEtherType));
  if (socket_ < 0)
    fail(errno == EPERM || errno == EACCES ? "no permission for raw sockets; expected CAP_NET_RAW"
                                           : "no raw socket: " + error_text());
  ifreq request{};
  std::copy_n(interface.begin(), std::min<std::size_t>(interface.size(), IFNAMSIZ - 1), request.ifr_name);
  if (ioctl(socket_, SIOCGIFFLAGS, &request) != 0) fail("no flags: " + error_text());
  if ((request.ifr_flags & IFF_UP) == 0) fail("is down; expected it up (ip link set " + interface + " up)");
  const int on = 1;
  setsockopt(socket_, SOL_PACKET, PACKET_IGNORE_OUTGOING, &on, sizeof on);  // kernels before 4.20 send none back either
  packet_mreq all{};
  all.mr_ifindex = static_cast<int>(index);
  all.mr_type = PACKET_MR_PROMISC;  // frames come back with the sender's own address, changed by the first slave
  setsockopt(socket_, SOL_PACKET, PACKET_ADD_MEMBERSHIP, &all, sizeof all);
  sockaddr_ll address{};
  address.sll_family = AF_PACKET;
  address.sll_protocol = htons(kEtherType);
  address.sll_ifindex = static_cast<int>(index);
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) fail(error_text());
}

PacketWire::~PacketWire() { close(socket_); }

bool PacketWire::send(std::span<const std::uint8_t> frame) noexcept {
  return ::send(socket_, frame.data(), frame.size(), 0) == static_cast<ssize_t>(frame.size());
}

std::size_t PacketWire::receive(std::span<std::uint8_t> frame, std::int64_t wait_ns) noexcept {
  const auto take = [&]() -> std::size_t {
    const ssize_t bytes = recv(socket_, frame.data(), frame.size(), MSG_TRUNC);
    return bytes > 0 && static_cast<std::size_t>(bytes) <= frame.size() ? static_cast<std::size_t>(bytes) : 0;
  };
  if (const std::size_t bytes = take()) return bytes;
  if (wait_ns <= 0) return 0;
  pollfd polled{.fd = socket_, .events = POLLIN, .revents = 0};
  const timespec timeout{.tv_sec = wait_ns / 1'000'000'000, .tv_nsec = wait_ns % 1'000'000'000};
  return ppoll(&polled, 1, &timeout, nullptr) > 0 ? take() : 0;
}

}  // namespace pmg::ethercat
