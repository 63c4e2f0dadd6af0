#include "runtime/comms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "pmg_msgs/claim_t.hpp"
#include "recording/tick_messages.hpp"

namespace pmg::runtime {

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000, kHoistPeriod_ns = 100'000'000, kArmsPeriod_ns = 100'000'000;
constexpr std::int64_t kVerifyPeriod_ns =
    10'000'000;  // a signature takes 0.1 ms: a flood of forged ones must delay no stop
constexpr std::int64_t kAnswerPeriod_ns = 2'000'000;  // a flood of questions must delay no stop, either
constexpr int kAsk_ms = 20;
constexpr std::size_t kMostOthers = 16;  // names that are told at start: a flood of invented ones ends here

}  // namespace

Comms::Comms(io::LcmLink& link, control::OperatorInbox& inbox, control::ControllerOutbox& outbox,
             const model::RobotModel& robot, const recording::RunInfo& run, double control_rate_Hz,
             const io::Clock& clock, seal::ControllerSeal seal)
    : link_(link),
      outbox_(outbox),
      robot_(robot),
      run_(run),
      control_rate_Hz_(control_rate_Hz),
      clock_(clock),
      seal_(std::move(seal)),
      contest_(seal_.boot()),
      gate_(inbox, run.robot, clock, seal_, order_),
      hoist_gate_(run.robot, clock, seal_, order_),
      next_second_ns_(clock.now_ns()),
      next_hoist_ns_(clock.now_ns()),
      next_arms_ns_(clock.now_ns()) {
  state_.robot = reference_.robot = motor_command_.robot = timing_.robot = run_.robot;
  link_.subscribe("COMMAND", [this](io::Bytes message) {
    if (!listening_) gate_.take_command(message);
  });
  link_.subscribe("MODE", [this](io::Bytes message) {
    if (!listening_) gate_.take_mode(message);
  });
  link_.subscribe("ARMS", [this](io::Bytes message) {
    if (!listening_) gate_.take_arms(message);
  });
  link_.subscribe("HOIST", [this](io::Bytes message) {
    if (!listening_) hoist_gate_.take(message);
  });
  link_.subscribe("STATUS", [this](io::Bytes message) { hear_status(message); });
  link_.subscribe("CLAIM", [this](io::Bytes message) { hear_claim(message); });
}

void Comms::hear_status(io::Bytes bytes) {
  const auto heard = seal::decode_sealed<pmg_msgs::status_t, pmg_msgs::proof_t>(bytes);
  if (!heard) return;  // nobody's request: not counted as one
  const pmg_msgs::status_t& status = heard->message;
  if (status.robot != run_.robot) {
    const bool known = std::ranges::find(others_, status.robot) != others_.end();
    if (listening_ && !known && others_.size() < kMostOthers && presentable(status.robot)) {
      others_.push_back(status.robot);
    }
    return;
  }
  const bool own_number = heard->seal && heard->seal->boot == seal_.boot();
  if (own_number && said(bytes)) return;
  if (may_verify()) {
    if (!seal_.ours("STATUS", heard->message_bytes, heard->seal) || (own_number && !seal_.has_keys())) {
      ++forgeries_heard_;
    } else if (!own_number && contest_.holds() &&
               clock_.now_ns() >= ask_at_ns_) {  // another controller's, or a recording: ask
      ask_at_ns_ = clock_.now_ns() + kSecond_ns;
      claim(pmg_msgs::claim_t::NOBODY);
    }
  }
}

bool Comms::said(io::Bytes status) const { return std::ranges::find(said_, seal::digest_of(status)) != said_.end(); }

void Comms::hear_claim(io::Bytes bytes) {
  using Reaction = NameContest::Reaction;
  const auto heard = seal::decode_sealed<pmg_msgs::claim_t, pmg_msgs::proof_t>(bytes);
  if (!heard || !heard->seal || heard->message.robot != run_.robot) return;
  const Reaction reaction = contest_.hear(heard->message, heard->seal->boot);
  if (reaction == Reaction::kNone || (reaction == Reaction::kAnswer && clock_.now_ns() < answer_at_ns_)) return;
  if (!may_verify()) return;
  if (!seal_.ours("CLAIM", heard->message_bytes, heard->seal)) {
    ++forgeries_heard_;
  } else if (reaction == Reaction::kAnswer) {
    answer_at_ns_ = clock_.now_ns() + kAnswerPeriod_ns;
    claim(heard->seal->boot);
  } else {
    ++impostors_heard_;
    impostor_session_ = heard->message.session;
  }
}

