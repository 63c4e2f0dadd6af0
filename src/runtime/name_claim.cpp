#include "runtime/name_claim.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace pmg::runtime {

namespace {

/// FNV-1a, for names that don't fit a socket's address.
std::uint64_t digest(std::string_view text) noexcept {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return hash;
}

/// GROUP:PORT of udpm://, whatever its options are; other addresses whole.
std::string place_of(const std::string& lcm_url) { return lcm_url.substr(0, lcm_url.find('?')); }

/// The process that listens there; 0: unknown.
pid_t holder_of(const sockaddr& address, socklen_t length) noexcept {
  const int probe = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  ucred holder{};
  socklen_t size = sizeof(holder);
  if (probe < 0 || ::connect(probe, &address, length) != 0 ||
      ::getsockopt(probe, SOL_SOCKET, SO_PEERCRED, &holder, &size) != 0) {
    holder.pid = 0;
  }
  if (probe >= 0) ::close(probe);
  return holder.pid;
}

}  // namespace

NameLock::NameLock(const std::string& name, const std::string& lcm_url) {
  const std::string text = fmt::format("pmg-controller:{:016x}:{:.40}", digest(place_of(lcm_url) + '\n' + name), name);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path + 1, text.data(), text.size());  // the first byte stays 0: abstract
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + text.size());
  const auto* any = reinterpret_cast<const sockaddr*>(&address);
  fd_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (fd_ >= 0 && ::bind(fd_, any, length) == 0 && ::listen(fd_, 1) == 0) return;
  const int error = errno;
  if (fd_ >= 0) ::close(fd_);
  if (error != EADDRINUSE)
    throw std::runtime_error(fmt::format("robot \"{}\": no lock on its name: {}", name, std::strerror(error)));
  throw std::runtime_error(fmt::format(
      "robot \"{}\" is already run by another controller on this computer (process {}) on {}: end that one, or "
      "start this one with another --name or --lcm-url",
      name, holder_of(*any, length), lcm_url));
}

NameLock::~NameLock() { ::close(fd_); }

HeldClaim::HeldClaim(std::function<void()> answer)
    : thread_([answer = std::move(answer)](const std::stop_token& stop) {
        while (!stop.stop_requested()) answer();
      }) {}

}  // namespace pmg::runtime
