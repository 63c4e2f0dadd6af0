#include "topics/message_topics.hpp"

#include "topics/json_text.hpp"

namespace pmg::topics {

namespace {

MessageSink::Keep keep_of(std::string_view channel) {
  if (channel == "ROBOT_INFO") return MessageSink::Keep::kForever;
  const bool event = channel == "FAULT" || channel == "ACK" || channel == "MODE" || channel == "SCENARIO";
  return event ? MessageSink::Keep::kEvents : MessageSink::Keep::kNewest;
}

}  // namespace

bool MessageTopics::wants(std::string_view channel) const {
  const auto known = channels_.find(channel);
  return known == channels_.end() || sink_.wants(known->second);
}

void MessageTopics::write(std::string_view channel, std::int64_t time_ns, const std::vector<Field>& fields) {
  auto known = channels_.find(channel);
  if (known == channels_.end()) {
    const auto schema = sink_.add_schema("pmg." + std::string(channel), "jsonschema", message_schema(fields));
    known = channels_.emplace(channel, sink_.add_channel(schema, channel, "json", keep_of(channel))).first;
  }
  if (sink_.wants(known->second)) sink_.write(known->second, time_ns, message_json(fields));
}

}  // namespace pmg::topics
