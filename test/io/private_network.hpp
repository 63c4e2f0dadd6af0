// A private network for a test: messages on it reach no other robot, test or host.
#pragma once

#include <gtest/gtest.h>
#include <net/if.h>
#include <net/route.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <functional>
#include <thread>

namespace pmg::io {

enum class Multicast { kNone, kOnLoopback };

namespace detail {

inline bool loopback_up(int socket) {
  ifreq loopback{};
  std::strcpy(loopback.ifr_name, "lo");
  loopback.ifr_flags = IFF_UP | IFF_RUNNING | IFF_LOOPBACK;
  return ::ioctl(socket, SIOCSIFFLAGS, &loopback) == 0;
}

inline bool route_multicast(int socket) {
  const auto address = [](std::uint32_t host_order, sockaddr& to) {
    sockaddr_in in{};
    in.sin_family = AF_INET;
    in.sin_addr.s_addr = htonl(host_order);
    std::memcpy(&to, &in, sizeof(in));
  };
  char loopback[] = "lo";
  rtentry route{};
  address(0xE0000000, route.rt_dst);  // 224.0.0.0/4
  address(0xF0000000, route.rt_genmask);
  route.rt_flags = RTF_UP;
  route.rt_dev = loopback;
  return ::ioctl(socket, SIOCADDRT, &route) == 0;
}

}  // namespace detail

/// Runs body in a thread with its own network namespace; processes that body starts are in it too. False if the system
/// doesn't permit it (it needs root): then skip the test, loudly.
[[nodiscard]] inline bool in_private_network(Multicast multicast, const std::function<void()>& body) {
  bool permitted = false;
  std::thread([&] {
    if (::unshare(CLONE_NEWNET) != 0) return;
    permitted = true;
    if (multicast == Multicast::kOnLoopback) {
      const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
      const bool ready = detail::loopback_up(socket) && detail::route_multicast(socket);
      ::close(socket);
      ASSERT_TRUE(ready) << std::strerror(errno);
    }
    body();
  }).join();
  return permitted;
}

}  // namespace pmg::io

/// As in_private_network, in a test.
#define PMG_IN_PRIVATE_NETWORK(multicast, ...)                                                  \
  if (!::pmg::io::in_private_network(multicast, __VA_ARGS__)) {                                 \
    GTEST_SKIP() << "NOT TESTED: a network namespace of its own needs root (or CAP_SYS_ADMIN)"; \
  }
