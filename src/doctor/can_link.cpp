#include "doctor/can_link.hpp"

#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

namespace pmg::doctor {

namespace {

using Bytes = std::span<const std::byte>;

constexpr std::size_t kLargestAnswer = 32768;  // the kernel's own bound of a netlink message of one link

constexpr std::size_t aligned(std::size_t length) { return (length + 3) / 4 * 4; }

template <typename T>
bool read(Bytes bytes, T& value) noexcept {
  if (bytes.size() < sizeof value) return false;
  std::memcpy(&value, bytes.data(), sizeof value);
  return true;
}

/// Calls visit(type, payload) for each attribute; a length that isn't possible ends it.
template <typename Visit>
void for_each_attribute(Bytes bytes, Visit&& visit) {
  rtattr head{};
  while (read(bytes, head) && head.rta_len >= sizeof head && head.rta_len <= bytes.size()) {
    visit(head.rta_type & ~static_cast<unsigned>(NLA_F_NESTED), bytes.subspan(sizeof head, head.rta_len - sizeof head));
    bytes = bytes.subspan(std::min(aligned(head.rta_len), bytes.size()));
  }
}

void read_timing(Bytes bytes, CanTiming& timing) noexcept {
  can_bittiming raw{};
  if (read(bytes, raw)) timing = {.bitrate = raw.bitrate, .sample_permille = raw.sample_point};
}

void read_can(Bytes data, CanLink& link) noexcept {
  for_each_attribute(data, [&link](unsigned type, Bytes value) {
    std::uint32_t number = 0;
    if (type == IFLA_CAN_BITTIMING) read_timing(value, link.arbitration);
    if (type == IFLA_CAN_DATA_BITTIMING) read_timing(value, link.data);
    if (type == IFLA_CAN_STATE && read(value, number)) link.state = number;
    if (type == IFLA_CAN_RESTART_MS && read(value, number)) link.restart_ms = number;
  });
}

struct Socket {
  Socket() : fd(::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE)) {}
  ~Socket() {
    if (fd >= 0) ::close(fd);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int fd;
};

}  // namespace

std::optional<CanLink> parse_can_link(Bytes message) noexcept {
  nlmsghdr head{};
  if (!read(message, head) || head.nlmsg_type != RTM_NEWLINK || head.nlmsg_len > message.size()) return std::nullopt;
  constexpr std::size_t kBody = aligned(sizeof(nlmsghdr)) + aligned(sizeof(ifinfomsg));
  if (head.nlmsg_len < kBody) return std::nullopt;
  CanLink link;
  for_each_attribute(message.subspan(kBody, head.nlmsg_len - kBody), [&link](unsigned type, Bytes value) {
    if (type != IFLA_LINKINFO) return;
    Bytes data;
    for_each_attribute(value, [&](unsigned inner, Bytes of) {
      if (inner == IFLA_INFO_KIND) {
        const std::string_view text(reinterpret_cast<const char*>(of.data()), of.size());
        link.kind = text.substr(0, text.find('\0'));
      }
      if (inner == IFLA_INFO_DATA) data = of;
    });
    if (link.kind == "can") read_can(data, link);
  });
  return link;
}

std::optional<CanLink> ask_can_link(const std::string& interface, int& error) {
  struct {
    nlmsghdr head;
    ifinfomsg body;
  } request{};
  request.head.nlmsg_len = sizeof request;
  request.head.nlmsg_type = RTM_GETLINK;
  request.head.nlmsg_flags = NLM_F_REQUEST;
  request.body.ifi_index = static_cast<int>(if_nametoindex(interface.c_str()));
  error = ENODEV;
  if (request.body.ifi_index == 0) return std::nullopt;
  const Socket socket;
  alignas(nlmsghdr) std::array<std::byte, kLargestAnswer> answer{};
  ssize_t size = -1;
  if (socket.fd >= 0 && ::send(socket.fd, &request, sizeof request, 0) == static_cast<ssize_t>(sizeof request))
    size = ::recv(socket.fd, answer.data(), answer.size(), 0);
  error = size < 0 ? errno : EPROTO;
  return size < 0 ? std::nullopt : parse_can_link(Bytes(answer).first(static_cast<std::size_t>(size)));
}

}  // namespace pmg::doctor
