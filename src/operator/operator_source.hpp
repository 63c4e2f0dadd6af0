// One source of operators' messages: speaks as a name and a session, hears what controllers say and answer.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "io/clock.hpp"
#include "io/lcm_link.hpp"
#include "pmg/command.hpp"
#include "pmg_msgs/ack_t.hpp"
#include "pmg_msgs/command_t.hpp"
#include "pmg_msgs/hoist_state_t.hpp"
#include "pmg_msgs/hoist_t.hpp"
#include "pmg_msgs/mode_t.hpp"
#include "pmg_msgs/status_t.hpp"

namespace pmg::ops {

/// What one controller has said.
struct HeardRobot {
  std::optional<pmg_msgs::status_t> status;
  std::int64_t status_heard_ns = 0;                ///< by the source's clock
  std::int64_t first_heard_ns = 0;                 ///< likewise
  std::optional<pmg_msgs::ack_t> ack{};            ///< newest answer to the request in hand
  std::optional<pmg_msgs::hoist_state_t> hoist{};  ///< of a simulated robot that has one
  std::int64_t hoist_heard_ns = 0;                 ///< by the source's clock

  /// The newest that is known; nothing before the controller was heard.
  std::optional<std::int8_t> mode() const;
  /// The source that drives, if it isn't this one and has sent nothing for so long that it must have ended without
  /// letting go: its lease will be over soon. Empty: there is none.
  std::string silent_driver(const std::string& me) const;
};

/// A source's session: larger at every start, as long as this computer's clock isn't set back.
std::int64_t session_number();

/// For one thread. Hears only while somebody calls link.receive().
class OperatorSource {
 public:
  static constexpr std::size_t kMostRobots = 64;  ///< a flood of invented names ends here

  /// Keeps references. name: at most 23 characters. session: larger at every start of this name.
  OperatorSource(io::LcmLink& link, const std::string& name, std::int64_t session, const io::Clock& clock);

  /// The robot with this name follows the command as long as lease_s grants, once this source drives.
  void send_command(const std::string& robot, const Command& command, double lease_s);

  /// A new request, and its first sending; answers to earlier ones are forgotten. No name: a stop for every robot.
  void request(const std::string& robot, std::int8_t mode, bool reset_fault);
  void repeat_request();

  /// Likewise of a simulated robot's hoist. lift: up, and stay there; otherwise down as soon as the robot stands.
  void request_hoist(const std::string& robot, bool lift);
  void repeat_hoist();
  /// That this, or a later one, was heard.
  bool hoist_answer(const pmg_msgs::hoist_state_t& hoist) const noexcept;

  const std::map<std::string, HeardRobot>& heard() const noexcept { return heard_; }  ///< by the controllers' names
  const HeardRobot* heard(const std::string& robot) const;                            ///< null: not yet
  const std::string& name() const noexcept { return command_.source; }
  const std::string& url() const noexcept { return link_.url(); }
  const io::Clock& clock() const noexcept { return clock_; }

 private:
  void hear_status(io::Bytes message);
  void hear_ack(io::Bytes message);
  void hear_hoist(io::Bytes message);
  HeardRobot* place_of(const std::string& robot);  // null: too many

  io::LcmLink& link_;
  const io::Clock& clock_;
  std::map<std::string, HeardRobot> heard_;
  pmg_msgs::command_t command_{};
  pmg_msgs::mode_t mode_{};
  pmg_msgs::hoist_t hoist_{};
};

}  // namespace pmg::ops
