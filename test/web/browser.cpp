#include "web/browser.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <openssl/x509.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <utility>

namespace pmg::test {

Browser::Browser(std::uint16_t port, bool tls, int receive_buffer_bytes) {
  std::signal(SIGPIPE, SIG_IGN);
  fd_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (receive_buffer_bytes > 0)
    setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receive_buffer_bytes, sizeof receive_buffer_bytes);
  const timeval patience{.tv_sec = 10, .tv_usec = 0};
  setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  setsockopt(fd_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  connected_ = connect(fd_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
  if (!connected_ || !tls) return;
  context_.reset(SSL_CTX_new(TLS_client_method()));
  ssl_.reset(SSL_new(context_.get()));
  SSL_set_fd(ssl_.get(), fd_);
  connected_ = SSL_connect(ssl_.get()) == 1;
}

Browser::~Browser() {
  ssl_.reset();
  close(fd_);
}

bool Browser::send(std::string_view bytes) const {
  if (bytes.empty()) return true;
  const int size = static_cast<int>(bytes.size());
  if (ssl_) return SSL_write(ssl_.get(), bytes.data(), size) == size;
  return ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL) == size;
}

bool Browser::fill() {
  std::array<char, 16384> piece{};
  const auto size = ssl_ ? SSL_read(ssl_.get(), piece.data(), static_cast<int>(piece.size()))
                         : static_cast<int>(recv(fd_, piece.data(), piece.size(), 0));
  if (size <= 0) return false;
  buffer_.append(piece.data(), static_cast<std::size_t>(size));
  return true;
}

std::string Browser::ask(std::string_view request) {
  if (!send(request)) return "";
  std::size_t end = std::string::npos;
  while ((end = buffer_.find("\r\n\r\n")) == std::string::npos)
    if (!fill()) return std::exchange(buffer_, {});
  end += 4;
  const std::size_t length = buffer_.find("Content-Length: ");
  const std::size_t body = length < end ? std::stoul(buffer_.substr(length + 16)) : 0;
  while (buffer_.size() < end + body)
    if (!fill()) break;
  const std::string answer = buffer_.substr(0, end + body);
  buffer_.erase(0, end + body);
  return answer;
}

std::string Browser::rest() {
  while (fill()) {
  }
  return std::exchange(buffer_, {});
}

std::string Browser::fingerprint() const {
  const std::unique_ptr<X509, decltype(&X509_free)> certificate(SSL_get1_peer_certificate(ssl_.get()), X509_free);
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  X509_digest(certificate.get(), EVP_sha256(), digest.data(), &size);
  std::string text;
  for (unsigned i = 0; i < size; ++i) text += fmt::format("{}{:02X}", i == 0 ? "" : ":", digest.at(i));
  return text;
}

int Browser::open(std::string_view token, std::string_view host, std::string_view origin) {
  return status_of(
      upgrade("/socket", host, origin, fmt::format("pmg{}{}", token.empty() ? "" : ", pmg.token.", token)));
}

std::string Browser::upgrade(std::string_view path, std::string_view host, std::string_view origin,
                             std::string_view protocols) {
  const std::string from = origin.empty() ? "" : fmt::format("Origin: {}\r\n", origin);
  return ask(
      fmt::format("GET {} HTTP/1.1\r\nHost: {}\r\n{}Connection: Upgrade\r\n"
                  "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                  "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                  "Sec-WebSocket-Protocol: {}\r\n\r\n",
                  path, host, from, protocols));
}

std::string Browser::frame(std::string_view text, int opcode, bool last, bool masked) {
  std::string bytes;
  const auto put = [&](std::size_t value) { bytes += static_cast<char>(value & 255U); };
  const std::size_t mask_bit = masked ? 128 : 0;
  put((last ? 128U : 0U) | static_cast<unsigned>(opcode));
  if (text.size() < 126) {
    put(mask_bit | text.size());
  } else {
    const int width = text.size() < 65536 ? 2 : 8;
    put(mask_bit | (width == 2 ? 126U : 127U));
    for (int k = width - 1; k >= 0; --k) put(text.size() >> (8 * k));
  }
  constexpr std::array<char, 4> kMask = {0x12, 0x34, 0x56, 0x78};
  if (masked) bytes.append(kMask.data(), kMask.size());
  for (std::size_t i = 0; i < text.size(); ++i) bytes += masked ? static_cast<char>(text[i] ^ kMask[i % 4]) : text[i];
  return bytes;
}

bool Browser::say(std::string_view text, int opcode) const { return send(frame(text, opcode)); }

std::optional<Browser::Frame> Browser::frame() {
  const auto byte = [&](std::size_t at) { return static_cast<std::size_t>(static_cast<unsigned char>(buffer_[at])); };
  const auto need = [&](std::size_t size) {
    while (buffer_.size() < size)
      if (!fill()) return false;
    return true;
  };
  if (!need(2)) return std::nullopt;
  std::size_t size = byte(1) & 127U, head = 2;
  if (size >= 126) {
    const std::size_t width = size == 126 ? 2 : 8;
    if (!need(head + width)) return std::nullopt;
    size = 0;
    for (std::size_t k = 0; k < width; ++k) size = size << 8U | byte(head + k);
    head += width;
  }
  if (!need(head + size)) return std::nullopt;
  Frame frame{.opcode = static_cast<int>(byte(0) & 15U), .text = buffer_.substr(head, size)};
  buffer_.erase(0, head + size);
  return frame;
}

std::optional<std::string> Browser::hear() {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);  // pings alone are no answer
  while (auto next = frame()) {
    if (next->opcode == 1) return next->text;
    if (next->opcode == 9) say(next->text, 10);
    if (next->opcode != 8 && std::chrono::steady_clock::now() > end) return std::nullopt;
    if (next->opcode != 8) continue;
    if (next->text.size() >= 2)
      close_code_ = static_cast<unsigned char>(next->text[0]) << 8 | static_cast<unsigned char>(next->text[1]);
    return std::nullopt;
  }
  return std::nullopt;
}

int status_of(std::string_view answer) {
  constexpr std::string_view kVersion = "HTTP/1.1 ";
  if (!answer.starts_with(kVersion) || answer.size() < kVersion.size() + 3) return 0;
  return std::stoi(std::string(answer.substr(kVersion.size(), 3)));
}

}  // namespace pmg::test
