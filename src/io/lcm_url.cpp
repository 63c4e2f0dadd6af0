#include "io/lcm_url.hpp"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace pmg::io {

namespace {

/// Enough for bursts of 100 Hz topics on a busy host. The kernel grants at most net.core.rmem_max.
constexpr const char* kReceiveBuffer = "recv_buf_size=4194304";
constexpr int kServerAnswers_s = 1;

struct Address {
  std::string host;
  int port = 0;
};

class Socket {
 public:
  Socket(int family, int type) : fd_(::socket(family, type | SOCK_CLOEXEC, 0)) {}
  ~Socket() {
    if (fd_ >= 0) ::close(fd_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int fd() const { return fd_; }

 private:
  int fd_;
};

[[noreturn]] void refuse(const std::string& url, const std::string& why) {
  throw std::invalid_argument("LCM address \"" + url + "\": " + why);
}
[[noreturn]] void fail(const std::string& url, const std::string& why) {
  throw std::runtime_error("LCM address \"" + url + "\": " + why);
}

std::optional<long> whole_number(std::string_view text, long lowest, long highest) {
  long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < lowest || value > highest) return {};
  return value;
}

Address parse_address(const std::string& url, std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos || colon == 0)
    refuse(url, "expected HOST:PORT, as in " + std::string(kDefaultLcmUrl));
  const auto port = whole_number(text.substr(colon + 1), 1, 65535);
  if (!port) refuse(url, "expected a port from 1 to 65535");
  return {std::string(text.substr(0, colon)), static_cast<int>(*port)};
}

/// True if the options hold the size of the receive buffer.
bool check_options(const std::string& url, std::string_view options) {
  bool sized = false;
  while (!options.empty()) {
    const std::size_t end = options.find('&');
    const std::string_view option = options.substr(0, end);
    options = end == std::string_view::npos ? std::string_view{} : options.substr(end + 1);
    const std::size_t equals = option.find('=');
    const std::string_view name = option.substr(0, equals);
    const std::string_view value = equals == std::string_view::npos ? std::string_view{} : option.substr(equals + 1);
    if (name == "ttl") {
      if (!whole_number(value, 0, 255)) refuse(url, "expected ttl from 0 (this host only) to 255");
    } else if (name == "recv_buf_size") {
      if (!whole_number(value, 1, 1L << 30)) refuse(url, "expected recv_buf_size in bytes, at most 1073741824");
      sized = true;
    } else {
      refuse(url, "unknown option \"" + std::string(option) + "\"; expected ttl or recv_buf_size");
    }
  }
  return sized;
}

void require_multicast_route(const std::string& url, const sockaddr_in& group) {
  const Socket probe(AF_INET, SOCK_DGRAM);
  ip_mreq membership{};
  membership.imr_multiaddr = group.sin_addr;
  membership.imr_interface.s_addr = htonl(INADDR_ANY);
  sockaddr address{};
  std::memcpy(&address, &group, sizeof(group));
  if (probe.fd() >= 0 && ::connect(probe.fd(), &address, sizeof(group)) == 0 &&
      ::setsockopt(probe.fd(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof(membership)) == 0) {
    return;
  }
  const int error = errno;
  if (error != ENETUNREACH && error != ENODEV) fail(url, std::strerror(error));
  fail(url,
       "this host (or network namespace) has no route for multicast; as root: "
       "ip link set lo up; ip route add 224.0.0.0/4 dev lo");
}

void check_multicast(const std::string& url, const Address& address) {
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(static_cast<std::uint16_t>(address.port));
  if (::inet_pton(AF_INET, address.host.c_str(), &group.sin_addr) != 1 || !IN_MULTICAST(ntohl(group.sin_addr.s_addr))) {
    refuse(url, "expected a multicast group from 224.0.0.0 to 239.255.255.255, not \"" + address.host + "\"");
  }
  require_multicast_route(url, group);
}

/// Connects and greets as liblcm does, because another kind of server may listen on this port.
bool answers(const sockaddr_in& server) {
  constexpr std::uint32_t kClientMagic = 0x287617fb, kServerMagic = 0x287617fa, kProtocolVersion = 0x0100;
  const Socket probe(AF_INET, SOCK_STREAM);
  const timeval patience{.tv_sec = kServerAnswers_s, .tv_usec = 0};
  ::setsockopt(probe.fd(), SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof(patience));  // bounds connect() too
  ::setsockopt(probe.fd(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  sockaddr address{};
  std::memcpy(&address, &server, sizeof(server));
  const std::array<std::uint32_t, 2> greeting = {htonl(kClientMagic), htonl(kProtocolVersion)};
  std::uint32_t magic = 0;
  return probe.fd() >= 0 && ::connect(probe.fd(), &address, sizeof(server)) == 0 &&
         ::send(probe.fd(), greeting.data(), sizeof(greeting), MSG_NOSIGNAL) == sizeof(greeting) &&
         ::recv(probe.fd(), &magic, sizeof(magic), MSG_WAITALL) == sizeof(magic) && ntohl(magic) == kServerMagic;
}

/// The address with a numeric host: liblcm resolves no names, and ends the process if no server answers.
std::string check_server(const std::string& url, const Address& address) {
  addrinfo hints{};
  hints.ai_family = AF_INET;  // liblcm tries IPv4 only
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (::getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &hints, &found) != 0) {
    fail(url, "no host \"" + address.host + "\" is known");
  }
  sockaddr_in server{};
  std::memcpy(&server, found->ai_addr, sizeof(server));
  ::freeaddrinfo(found);
  if (!answers(server)) fail(url, "no LCM server answers there; start lcm-tcpq-server, or use a udpm:// address");
  std::array<char, INET_ADDRSTRLEN> number{};
  ::inet_ntop(AF_INET, &server.sin_addr, number.data(), number.size());
  return "tcpq://" + std::string(number.data()) + ":" + std::to_string(address.port);
}

/// The value of an option of this name; the last one counts, as for liblcm.
std::optional<long> option_of(std::string_view url, std::string_view name) {
  std::optional<long> value;
  const std::size_t question = url.find('?');
  std::string_view options = question == std::string_view::npos ? std::string_view{} : url.substr(question + 1);
  while (!options.empty()) {
    const std::size_t end = options.find('&');
    const std::string_view option = options.substr(0, end);
    options = end == std::string_view::npos ? std::string_view{} : options.substr(end + 1);
    if (option.starts_with(name) && option.substr(name.size()).starts_with('=')) {
      value = whole_number(option.substr(name.size() + 1), 0, 1L << 30);
    }
  }
  return value;
}

}  // namespace

std::string choose_lcm_url(const std::string& given) {
  if (!given.empty()) return given;
  const char* environment = std::getenv("LCM_DEFAULT_URL");
  return environment != nullptr && *environment != '\0' ? environment : kDefaultLcmUrl;
}

std::string checked_lcm_url(const std::string& url) {
  const std::string_view text = url;
  const std::size_t scheme_end = text.find("://");
  const std::string_view scheme = text.substr(0, scheme_end);
  if (scheme_end == std::string_view::npos || (scheme != "udpm" && scheme != "tcpq" && scheme != "memq")) {
    refuse(url, "expected udpm://GROUP:PORT, tcpq://HOST:PORT or memq://, as in " + std::string(kDefaultLcmUrl));
  }
  const std::string_view rest = text.substr(scheme_end + 3);
  const std::size_t question = rest.find('?');
  const std::string_view address = rest.substr(0, question);
  const std::string_view options = question == std::string_view::npos ? std::string_view{} : rest.substr(question + 1);
  if (scheme != "udpm") {
    if (!options.empty()) refuse(url, "only udpm:// takes options");
    if (scheme == "tcpq") return check_server(url, parse_address(url, address));
    if (scheme == "memq" && !address.empty()) refuse(url, "memq:// takes no address");
    return url;
  }
  const bool sized = check_options(url, options);
  check_multicast(url, parse_address(url, address));
  if (sized) return url;
  return url + (question == std::string_view::npos ? "?" : options.empty() ? "" : "&") + kReceiveBuffer;
}

std::optional<UdpmAddress> udpm_address(const std::string& url) {
  constexpr std::string_view kScheme = "udpm://";
  if (!url.starts_with(kScheme)) return std::nullopt;
  const Address address =
      parse_address(url, std::string_view(url).substr(kScheme.size(), url.find('?') - kScheme.size()));
  UdpmAddress parts{.port = static_cast<std::uint16_t>(address.port),
                    .ttl = static_cast<int>(option_of(url, "ttl").value_or(0)),
                    .receive_buffer = static_cast<int>(option_of(url, "recv_buf_size").value_or(0))};
  ::inet_pton(AF_INET, address.host.c_str(), &parts.group);
  return parts;
}

bool leaves_this_computer(const std::string& url) {
  return url.starts_with("tcpq://") || (url.starts_with("udpm://") && option_of(url, "ttl").value_or(0) > 0);
}

}  // namespace pmg::io
