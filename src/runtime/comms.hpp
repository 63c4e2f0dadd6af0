// The controller on the network: hears operators, answers them and publishes its state. Channels: msgs/.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "control/controller_outbox.hpp"
#include "control/operator_inbox.hpp"
#include "control/tick_record.hpp"
#include "io/clock.hpp"
#include "io/lcm_link.hpp"
#include "model/robot_model.hpp"
#include "pmg_msgs/ack_t.hpp"
#include "pmg_msgs/arms_state_t.hpp"
#include "pmg_msgs/fault_t.hpp"
#include "pmg_msgs/hoist_state_t.hpp"
#include "pmg_msgs/link_t.hpp"
#include "pmg_msgs/motor_command_t.hpp"
#include "pmg_msgs/reference_t.hpp"
#include "pmg_msgs/robot_info_t.hpp"
#include "pmg_msgs/robot_state_t.hpp"
#include "pmg_msgs/status_t.hpp"
#include "pmg_msgs/timing_t.hpp"
#include "recording/run_info.hpp"
#include "runtime/hoist_gate.hpp"
#include "runtime/name_claim.hpp"
#include "runtime/name_contest.hpp"
#include "runtime/operator_gate.hpp"
#include "seal/controller_seal.hpp"

namespace pmg::runtime {

/// One ordinary thread calls step() again and again. Nothing here waits for a real-time thread, or makes one wait. When
/// the network refuses messages, Comms counts them, warns once and goes on.
class Comms {
 public:
  /// Keeps references to all of them. control_rate_Hz is told in ROBOT_INFO. Throws std::runtime_error when link can't
  /// subscribe. seal: without keys unless given.
  Comms(io::LcmLink& link, control::OperatorInbox& inbox, control::ControllerOutbox& outbox,
        const model::RobotModel& robot, const recording::RunInfo& run, double control_rate_Hz, const io::Clock& clock,
        seal::ControllerSeal seal = seal::ControllerSeal());
  ~Comms() = default;
  Comms(const Comms&) = delete;
  Comms& operator=(const Comms&) = delete;

  /// One line for the console when something is wrong for the first time. Called from step().
  std::function<void(const std::string&)> on_warning;

  /// From now on HOIST is heard and HOIST_STATE published. Without a hoist (null) requests count as no_hoist. Keeps the
  /// pointer.
  void work(hal::HoistLine* hoist) noexcept { hoist_gate_.work(hoist); }

  /// Before the controller publishes anything else: who else is on this address? Claims the name meanwhile. Returns the
  /// other robots' names after that many seconds of wall time, or as soon as interrupted says so. Throws
  /// std::runtime_error when the name belongs to another controller: one that runs, or the one with the smallest boot
  /// number of those that start at this time. The error is one line with name, session, address and what to do.
  /// Operators' messages of this time are not taken. With keys, only a controller with the same key has a say. Only
  /// answers to this start's question count: no recording prevents a start.
  std::vector<std::string> listen_for_others(double seconds, const std::function<bool()>& interrupted = {});

  /// After listen_for_others(): answers for the name until it is destroyed, which must be before the first step().
  HeldClaim hold_name();

  /// Waits up to timeout_ms for operators and takes a bounded number of their messages. Then publishes ACK for each
  /// answer, the newest tick unless it was published, HOIST_STATE and ARMS_STATE ten times a second, FAULT when one
  /// latches, and ROBOT_INFO and LINK once a second.
  void step(int timeout_ms);

  const GateCounts& gate_counts() const noexcept { return gate_.counts(); }
  std::int64_t impostors_heard() const noexcept { return impostors_heard_; }  ///< answers of another one of our name
  std::int64_t forgeries_heard() const noexcept { return forgeries_heard_; }  ///< in our name, without our key

 private:
  enum class Warning { kImpostor, kForgery, kMalformed, kVersion, kKey, kFlood, kNetwork };

  void hear_status(io::Bytes message);
  /// Of our own STATUS, which we hear, too.
  bool said(io::Bytes status) const;
  void hear_claim(io::Bytes message);
  /// Whether there is time to look at another signature.
  bool may_verify();
  /// On CLAIM: a question, or the answer to the one of this boot number.
  void claim(std::int64_t answers);
  void publish_acks();
  void publish_newest();
  void publish_hoist();
  void publish_arms();
  void publish_each_second();
  void warn();

  io::LcmLink& link_;
  control::ControllerOutbox& outbox_;
  const model::RobotModel& robot_;
  const recording::RunInfo& run_;
  double control_rate_Hz_;
  const io::Clock& clock_;
  seal::ControllerSeal seal_;
  NameContest contest_;
  std::array<seal::Digest, 256> said_{};  // a ring: STATUS of the last seconds
  std::size_t said_count_ = 0;
  DatagramOrder order_;
  OperatorGate gate_;
  HoistGate hoist_gate_;
  bool listening_ = false;
  std::vector<std::string> others_;
  std::int64_t impostors_heard_ = 0, impostor_session_ = 0, forgeries_heard_ = 0;
  std::array<bool, 7> warned_{};  // by Warning
  std::int64_t next_second_ns_, next_hoist_ns_, next_arms_ns_, verify_at_ns_ = 0;
  std::int64_t answer_at_ns_ = 0, ask_at_ns_ = 0;

  control::TickRecord newest_;
  faults::Fault published_fault_;
  pmg_msgs::ack_t ack_;
  pmg_msgs::status_t status_;
  pmg_msgs::robot_state_t state_;
  pmg_msgs::reference_t reference_;
  pmg_msgs::motor_command_t motor_command_;
  pmg_msgs::timing_t timing_;
  pmg_msgs::fault_t fault_;
  pmg_msgs::hoist_state_t hoist_state_{};
  pmg_msgs::arms_state_t arms_state_{};
  pmg_msgs::robot_info_t info_;
  pmg_msgs::link_t counts_{};
};

}  // namespace pmg::runtime
