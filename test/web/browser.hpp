// A browser's side of HTTPS and WebSockets, written by hand over OpenSSL: so that it can also do what no browser does.
#pragma once

#include <openssl/ssl.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace pmg::test {

/// One connection to a server on this computer. Every call ends after 10 s at most. Not a single one throws: what
/// didn't work is empty.
class Browser {
 public:
  /// tls: shakes hands. receive_buffer_bytes: 0: the system's.
  explicit Browser(std::uint16_t port, bool tls = true, int receive_buffer_bytes = 0);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  bool connected() const { return connected_; }
  bool send(std::string_view bytes) const;  ///< as they are
  /// The server's answer to a whole request: head and body; empty: none came.
  std::string ask(std::string_view request);
  /// Until the server closes.
  std::string rest();
  std::string fingerprint() const;  ///< of the server's certificate: "3F:0A:..."

  /// Opens a WebSocket. token: empty: none. Returns the status: 101.
  int open(std::string_view token, std::string_view host = "localhost", std::string_view origin = "https://localhost");
  /// Asks for a WebSocket of any protocols; origin: empty: none is told. The whole answer.
  std::string upgrade(std::string_view path, std::string_view host, std::string_view origin,
                      std::string_view protocols);
  /// A frame of a client. opcode: 1 text, 2 binary, 8 close, 9 ping, 10 pong.
  bool say(std::string_view text, int opcode = 1) const;
  static std::string frame(std::string_view text, int opcode, bool last = true, bool masked = true);

  struct Frame {
    int opcode = 0;
    std::string text;
  };
  /// The next frame; nothing: the connection ended. Doesn't answer pings.
  std::optional<Frame> frame();
  /// The next text; answers pings and passes over what else comes. Nothing: closed; then close_code() is known.
  std::optional<std::string> hear();
  int close_code() const { return close_code_; }  ///< 0: none was heard

 private:
  bool fill();

  int fd_ = -1;
  std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context_{nullptr, SSL_CTX_free};
  std::unique_ptr<SSL, decltype(&SSL_free)> ssl_{nullptr, SSL_free};
  std::string buffer_;
  bool connected_ = false;
  int close_code_ = 0;
};

/// The status of an answer: 200; 0: none.
int status_of(std::string_view answer);

}  // namespace pmg::test
