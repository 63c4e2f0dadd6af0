#include "can/bus_claim.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <utility>

namespace pmg::can {

namespace {

/// A name without a file: the kernel forgets it when its program ends, however it ends.
struct Address {
  sockaddr_un name{};
  socklen_t size = 0;
  explicit Address(const std::string& interface) {
    const std::string text = "pmg-bus/" + interface;
    name.sun_family = AF_UNIX;
    const std::size_t count = std::min(text.size(), sizeof name.sun_path - 1);
    std::copy_n(text.begin(), count, static_cast<char*>(name.sun_path) + 1);
    size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + count);
  }
  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&name); }
};

int make_socket() { return socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0); }

constexpr int kAskers = 64;  // those after it are told of "another program"

/// "pmg_controller (process 4711)", as far as that can be known.
std::string holder(const Address& address) {
  const int asking = make_socket();
  ucred peer{};
  socklen_t size = sizeof peer;
  const bool known = asking >= 0 && connect(asking, address.get(), address.size) == 0 &&
                     getsockopt(asking, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 && peer.pid > 0;
  if (asking >= 0) close(asking);
  if (!known) return "another program";
  std::string name;
  std::ifstream comm(fmt::format("/proc/{}/comm", peer.pid));
  if (!std::getline(comm, name)) return fmt::format("process {}", peer.pid);
  return fmt::format("{} (process {})", name, peer.pid);
}

}  // namespace

BusClaim::BusClaim(const std::string& interface) : socket_(make_socket()) {
  const Address address(interface);
  if (socket_ >= 0 && bind(socket_, address.get(), address.size) == 0 && listen(socket_, kAskers) == 0) return;
  const int error = errno;
  if (socket_ >= 0) close(socket_);
  if (error == EADDRINUSE) {
    throw BusIsDriven(fmt::format("{}: {} drives it; expected nobody else", interface, holder(address)));
  }
  throw std::runtime_error(fmt::format("{}: can't be claimed: {}", interface, std::strerror(error)));
}

BusClaim::~BusClaim() {
  if (socket_ >= 0) close(socket_);
}

BusClaim::BusClaim(BusClaim&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}

}  // namespace pmg::can
