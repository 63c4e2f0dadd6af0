#include "operator/operator_source.hpp"

#include <chrono>
#include <utility>

namespace pmg::ops {

std::optional<std::int8_t> HeardRobot::mode() const {
  if (ack && (!status || status->stamp_ns < ack->stamp_ns)) return ack->mode;
  if (status) return status->mode;
  return std::nullopt;
}

std::string OperatorSource::silent_driver(const HeardRobot& robot) const {
  constexpr double kSilent_s = 0.2;  // a driving source sends more often: older commands are stale for the controller
  const bool another = robot.status && !robot.status->driving_source.empty() && !drives(*robot.status);
  return another && robot.status->command_age_s > kSilent_s ? robot.status->driving_source : "";
}

std::int64_t session_number() {
  using std::chrono::system_clock;
  return std::chrono::nanoseconds(system_clock::now().time_since_epoch()).count();
}

OperatorSource::OperatorSource(io::LcmLink& link, const std::string& name, std::int64_t session, const io::Clock& clock,
                               seal::OperatorSeal seal)
    : link_(link), clock_(clock), seal_(std::move(seal)) {
  command_.version = pmg_msgs::command_t::VERSION;
  mode_.version = pmg_msgs::mode_t::VERSION;
  hoist_.version = pmg_msgs::hoist_t::VERSION;
  command_.source = mode_.source = hoist_.source = name;
  command_.session = mode_.session = hoist_.session = session;
  link_.subscribe("STATUS", [this](io::Bytes message) { hear_status(message); });
  link_.subscribe("ACK", [this](io::Bytes message) { hear_ack(message); });
  link_.subscribe("HOIST_STATE", [this](io::Bytes message) { hear_hoist(message); });
}

void OperatorSource::send_command(const std::string& robot, const Command& command, double lease_s) {
  command_.robot = robot;
  command_.stamp_ns = clock_.now_ns();
  ++command_.sequence;
  command_.lease_s = lease_s;
  command_.vx_m_s = command[kVx];
  command_.vy_m_s = command[kVy];
  command_.omega_rad_s = command[kOmega];
  command_.pitch_rad = command[kPitch];
  command_.roll_rad = command[kRoll];
  command_.height_m = command[kHeight];
  send("COMMAND", command_);
}

void OperatorSource::request(const std::string& robot, std::int8_t mode, bool reset_fault) {
  for (auto& [name, heard] : heard_) heard.ack.reset();
  mode_.robot = robot;
  ++mode_.sequence;
  mode_.mode = mode;
  mode_.reset_fault = reset_fault ? 1 : 0;
  asked_.begin();
  repeat_request();
}

void OperatorSource::repeat_request() {
  mode_.stamp_ns = clock_.now_ns();
  asked_.sent(seal_.digest(mode_));
  send("MODE", mode_);
}

void OperatorSource::request_hoist(const std::string& robot, bool lift) {
  hoist_.robot = robot;
  ++hoist_.sequence;
  hoist_.request = lift ? pmg_msgs::hoist_t::LIFT : pmg_msgs::hoist_t::LOWER;
  repeat_hoist();
}

void OperatorSource::repeat_hoist() {
  hoist_.stamp_ns = clock_.now_ns();
  send("HOIST", hoist_);
}

bool OperatorSource::hoist_answer(const pmg_msgs::hoist_state_t& hoist) const noexcept {
  return hoist.source == hoist_.source && hoist.session == hoist_.session && hoist.sequence >= hoist_.sequence;
}

const HeardRobot* OperatorSource::heard(const std::string& robot) const {
  const auto found = heard_.find(robot);
  return found == heard_.end() ? nullptr : &found->second;
}

void OperatorSource::hear_status(io::Bytes bytes) {
  const auto heard = seal::decode_sealed<pmg_msgs::status_t, pmg_msgs::proof_t>(bytes);
  if (!heard) return;
  const pmg_msgs::status_t& status = heard->message;
  const std::int64_t now_ns = clock_.now_ns();
  const auto known = heard_.find(status.robot);
  // A recording costs no look at its signature.
  if (known != heard_.end() && !known->second.order.news(boot_of(heard->seal), status.stamp_ns, now_ns)) return;
  auto peer = seal_.believe("STATUS", heard->message_bytes, heard->seal, now_ns);
  HeardRobot* robot = peer ? place_of(status.robot) : nullptr;
  if (robot == nullptr || !robot->order.take(peer->boot, status.stamp_ns, now_ns)) return;
  if (robot->peer && robot->peer->boot != peer->boot) robot->hoist = {};  // an earlier start's
  peer->heard_ns = status.stamp_ns;
  robot->peer = peer;
  robot->status = status;
  robot->status_heard_ns = now_ns;
}

void OperatorSource::hear_ack(io::Bytes bytes) {
  const auto heard = seal::decode_sealed<pmg_msgs::ack_t, pmg_msgs::proof_t>(bytes);
  if (!heard) return;
  const pmg_msgs::ack_t& ack = heard->message;
  if (!asked_.answered_by(ack) || !seal_.believe("ACK", heard->message_bytes, heard->seal, clock_.now_ns())) return;
  if (HeardRobot* robot = place_of(ack.robot)) robot->ack = ack;
}

void OperatorSource::hear_hoist(io::Bytes bytes) {
  const auto heard = seal::decode_sealed<pmg_msgs::hoist_state_t, pmg_msgs::proof_t>(bytes);
  const auto known = heard ? heard_.find(heard->message.robot) : heard_.end();  // without STATUS it is no controller's
  if (known == heard_.end() || !known->second.peer) return;
  known->second.hoist.hear(*heard, known->second.peer->boot, seal_, clock_.now_ns());
}

HeardRobot* OperatorSource::place_of(const std::string& robot) {
  if (heard_.size() >= kMostRobots && !heard_.contains(robot)) return nullptr;
  const auto [place, is_new] = heard_.try_emplace(robot);
  if (is_new) place->second.first_heard_ns = clock_.now_ns();
  return &place->second;
}

}  // namespace pmg::ops
