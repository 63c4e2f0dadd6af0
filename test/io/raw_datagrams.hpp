// Datagrams to LCM's default group as nobody's LCM sends them, and the address for whoever listens there.
#pragma once

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <string>
#include <vector>

namespace pmg::io {

/// 239.255.76.67:7667
inline sockaddr_in default_group() {
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(7667);
  group.sin_addr.s_addr = htonl(0xEFFF4C43);
  return group;
}

inline sockaddr any_address(const sockaddr_in& address) {
  sockaddr any{};
  std::memcpy(&any, &address, sizeof(address));
  return any;
}

/// All from one sender: fragments of several senders are no message.
inline void send_datagrams(const std::vector<std::string>& datagrams) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  const sockaddr group = any_address(default_group());
  for (const std::string& bytes : datagrams) {
    EXPECT_EQ(::sendto(socket, bytes.data(), bytes.size(), 0, &group, sizeof(group)),
              static_cast<ssize_t>(bytes.size()));
  }
  ::close(socket);
}

}  // namespace pmg::io