bool Comms::may_verify() {
  if (listening_ || !seal_.has_keys()) return true;
  if (clock_.now_ns() < verify_at_ns_) return false;
  verify_at_ns_ = clock_.now_ns() + kVerifyPeriod_ns;
  return true;
}

void Comms::claim(std::int64_t answers) {
  const pmg_msgs::claim_t message{.stamp_ns = clock_.now_ns(),
                                  .robot = run_.robot,
                                  .session = run_.session,
                                  .held = contest_.holds(),
                                  .answers = answers};
  link_.send("CLAIM", seal_.prove("CLAIM", message));
}

HeldClaim Comms::hold_name() {
  contest_.hold();
  return HeldClaim([this] { link_.receive(HeldClaim::kWait_ms); });
}

std::vector<std::string> Comms::listen_for_others(double seconds, const std::function<bool()>& interrupted) {
  using std::chrono::steady_clock;
  listening_ = true;
  const auto end = steady_clock::now() + std::chrono::duration<double>(seconds);
  auto claim_at = steady_clock::now();
  do {
    if (steady_clock::now() >= claim_at) {
      claim(pmg_msgs::claim_t::NOBODY);
      claim_at = steady_clock::now() + std::chrono::milliseconds(kAsk_ms);
    }
    link_.receive(10);
  } while (impostors_heard_ == 0 && steady_clock::now() < end && !(interrupted && interrupted()));
  if (impostors_heard_ > 0) {
    throw std::runtime_error(
        fmt::format("robot \"{}\" is already run by another controller (session {}) on {}: end that one, or start this "
                    "one with another --name or --lcm-url",
                    run_.robot, impostor_session_, link_.url()));
  }
  return others_;
}

void Comms::step(int timeout_ms) {
  listening_ = false;
  contest_.hold();
  link_.receive(timeout_ms);
  publish_newest();  // who is told that a stop was taken knows of it
  publish_acks();
  publish_hoist();
  if (clock_.now_ns() >= next_second_ns_) {
    next_second_ns_ = clock_.now_ns() + kSecond_ns;
    publish_each_second();
  }
  warn();
}

void Comms::warn() {
  const GateCounts counts = gate_.counts() + hoist_gate_.counts();
  const auto once = [&](Warning warning, bool wrong, const auto& text) {
    bool& warned = warned_[static_cast<std::size_t>(warning)];
    if (!wrong || warned) return;
    warned = true;
    if (on_warning) on_warning(text());
  };
  once(Warning::kImpostor, impostors_heard_ > 0, [&] {
    return fmt::format(
        "another controller (session {}) speaks as robot \"{}\" on {}: both hear the same operators; end one of them",
        impostor_session_, run_.robot, link_.url());
  });
  once(Warning::kForgery, forgeries_heard_ > 0, [&] {
    return seal_.has_keys()
               ? fmt::format(
                     "somebody without this controller's key speaks as robot \"{}\" on {}; nobody with keys believes "
                     "it",
                     run_.robot, link_.url())
               : fmt::format("somebody else speaks as robot \"{}\" on {}, and there are no keys to tell them apart",
                             run_.robot, link_.url());
  });
  once(Warning::kMalformed, counts.malformed > 0,
       [] { return std::string("malformed operators' messages are ignored; LINK counts them"); });
  once(Warning::kVersion, counts.other_version > 0,
       [] { return std::string("operators' messages of another version are ignored; LINK counts them"); });
  once(Warning::kKey, counts.no_key > 0, [] {
    return std::string("operators' messages without a key of this controller are ignored; LINK counts them");
  });
  once(Warning::kFlood, counts.flooded > 0,
       [] { return std::string("operators send more than they are listened to; LINK counts what is ignored"); });
  once(Warning::kNetwork, link_.publish_errors() > 0,
       [&] { return fmt::format("the network refuses what is published on {}; the controller goes on", link_.url()); });
}

