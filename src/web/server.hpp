// A server of pages over HTTPS and of one WebSocket for each page, in a thread of its own: whatever browsers do, the
// caller's thread isn't held up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "web/certificate.hpp"

namespace pmg::web {

/// A file that is compiled in. Nothing else can be asked for.
struct Asset {
  std::string path;  ///< "/page.js"
  std::string type;  ///< "text/javascript"
  std::string text;
};

struct ServerSettings {
  std::string address = "127.0.0.1";  ///< of the interface that it listens on
  std::uint16_t port = 8443;          ///< 0: any free one
  Certificate certificate{};
  std::vector<std::string> names{};  ///< hosts by which a browser may call this server
  std::vector<Asset> assets{};
  /// (a page's token) => the name that it was paired under; nothing: none. Called by the server's thread.
  std::function<std::optional<std::string>(std::string_view)> paired{};
};

/// A page with an open WebSocket.
struct Page {
  std::int32_t id = 0;    ///< another one at each connection
  std::string paired_as;  ///< empty: it may only look
};

/// What a page said.
struct Said {
  std::int32_t page = 0;
  std::string text;
};

/// Since the start.
struct Counts {
  std::uint64_t connections = 0, pages = 0, messages = 0;
  std::uint64_t states = 0, state_bytes = 0;  // given to sockets; at most kMostOnTheWay of a page aren't confirmed
  // Refused:
  std::uint64_t host = 0, origin = 0, token = 0, path = 0, method = 0, malformed = 0, full = 0, slow = 0;
  // Dropped, or their page closed:
  std::uint64_t oversize = 0, flooded = 0, not_paired = 0, overrun = 0, binary = 0;
};

/// Any thread may call it. Pages that are paired are served however many connections others hold open.
class Server {
 public:
  /// What a page sends when the robot shall stop. It passes every limit of rate.
  static constexpr std::string_view kStop = "stop";

  static constexpr std::size_t kMostMessage_bytes = 4096;
  static constexpr std::size_t kMostWaiting = 32;  ///< connections without an open page; one more closes the oldest of
                                                   ///< the address that holds most
  static constexpr std::size_t kMostPaired = 8, kMostReaders = 8;  ///< pages; one reader more closes the oldest reader
  static constexpr double kMessages_per_s = 120.0, kMessagesRoom = 60.0;  ///< of one page
  static constexpr std::uint64_t kMostDropped = 1000;                     ///< messages beyond that: its page is closed
  static constexpr std::size_t kMostUnread = 64;       ///< of one page until take(); one more drops the oldest
  static constexpr std::uint64_t kMostOnTheWay = 3;    ///< states that a browser hasn't confirmed
  static constexpr int kPatience_s = 5, kIdle_s = 10;  ///< for a request; for any sign of life of an open page

  /// Throws std::runtime_error with one line: an address that can't be listened on, a certificate that is none.
  explicit Server(ServerSettings settings);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::uint16_t port() const;
  /// From now on gives out this file, too, or in place of the one with its path.
  void give_out(Asset asset);
  /// What paired pages said since the last call; of each page in its order, stops first.
  std::vector<Said> take();
  std::vector<Page> pages() const;
  /// Sends a page this text, unless a newer one takes its place before the browser has room: a slow page misses states,
  /// and never gets old ones late.
  void show(std::int32_t page, std::string text);
  void close(std::int32_t page);  ///< a pairing that was revoked
  Counts counts() const;

 private:
  class Thread;
  std::unique_ptr<Thread> thread_;
};

}  // namespace pmg::web
