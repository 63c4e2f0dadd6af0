// LCM's network address, checked before liblcm gets it: liblcm prints many lines about a wrong address, and ends the
// process for some.
#pragma once

#include <netinet/in.h>

#include <cstdint>
#include <optional>
#include <string>

namespace pmg::io {

/// LCM's own group and port. TTL 0: no packet leaves this host unless the operator changes it.
inline constexpr const char* kDefaultLcmUrl = "udpm://239.255.76.67:7667?ttl=0";

/// The argument; if empty, the environment's LCM_DEFAULT_URL; without that, kDefaultLcmUrl.
std::string choose_lcm_url(const std::string& given);

/// Checks that liblcm can open this address, and returns it with all options. Accepted are
///   udpm://GROUP:PORT[?ttl=N&recv_buf_size=BYTES]  UDP multicast, on the robot and elsewhere
///   tcpq://HOST:PORT                               a relay server that answers within a second
///   memq://                                        within one LCM object, for tests
/// Throws std::invalid_argument for any other address, std::runtime_error if the network can't carry it. The error is
/// one line; for a missing multicast route it holds the command that adds the route.
std::string checked_lcm_url(const std::string& url);

/// The parts of a udpm:// address.
struct UdpmAddress {
  in_addr group{};
  std::uint16_t port = 0;
  int ttl = 0;
  int receive_buffer = 0;  ///< bytes
};

/// Nothing for another kind of address. url: as checked_lcm_url() returns it.
std::optional<UdpmAddress> udpm_address(const std::string& url);

/// False: messages on this address reach programs on this computer only (TTL 0, or within one object), and only theirs
/// are heard. url: as checked_lcm_url() takes it.
bool leaves_this_computer(const std::string& url);

}  // namespace pmg::io
