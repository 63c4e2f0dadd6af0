// One source of operators' messages: sends under a name and a session, receives the controllers' states and answers.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "io/clock.hpp"
#include "io/lcm_link.hpp"
#include "operator/asked_request.hpp"
#include "operator/heard_hoist.hpp"
#include "operator/status_order.hpp"
#include "pmg/command.hpp"
#include "pmg_msgs/ack_t.hpp"
#include "pmg_msgs/command_t.hpp"
#include "pmg_msgs/hoist_t.hpp"
#include "pmg_msgs/mode_t.hpp"
#include "pmg_msgs/status_t.hpp"
#include "seal/operator_seal.hpp"

namespace pmg::ops {

/// The newest messages of one controller.
struct HeardRobot {
  std::optional<pmg_msgs::status_t> status;
  StatusOrder order{};                   ///< of its STATUS
  std::int64_t status_heard_ns = 0;      ///< by the source's clock
  std::int64_t first_heard_ns = 0;       ///< likewise
  std::optional<pmg_msgs::ack_t> ack{};  ///< newest answer to the current request
  HeardHoist hoist{};
  std::optional<seal::Peer> peer{};  ///< sender of the status

  /// The controller has keys, and none of ours is one of them.
  bool lacks_key() const noexcept { return peer && peer->wants_key && !peer->key; }
  /// The newest known mode; nothing before the controller's first status.
  std::optional<std::int8_t> mode() const;
};

/// A source's session: larger after each start, unless this computer's clock is set back.
std::int64_t session_number();

/// For one thread. Receives only within link.receive().
class OperatorSource {
 public:
  static constexpr std::size_t kMostRobots = 64;  ///< limit for a flood of invented names

  /// Keeps references. name: at most 23 characters. session: larger after each start of a source with this name. seal:
  /// without keys unless given.
  OperatorSource(io::LcmLink& link, const std::string& name, std::int64_t session, const io::Clock& clock,
                 seal::OperatorSeal seal = seal::OperatorSeal());
  ~OperatorSource() = default;
  OperatorSource(const OperatorSource&) = delete;
  OperatorSource& operator=(const OperatorSource&) = delete;

  /// Once this source drives, the robot with this name follows the command for lease_s.
  void send_command(const std::string& robot, const Command& command, double lease_s);

  /// Sends a new request and forgets the answers to earlier ones. No name: a stop for every robot.
  void request(const std::string& robot, std::int8_t mode, bool reset_fault);
  void repeat_request();

  /// The same for a simulated robot's hoist. lift: lift and hold the robot; otherwise set it down as soon as it stands.
  void request_hoist(const std::string& robot, bool lift);
  void repeat_hoist();
  /// Whether the hoist has answered this request or a later one.
  bool hoist_answer(const pmg_msgs::hoist_state_t& hoist) const noexcept;

  /// Message and seal, for the robot of this name; without a name once for each robot that was heard, so that each
  /// finds its own seal.
  template <typename Message>
  void send(const char* channel, const Message& message) {
    bool sealed = false;
    for (const auto& [name, robot] : heard_) {
      if (!robot.peer || (!message.robot.empty() && message.robot != name)) continue;
      link_.send(channel, seal_.seal(channel, message, &*robot.peer));
      sealed = true;
    }
    if (!sealed) link_.send(channel, seal_.seal(channel, message, nullptr));
  }

  /// Whether this source drives the robot: this process, not an earlier one of its name.
  bool drives(const pmg_msgs::status_t& status) const noexcept {
    return status.driving_source == name() && status.driving_session == session();
  }
  /// Another source that drives but is silent: it has probably crashed without letting go, and its lease ends soon.
  /// Empty: there is none.
  std::string silent_driver(const HeardRobot& robot) const;

  const std::map<std::string, HeardRobot>& heard() const noexcept { return heard_; }  ///< by the controllers' names
  const HeardRobot* heard(const std::string& robot) const;                            ///< null: not yet
  const std::string& name() const noexcept { return command_.source; }
  std::int64_t session() const noexcept { return command_.session; }
  const std::string& url() const noexcept { return link_.url(); }
  const io::Clock& clock() const noexcept { return clock_; }

 private:
  void hear_status(io::Bytes message);
  void hear_ack(io::Bytes message);
  void hear_hoist(io::Bytes message);
  HeardRobot* place_of(const std::string& robot);  // null: too many robots

  io::LcmLink& link_;
  const io::Clock& clock_;
  seal::OperatorSeal seal_;
  std::map<std::string, HeardRobot> heard_;
  pmg_msgs::command_t command_{};
  pmg_msgs::mode_t mode_{};
  AskedRequest asked_;
  pmg_msgs::hoist_t hoist_{};
};

}  // namespace pmg::ops
