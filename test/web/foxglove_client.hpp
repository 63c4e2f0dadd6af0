// A client of Foxglove's WebSocket protocol, written from its published description.
#pragma once

#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "web/browser.hpp"

namespace pmg::test {

class FoxgloveClient {
 public:
  explicit FoxgloveClient(std::uint16_t port, int receive_buffer_bytes = 0)
      : browser(port, false, receive_buffer_bytes) {}

  /// The status of the server's answer.
  int open(std::string_view host = "localhost", std::string_view origin = "",
           std::string_view protocols = "foxglove.sdk.v1") {
    answer = browser.upgrade("/", host, origin, protocols);
    return status_of(answer);
  }
  bool say(const nlohmann::json& json) const { return browser.say(json.dump()); }
  void subscribe(std::uint32_t id, std::uint32_t channel) const {
    say({{"op", "subscribe"}, {"subscriptions", {{{"id", id}, {"channelId", channel}}}}});
  }

  struct Data {
    std::uint32_t subscription = 0;
    std::int64_t time_ns = 0;
    std::string text;
  };
  /// The next message of a topic, within 10 s. Lines of JSON on the way are read() or kept in channels. Nothing:
  /// closed.
  std::optional<Data> data() {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);  // pings alone are no answer
    while (auto next = browser.frame()) {
      if (next->opcode == 8 || std::chrono::steady_clock::now() > end) return std::nullopt;
      if (next->opcode == 9) browser.say(next->text, 10);
      if (next->opcode == 1) take(nlohmann::json::parse(next->text, nullptr, false));
      if (next->opcode != 2) continue;
      if (next->text.size() < 13 || next->text[0] != 1) return std::nullopt;
      return Data{.subscription = static_cast<std::uint32_t>(little_endian(next->text, 1, 4)),
                  .time_ns = static_cast<std::int64_t>(little_endian(next->text, 5, 8)),
                  .text = next->text.substr(13)};
    }
    return std::nullopt;
  }
  /// The next line of JSON; null: closed.
  nlohmann::json line() {
    const auto text = browser.hear();
    const nlohmann::json json = text ? nlohmann::json::parse(*text, nullptr, false) : nlohmann::json();
    take(json);
    return json;
  }
  /// Its number once it has been advertised; 0: not yet.
  std::uint32_t channel(std::string_view topic) const {
    for (const nlohmann::json& one : channels)
      if (one["topic"] == topic) return one["id"];
    return 0;
  }

  Browser browser;
  std::string answer;
  std::vector<nlohmann::json> channels;  ///< advertised until now

 private:
  void take(const nlohmann::json& json) {
    if (json.is_object() && json["op"] == "advertise")
      for (const nlohmann::json& one : json["channels"]) channels.push_back(one);
  }
  static std::uint64_t little_endian(std::string_view bytes, std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value |= std::uint64_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
    return value;
  }
};

}  // namespace pmg::test
