// The network address that LCM speaks on, checked before liblcm sees it: liblcm prints many lines about a wrong one,
// and ends the process on some.
#pragma once

#include <string>

namespace pmg::io {

/// LCM's own group and port; TTL 0: no packet leaves this host unless the operator says so.
inline constexpr const char* kDefaultLcmUrl = "udpm://239.255.76.67:7667?ttl=0";

/// given unless empty, else the environment's LCM_DEFAULT_URL, else kDefaultLcmUrl.
std::string choose_lcm_url(const std::string& given);

/// Makes sure that liblcm can open this address, and returns it with the options that it is opened with. Accepted are
///   udpm://GROUP:PORT[?ttl=N&recv_buf_size=BYTES]  UDP multicast, on the robot and everywhere else
///   tcpq://HOST:PORT                               a server that relays, if it answers within a second
///   memq://                                        within one object, for tests
/// Throws std::invalid_argument for an address that is none of these, std::runtime_error when the network lacks what it
/// needs: one line that says what, and for a missing multicast route the command that adds it.
std::string checked_lcm_url(const std::string& url);

}  // namespace pmg::io
