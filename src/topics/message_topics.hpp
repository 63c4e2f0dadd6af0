// (a message) => one topic for each channel: JSON, with the JSON schema of its fields.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "topics/message_fields.hpp"
#include "topics/message_sink.hpp"

namespace pmg::topics {

class MessageTopics {
 public:
  explicit MessageTopics(MessageSink& sink) : sink_(sink) {}  ///< keeps a reference

  /// False: nobody gets this channel's messages now. True also before its first message.
  bool wants(std::string_view channel) const;
  /// The topic has the channel's name, its schema that of its first message. fields: as read_fields() gives them.
  void write(std::string_view channel, std::int64_t time_ns, const std::vector<Field>& fields);

 private:
  MessageSink& sink_;
  std::map<std::string, MessageSink::Id, std::less<>> channels_;
};

}  // namespace pmg::topics
