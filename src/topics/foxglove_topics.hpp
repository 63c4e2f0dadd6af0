// (a robot's messages) => the topics that Foxglove and its kin draw without being told how, by Foxglove's own schemas:
//   /tf                 foxglove.FrameTransforms  every link, fifty times a second
//   /joint_states       foxglove.JointStates      every STATE
//   /log                foxglove.Log              modes, scenario steps, faults, the bus guard
//   /robot_description  std_msgs/String           the URDF, once
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/lcm_assembler.hpp"
#include "model/robot_model.hpp"
#include "pmg_msgs/ground_truth_t.hpp"
#include "pmg_msgs/robot_state_t.hpp"
#include "topics/message_sink.hpp"
#include "topics/robot_frames.hpp"

namespace pmg::topics {

class FoxgloveTopics {
 public:
  /// robot: nullptr leaves out what needs its description: /tf and /robot_description.
  FoxgloveTopics(MessageSink& sink, const model::RobotModel* robot);

  /// Each message in its order. time_ns: the message's time for the sink. joint_names: as ROBOT_INFO says.
  void take(std::string_view channel, io::Bytes message, std::int64_t time_ns,
            const std::vector<std::string>& joint_names);
  void finish();  ///< once, behind the last message

 private:
  enum Level { kInfo = 2, kWarning = 3, kError = 4 };  // foxglove.LogLevel

  void describe(std::int64_t time_ns);
  void take_state(std::int64_t time_ns, const std::vector<std::string>& joint_names);
  void take_truth(const pmg_msgs::ground_truth_t& truth);
  void write_frames(const Eigen::Isometry3d& T_WB);
  void write_pending();
  void log(std::int64_t time_ns, Level level, const std::string& text);
  MessageSink::Id channel(std::optional<MessageSink::Id>& known, const char* topic, const char* schema,
                          const char* text, MessageSink::Keep keep);

  MessageSink& sink_;
  const model::RobotModel* robot_;
  std::optional<RobotFrames> frames_;
  std::optional<MessageSink::Id> tf_, joint_states_, log_, description_;
  pmg_msgs::robot_state_t state_{};  ///< the newest
  std::int64_t state_time_ns_ = 0;
  bool pending_ = false;  ///< state_ has no frames yet: its GROUND_TRUTH, if there is any, comes behind it
  std::int64_t frames_time_ns_ = -1;
  std::int8_t mode_ = -1;  ///< the newest STATUS's
  std::string text_;       ///< memory is reused
};

}  // namespace pmg::topics
