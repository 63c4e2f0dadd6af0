#include "live_page/foxglove_feed.hpp"

#include <utility>

namespace pmg::live_page {

FoxgloveFeed::FoxgloveFeed(io::LcmLink& link, web::FoxgloveServer& server, std::function<std::int64_t()> utc_ns)
    : server_(server), utc_ns_(std::move(utc_ns)) {
  for (const std::string_view channel : topics::known_channels())
    link.subscribe(std::string(channel), [this, channel](io::Bytes message) { take(channel, message); });
}

void FoxgloveFeed::follow(const pmg_msgs::robot_info_t* info, const model::RobotModel* model) {
  if (info == nullptr || (robot_ == info->robot && session_ == info->session)) return;
  robot_ = info->robot;
  session_ = info->session;
  joint_names_ = info->joint_names;
  foxglove_.emplace(static_cast<topics::MessageSink&>(*this), model);
}

void FoxgloveFeed::take(std::string_view channel, io::Bytes message) {
  if (!foxglove_ || !server_.watched()) return;
  if (!topics::read_fields(channel, message, joint_names_, fields_)) return;
  for (const topics::Field& field : fields_) {
    if (field.name == "robot" && field.value != topics::Field::Value(robot_)) return;
  }
  const std::int64_t now_ns = utc_ns_();
  foxglove_->take(channel, message, now_ns, joint_names_);
  messages_.write(channel, now_ns, fields_);
}

FoxgloveFeed::Id FoxgloveFeed::add_schema(std::string_view name, std::string_view encoding, std::string_view data) {
  schemas_.push_back({std::string(name), std::string(encoding), std::string(data)});
  return static_cast<Id>(schemas_.size());
}

FoxgloveFeed::Id FoxgloveFeed::add_channel(Id schema, std::string_view topic, std::string_view message_encoding,
                                           Keep keep) {
  // A robot that was started anew has the topics that it had.
  if (const auto known = channels_.find(topic); known != channels_.end()) return known->second;
  const Schema& its = schemas_.at(schema - 1U);
  const auto id = static_cast<Id>(server_.add({.topic = std::string(topic),
                                               .encoding = std::string(message_encoding),
                                               .schema_name = its.name,
                                               .schema_encoding = its.encoding,
                                               .schema = its.data,
                                               .waiting = keep == Keep::kEvents ? kEvents : 1,
                                               .latched = keep == Keep::kForever}));
  channels_.emplace(topic, id);
  return id;
}

}  // namespace pmg::live_page
