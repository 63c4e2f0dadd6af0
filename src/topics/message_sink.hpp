// Where topics go: a file (MCAP), or whoever listens now.
#pragma once

#include <cstdint>
#include <string_view>

namespace pmg::topics {

/// Takes messages of any encoding; each channel has its own.
class MessageSink {
 public:
  using Id = std::uint16_t;

  /// Which of a channel's messages someone must still get who listens late or slowly.
  enum class Keep : std::uint8_t {
    kNewest,   ///< a message is out of date when the next one comes
    kEvents,   ///< each tells something of its own
    kForever,  ///< the newest, also for someone who begins to listen later
  };

  MessageSink() = default;
  MessageSink(const MessageSink&) = delete;
  MessageSink& operator=(const MessageSink&) = delete;
  virtual ~MessageSink() = default;

  /// Once for each channel, before its first message. encoding: "jsonschema", "protobuf", ...
  virtual Id add_schema(std::string_view name, std::string_view encoding, std::string_view data) = 0;
  virtual Id add_channel(Id schema, std::string_view topic, std::string_view message_encoding, Keep keep) = 0;
  /// Whether anybody gets this channel's messages now: what nobody gets need not be made.
  virtual bool wants(Id channel) const = 0;
  /// Times in nanoseconds; readers take them for UTC.
  virtual void write(Id channel, std::int64_t time_ns, std::string_view data) = 0;
};

}  // namespace pmg::topics
