// A private network for a test: messages on it reach no other robot, test or host.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <net/if.h>
#include <net/route.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>
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

/// Another computer: a network of its own, joined to the calling thread's private network by a virtual wire. Multicast
/// leaves over the wire on both sides.
class SecondComputer {
 public:
  SecondComputer() {
    const std::string here = std::to_string(::gettid());
    bool there = false;
    std::thread([&] {
      if (::unshare(CLONE_NEWNET) != 0) return;
      network_ = ::open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC);
      there = commanded("ip link set lo up && ip link add wire1 type veth peer name wire0 netns " + here +
                        " && ip addr add 10.9.0.2/24 dev wire1 && ip link set wire1 up && "
                        "ip route add 224.0.0.0/4 dev wire1");
    }).join();
    wired_ = there && commanded(
                          "ip addr add 10.9.0.1/24 dev wire0 && ip link set wire0 up && "
                          "ip route replace 224.0.0.0/4 dev wire0");
  }
  ~SecondComputer() {
    if (network_ >= 0) ::close(network_);
  }
  SecondComputer(const SecondComputer&) = delete;
  SecondComputer& operator=(const SecondComputer&) = delete;

  bool wired() const { return wired_; }  ///< false: the kernel makes no virtual wire
  /// Runs body in a thread on the other computer; processes that body starts are there, too.
  void inside(const std::function<void()>& body) const {
    std::thread([&] {
      ASSERT_EQ(::setns(network_, CLONE_NEWNET), 0) << std::strerror(errno);
      body();
    }).join();
  }

 private:
  static bool commanded(const std::string& line) { return std::system(line.c_str()) == 0; }

  int network_ = -1;
  bool wired_ = false;
};

}  // namespace pmg::io

/// As in_private_network, in a test.
#define PMG_IN_PRIVATE_NETWORK(multicast, ...)                                                  \
  if (!::pmg::io::in_private_network(multicast, __VA_ARGS__)) {                                 \
    GTEST_SKIP() << "NOT TESTED: a network namespace of its own needs root (or CAP_SYS_ADMIN)"; \
  }
