// (a robot's messages on the network) => topics for Foxglove's clients, the same as pmg_log exports.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/lcm_link.hpp"
#include "model/robot_model.hpp"
#include "pmg_msgs/robot_info_t.hpp"
#include "topics/foxglove_topics.hpp"
#include "topics/message_topics.hpp"
#include "web/foxglove_server.hpp"

namespace pmg::live_page {

/// For the thread of its link. Shows what the network carries under the robot's name; it looks at no seal. Nothing is
/// made while no client is there.
class FoxgloveFeed : private topics::MessageSink {
 public:
  static constexpr std::size_t kEvents = 64;  ///< of a topic of events: so many may wait for a slow client

  /// Keeps references. utc_ns: the time now [ns since 1970].
  FoxgloveFeed(io::LcmLink& link, web::FoxgloveServer& server, std::function<std::int64_t()> utc_ns);

  /// Call in each turn. info: null: it isn't heard yet. model: null: this computer hasn't its files; then transforms
  /// and URDF are left out. It must stay.
  void follow(const pmg_msgs::robot_info_t* info, const model::RobotModel* model);

 private:
  Id add_schema(std::string_view name, std::string_view encoding, std::string_view data) override;
  Id add_channel(Id schema, std::string_view topic, std::string_view message_encoding, Keep keep) override;
  bool wants(Id channel) const override { return server_.wants(channel); }
  void write(Id channel, std::int64_t time_ns, std::string_view data) override { server_.send(channel, time_ns, data); }

  void take(std::string_view channel, io::Bytes message);

  struct Schema {
    std::string name, encoding, data;
  };

  web::FoxgloveServer& server_;
  std::function<std::int64_t()> utc_ns_;
  std::vector<Schema> schemas_;
  std::map<std::string, Id, std::less<>> channels_;  // by topic
  std::string robot_;                                // empty: none is followed
  std::int64_t session_ = 0;
  std::vector<std::string> joint_names_;
  std::optional<topics::FoxgloveTopics> foxglove_;
  topics::MessageTopics messages_{*this};
  std::vector<topics::Field> fields_;  // memory is reused
};

}  // namespace pmg::live_page
