// A server of Foxglove's WebSocket protocol, in a thread of its own: topics for Foxglove and its kin on this computer.
// It is for looking: nothing that it receives goes further than the choice of topics.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace pmg::web {

/// A topic. Encodings as Foxglove has them: "json", "jsonschema".
struct FoxgloveChannel {
  std::string topic, encoding, schema_name, schema_encoding, schema;
  std::size_t waiting = 1;  ///< messages that may wait for a client that is slow; one more drops the oldest
  bool latched = false;     ///< the newest message also goes to one who subscribes later
};

struct FoxgloveSettings {
  std::uint16_t port = 8765;           ///< on 127.0.0.1 alone; 0: any free one
  std::string name = "pmg";            ///< shown by the client
  std::string session{};               ///< another one at each start
  std::vector<std::string> origins{};  ///< of further pages that may look: "https://plots.example"
};

/// Since the start.
struct FoxgloveCounts {
  std::uint64_t clients = 0, sent = 0;
  std::uint64_t skipped = 0;  ///< messages that a slow client didn't get
  // Refused:
  std::uint64_t host = 0, origin = 0, protocol = 0, full = 0;
  // Dropped, or their client closed:
  std::uint64_t not_understood = 0, oversize = 0;
};

/// Any thread may call it.
///
/// Everybody on this computer may look, as at the page. Programs send no Origin; a browser's page must come from this
/// computer, from a file, from Foxglove's own site or from one of the settings' origins: another site's page may not.
class FoxgloveServer {
 public:
  static constexpr std::string_view kProtocol = "foxglove.sdk.v1", kOlderProtocol = "foxglove.websocket.v1";
  static constexpr std::size_t kMostClients = 8, kMostSubscriptions = 256, kMostMessage_bytes = 65536;
  static constexpr std::uint64_t kMostDropped = 100;  ///< messages that aren't understood; then the client is closed
  static constexpr int kSendBuffer_bytes = 262144;    ///< of the system, for each client: what is in it gets old there

  /// Throws std::runtime_error with one line: a port that can't be listened on.
  explicit FoxgloveServer(FoxgloveSettings settings);
  ~FoxgloveServer();
  FoxgloveServer(const FoxgloveServer&) = delete;
  FoxgloveServer& operator=(const FoxgloveServer&) = delete;

  std::uint16_t port() const;
  /// From now on clients may subscribe to it. Its number, from 1 on.
  std::uint32_t add(FoxgloveChannel channel);
  bool watched() const;  ///< a client is there
  /// Whether a message of this channel goes anywhere: somebody has subscribed to it, or it is latched.
  bool wants(std::uint32_t channel) const;
  /// time_ns: UTC.
  void send(std::uint32_t channel, std::int64_t time_ns, std::string_view message);
  FoxgloveCounts counts() const;

 private:
  class Thread;
  std::unique_ptr<Thread> thread_;
};

}  // namespace pmg::web
