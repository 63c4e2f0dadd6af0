#include "topics/foxglove_topics.hpp"

#include <fmt/format.h>

#include <iterator>

#include "files/bounded_file.hpp"
#include "files/config_reader.hpp"
#include "io/message_prefix.hpp"
#include "operator/words.hpp"
#include "pmg_msgs/fault_t.hpp"
#include "pmg_msgs/mode_t.hpp"
#include "pmg_msgs/scenario_step_t.hpp"
#include "pmg_msgs/status_t.hpp"
#include "pmg_msgs/tick_input_t.hpp"
#include "topics/foxglove_schemas.hpp"
#include "topics/json_text.hpp"

namespace pmg::topics {

namespace {

using Keep = MessageSink::Keep;

constexpr std::int64_t kFramesPeriod_ns = 19'000'000;  // every second tick of 10 ms, however its stamps are rounded

void append_time(std::string& json, std::int64_t time_ns) {
  fmt::format_to(std::back_inserter(json), R"("timestamp":{{"sec":{},"nsec":{}}})", time_ns / 1'000'000'000,
                 time_ns % 1'000'000'000);
}

template <typename Message>
std::optional<Message> decoded(io::Bytes bytes) {
  Message message{};
  if (!io::decode_prefix(bytes, message)) return std::nullopt;
  return message;
}

template <typename Vector>
void append_vector(std::string& json, const Vector& v) {
  const char* key = R"({"x":)";
  for (int i = 0; i < 3; ++i) {
    json += key;
    append_number(json, v[i]);
    key = i == 0 ? R"(,"y":)" : R"(,"z":)";
  }
}

}  // namespace

FoxgloveTopics::FoxgloveTopics(MessageSink& sink, const model::RobotModel* robot) : sink_(sink), robot_(robot) {
  if (robot_ != nullptr) frames_.emplace(*robot_);
}

MessageSink::Id FoxgloveTopics::channel(std::optional<MessageSink::Id>& known, const char* topic, const char* schema,
                                        const char* text, MessageSink::Keep keep) {
  if (!known) known = sink_.add_channel(sink_.add_schema(schema, "jsonschema", text), topic, "json", keep);
  return *known;
}

void FoxgloveTopics::take(std::string_view channel, io::Bytes message, std::int64_t time_ns,
                          const std::vector<std::string>& joint_names) {
  describe(time_ns);
  if (channel == "STATE") {
    write_pending();
    if (io::decode_prefix(message, state_)) take_state(time_ns, joint_names);
  } else if (channel == "GROUND_TRUTH") {
    if (const auto truth = decoded<pmg_msgs::ground_truth_t>(message)) take_truth(*truth);
  } else if (channel == "STATUS") {
    const auto status = decoded<pmg_msgs::status_t>(message);
    const bool known = status && status->mode >= 0 && status->mode <= pmg_msgs::mode_t::FAULT;
    if (!known || status->mode == mode_) return;
    mode_ = status->mode;
    log(time_ns, kInfo, std::string("mode: ") + ops::mode_name(mode_));
  } else if (channel == "SCENARIO") {
    if (const auto step = decoded<pmg_msgs::scenario_step_t>(message))
      log(time_ns, kInfo,
          fmt::format("{}, step {} of {}: {}", step->scenario, step->number, step->step_count, step->text));
  } else if (channel == "FAULT") {
    if (const auto fault = decoded<pmg_msgs::fault_t>(message)) log(time_ns, kError, fault->text);
  } else if (channel == "TICK") {
    const auto tick = decoded<pmg_msgs::tick_input_t>(message);
    if (tick && tick->guard_trip != pmg_msgs::tick_input_t::NONE) log(time_ns, kWarning, "the bus guard took over");
  }
}

void FoxgloveTopics::finish() { write_pending(); }

void FoxgloveTopics::describe(std::int64_t time_ns) {
  if (robot_ == nullptr || description_) return;
  const auto id = channel(description_, "/robot_description", "std_msgs/String",
                          R"({"type":"object","properties":{"data":{"type":"string"}}})", Keep::kForever);
  auto yaml = files::ConfigReader::from_file(robot_->directory / "robot.yaml");
  text_ = R"({"data":)";
  append_text(text_, files::read_bounded_text(robot_->directory / yaml.required<std::string>("urdf"),
                                              files::kLargestUrdf_bytes, "a URDF file"));
  sink_.write(id, time_ns, text_ + '}');
}

void FoxgloveTopics::take_state(std::int64_t time_ns, const std::vector<std::string>& joint_names) {
  state_time_ns_ = time_ns;
  pending_ = robot_ != nullptr && state_.joint_count == robot_->joint_index.size();
  if (joint_names.size() != state_.q_rad.size()) return;
  const auto id = channel(joint_states_, "/joint_states", "foxglove.JointStates", kJointStatesSchema, Keep::kNewest);
  if (!sink_.wants(id)) return;
  text_ = "{";
  append_time(text_, time_ns);
  text_ += R"(,"joints":[)";
  for (std::size_t i = 0; i < joint_names.size(); ++i) {
    text_ += i == 0 ? R"({"name":)" : R"(,{"name":)";
    append_text(text_, joint_names[i]);
    for (const auto& [key, values] : {std::pair{"position", &state_.q_rad}, std::pair{"velocity", &state_.dq_rad_s},
                                      std::pair{"effort", &state_.torque_Nm}}) {
      fmt::format_to(std::back_inserter(text_), R"(,"{}":)", key);
      append_number(text_, (*values)[i]);
    }
    text_ += '}';
  }
  sink_.write(id, time_ns, text_ + "]}");
}

void FoxgloveTopics::take_truth(const pmg_msgs::ground_truth_t& truth) {
  if (!pending_) return;
  Eigen::Isometry3d T_WB = Eigen::Isometry3d::Identity();
  T_WB.translation() = Eigen::Map<const Eigen::Vector3d>(truth.p_WB_m);
  T_WB.linear() =
      Eigen::Quaterniond(truth.q_WB[0], truth.q_WB[1], truth.q_WB[2], truth.q_WB[3]).normalized().toRotationMatrix();
  write_frames(T_WB);
}

void FoxgloveTopics::write_pending() {
  if (!pending_) return;
  const auto& q = state_.orientation_WI;
  write_frames(frames_->standing_base(state_.q_rad, Eigen::Quaterniond(q[0], q[1], q[2], q[3])));
}

void FoxgloveTopics::write_frames(const Eigen::Isometry3d& T_WB) {
  pending_ = false;
  if (!T_WB.matrix().allFinite()) return;
  if (frames_time_ns_ >= 0 && state_time_ns_ - frames_time_ns_ < kFramesPeriod_ns) return;
  frames_time_ns_ = state_time_ns_;
  const auto id = channel(tf_, "/tf", "foxglove.FrameTransforms", kFrameTransformsSchema, Keep::kNewest);
  if (!sink_.wants(id)) return;
  text_ = R"({"transforms":[)";
  const char* before = "{";
  for (const RobotFrames::Frame& frame : frames_->at(state_.q_rad, T_WB)) {
    text_ += before;
    append_time(text_, state_time_ns_);
    text_ += R"(,"parent_frame_id":)";
    append_text(text_, frame.parent);
    text_ += R"(,"child_frame_id":)";
    append_text(text_, frame.child);
    text_ += R"(,"translation":)";
    append_vector(text_, frame.p);
    text_ += R"(},"rotation":)";
    append_vector(text_, frame.q.coeffs());
    text_ += R"(,"w":)";
    append_number(text_, frame.q.w());
    text_ += "}}";
    before = ",{";
  }
  sink_.write(id, state_time_ns_, text_ + "]}");
}

void FoxgloveTopics::log(std::int64_t time_ns, Level level, const std::string& text) {
  text_ = "{";
  append_time(text_, time_ns);
  fmt::format_to(std::back_inserter(text_), R"(,"level":{},"message":)", static_cast<int>(level));
  append_text(text_, text);
  text_ += R"(,"name":"pmg","file":"","line":0})";
  sink_.write(channel(log_, "/log", "foxglove.Log", kLogSchema, Keep::kEvents), time_ns, text_);
}

}  // namespace pmg::topics