void Comms::publish_acks() {
  const auto send = [&](const control::ModeAck& ack) {
    recording::fill(ack, run_, clock_.now_ns(), ack_);
    link_.send("ACK", seal_.prove("ACK", ack_));
  };
  outbox_.acks.consume_all(send);
  for (control::ModeAck& refusal : gate_.take_refusals()) {
    refusal.mode = newest_.result.mode;
    send(refusal);
  }
}

void Comms::publish_newest() {
  if (!outbox_.newest.take(newest_)) return;
  hoist_gate_.see(newest_.result);
  const int joint_count = robot_.joint_index.size();
  recording::fill(newest_, run_, robot_, status_);
  const io::Bytes status = seal_.prove("STATUS", status_);
  said_[said_count_++ % said_.size()] = seal::digest_of(status);
  link_.send("STATUS", status);
  recording::fill(newest_, joint_count, state_);
  link_.publish("STATE", state_);
  recording::fill(newest_, joint_count, reference_);
  link_.publish("REFERENCE", reference_);
  recording::fill(newest_, joint_count, motor_command_);
  link_.publish("MOTOR_COMMAND", motor_command_);
  // The bus cycles go to the recorder, whose TIMING has them.
  recording::fill(newest_, recording::BusTiming{}, outbox_.dropped(), timing_);
  link_.publish("TIMING", timing_);

  const faults::Fault& fault = newest_.result.fault;
  const bool told = fault.code == published_fault_.code && fault.stamp_ns == published_fault_.stamp_ns;
  if (newest_.result.mode == control::Mode::kFault && !told) {
    recording::fill(newest_, run_, robot_, fault_);
    link_.publish("FAULT", fault_);
  }
  published_fault_ = fault;
  publish_arms();
}

void Comms::publish_hoist() {
  const bool news = hoist_gate_.fill(hoist_state_);
  if (!hoist_gate_.there() || (!news && clock_.now_ns() < next_hoist_ns_)) return;
  next_hoist_ns_ = clock_.now_ns() + kHoistPeriod_ns;
  hoist_state_.stamp_ns = clock_.now_ns();
  link_.send("HOIST_STATE", seal_.prove("HOIST_STATE", hoist_state_));
}

void Comms::publish_arms() {
  const control::ArmsState& arms = newest_.result.arms;
  const auto activity = [&](Foot arm) { return static_cast<std::int8_t>(arms.arm[arm].activity); };
  const bool news = arms_state_.left != activity(kLeft) || arms_state_.right != activity(kRight) ||
                    arms_state_.order != static_cast<std::int8_t>(arms.order) || arms_state_.refused != arms.refused;
  if (!arms.there || (!news && clock_.now_ns() < next_arms_ns_)) return;
  next_arms_ns_ = clock_.now_ns() + kArmsPeriod_ns;
  recording::fill(newest_, run_, arms_state_);
  link_.send("ARMS_STATE", seal_.prove("ARMS_STATE", arms_state_));
}

void Comms::publish_each_second() {
  const std::int64_t now_ns = clock_.now_ns();
  if (const std::string news = seal_.refresh(); !news.empty() && on_warning) on_warning(news);
  recording::fill(run_, robot_, control_rate_Hz_, now_ns, info_);
  link_.publish("ROBOT_INFO", info_);

  const GateCounts gate = gate_.counts() + hoist_gate_.counts();
  const control::IgnoredCommands& intake = newest_.result.ignored;
  counts_.stamp_ns = now_ns;
  counts_.robot = run_.robot;
  counts_.accepted = intake.accepted;
  counts_.malformed = gate.malformed;
  counts_.other_version = gate.other_version;
  counts_.other_robot = gate.other_robot;
  counts_.not_fresh = gate.not_fresh;
  counts_.no_key = gate.no_key;
  counts_.flooded = gate.flooded;
  counts_.other_source = intake.other_source;
  counts_.out_of_order = intake.out_of_order + gate.out_of_order;
  counts_.late = intake.late;
  counts_.not_finite = intake.not_finite;
  counts_.no_lease = intake.no_lease;
  counts_.no_hoist = gate.no_hoist;
  counts_.no_arms = intake.no_arms;
  link_.publish("LINK", counts_);
}

}  // namespace pmg::runtime
