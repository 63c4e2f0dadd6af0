#include "io/multicast_receiver.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "io/clock.hpp"

namespace pmg::io {

namespace {

constexpr std::int64_t kAddressesAge_ns = 1'000'000'000;  // an unknown sender makes us read them again after this time

[[noreturn]] void fail(const std::string& url, const std::string& what, int error) {
  throw std::runtime_error("LCM address \"" + url + "\": " + what + ": " + std::strerror(error));
}

std::vector<std::uint32_t> own_addresses() noexcept {
  std::vector<std::uint32_t> addresses;
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) return addresses;
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    if (entry->ifa_addr == nullptr || entry->ifa_addr->sa_family != AF_INET) continue;
    sockaddr_in in{};
    std::memcpy(&in, entry->ifa_addr, sizeof(in));
    addresses.push_back(in.sin_addr.s_addr);
  }
  ::freeifaddrs(list);
  return addresses;
}

/// The kernel takes datagrams with these senders from no wire. 0.0.0.0: this computer has no address of its own; from a
/// wire it comes only to the groups 224.0.0.0/24.
bool only_from_here(const in_addr& sender, const in_addr& group) noexcept {
  const bool link_local_group = ntohl(group.s_addr) >> 8 == 0xE00000;
  return ntohl(sender.s_addr) >> 24 == IN_LOOPBACKNET || (sender.s_addr == htonl(INADDR_ANY) && !link_local_group);
}

}  // namespace

MulticastReceiver::MulticastReceiver(const std::string& url, const UdpmAddress& address)
    : this_computer_only_(address.ttl == 0), group_(address.group) {
  fd_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd_ < 0) fail(url, "no socket to be had", errno);
  const auto attempt = [&](int result, const char* what) {
    if (result == 0) return;
    const int error = errno;
    ::close(fd_);
    fail(url, what, error);
  };
  const int yes = 1;
  attempt(::setsockopt(fd_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes)), "the port can't be shared");
  ::setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &address.receive_buffer, sizeof(address.receive_buffer));
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(address.port);
  group.sin_addr = address.group;
  sockaddr any{};
  std::memcpy(&any, &group, sizeof(group));
  attempt(::bind(fd_, &any, sizeof(group)), "the group can't be heard");
  ip_mreq membership{};
  membership.imr_multiaddr = address.group;
  membership.imr_interface.s_addr = htonl(INADDR_ANY);
  attempt(::setsockopt(fd_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof(membership)),
          "the group can't be joined");
}

MulticastReceiver::~MulticastReceiver() { ::close(fd_); }

bool MulticastReceiver::wait(int timeout_ms) noexcept {
  pollfd waits{.fd = fd_, .events = POLLIN, .revents = 0};
  return ::poll(&waits, 1, timeout_ms) > 0;
}

bool MulticastReceiver::take(std::optional<LcmMessage>& message) noexcept {
  message.reset();
  sockaddr_in sender{};
  sockaddr any{};
  socklen_t length = sizeof(any);
  const ssize_t size = ::recvfrom(fd_, datagram_.data(), datagram_.size(), 0, &any, &length);
  if (size < 0) {
    if (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR) ++errors_;
    return false;
  }
  std::memcpy(&sender, &any, sizeof(sender));
  if (this_computer_only_ && !from_here(sender.sin_addr)) {
    ++from_elsewhere_;
    return true;
  }
  const std::uint64_t key = std::uint64_t{sender.sin_addr.s_addr} << 16 | sender.sin_port;
  message = assembler_.take(key, Bytes(datagram_).first(static_cast<std::size_t>(size)));
  return true;
}

bool MulticastReceiver::from_here(const in_addr& sender) noexcept {
  if (only_from_here(sender, group_)) return true;
  // The kernel drops a datagram from a wire whose sender is one of its own addresses, too.
  if (std::ranges::find(addresses_, sender.s_addr) != addresses_.end()) return true;
  const std::int64_t now_ns = WallClock().now_ns();
  if (addresses_read_ns_ != 0 && now_ns - addresses_read_ns_ < kAddressesAge_ns) return false;
  addresses_read_ns_ = now_ns;
  addresses_ = own_addresses();
  return std::ranges::find(addresses_, sender.s_addr) != addresses_.end();
}

}  // namespace pmg::io
