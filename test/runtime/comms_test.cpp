// Comms: the controller's messages on the network, and other senders under its name.
#include "runtime/comms.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <barrier>
#include <cstdlib>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "control/fixtures.hpp"
#include "io/private_network.hpp"
#include "pmg_msgs/mode_t.hpp"

namespace pmg::runtime {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr std::int64_t kTick_ns = 10'000'000;

/// The message before its proof.
template <typename Message>
Message message_in(io::Bytes bytes) {
  return seal::decode_sealed<Message, pmg_msgs::proof_t>(bytes).value().message;
}

class CommsTest : public testing::Test {
 protected:
  CommsTest() {
    for (const char* channel : {"ACK", "STATUS", "STATE", "REFERENCE", "MOTOR_COMMAND", "TIMING", "FAULT", "ROBOT_INFO",
                                "LINK", "ARMS_STATE"}) {
      link_.subscribe(channel, [this, channel](io::Bytes) { ++heard_[channel]; });
    }
    link_.subscribe("TIMING", [this](io::Bytes bytes) { timing_ = *io::decode_message<pmg_msgs::timing_t>(bytes); });
    link_.subscribe("ACK", [this](io::Bytes bytes) { ack_ = message_in<pmg_msgs::ack_t>(bytes); });
    link_.subscribe("LINK", [this](io::Bytes bytes) { counts_ = *io::decode_message<pmg_msgs::link_t>(bytes); });
    link_.subscribe("STATUS", [this](io::Bytes bytes) { status_ = message_in<pmg_msgs::status_t>(bytes); });
    comms_.on_warning = [this](const std::string& text) { warnings_.push_back(text); };
    const int n = robot_.joint_index.size();
    record_.state = test::standing_state(robot_);
    JointVector zero = JointVector::Zero(n);
    record_.result.reference.q = record_.result.reference.dq = zero;
    record_.result.command = {.q = zero, .dq = zero, .kp = zero, .kd = zero, .tau_ff = zero};
  }

  /// A tick's record and a step of comms, twice, so that this test receives it.
  void tick() {
    clock_.advance_to(clock_.now_ns() + kTick_ns);
    record_.now_ns = clock_.now_ns();
    outbox_.newest.put(record_);
    comms_.step(0);
    link_.receive(0);
  }
  void say_status(const std::string& robot, std::int64_t session) {
    pmg_msgs::status_t status{};
    status.robot = robot;
    status.session = session;
    link_.publish("STATUS", status);
  }
  static pmg_msgs::mode_t stop() {
    pmg_msgs::mode_t message{};
    message.version = pmg_msgs::mode_t::VERSION;
    message.source = "pendant";
    message.mode = pmg_msgs::mode_t::DAMPING;
    return message;
  }

  const model::RobotModel& robot_ = test::biped();
  io::SimulationClock clock_;
  io::LcmLink link_{"memq://"};
  hal::StopLine stop_line_;
  control::OperatorInbox inbox_{stop_line_};
  control::ControllerOutbox outbox_;
  recording::RunInfo run_{.robot = "biped", .session = 17};
  Comms comms_{link_, inbox_, outbox_, robot_, run_, 100.0, clock_};
  control::TickRecord record_;
  std::map<std::string, int> heard_;
  std::vector<std::string> warnings_;
  pmg_msgs::ack_t ack_;
  pmg_msgs::timing_t timing_{};
  pmg_msgs::link_t counts_;
  pmg_msgs::status_t status_;
};

TEST_F(CommsTest, EveryTickIsToldOnceAndWhoRunsWhatOnceASecond) {
  for (int k = 0; k < 250; ++k) tick();
  comms_.step(0);  // no newer tick: nothing new to send
  link_.receive(0);
  EXPECT_EQ(heard_["STATUS"], 250);
  EXPECT_EQ(heard_["STATE"], 250);
  EXPECT_EQ(heard_["REFERENCE"], 250);
  EXPECT_EQ(heard_["MOTOR_COMMAND"], 250);
  EXPECT_EQ(heard_["TIMING"], 250);
  EXPECT_EQ(heard_["ROBOT_INFO"], 3) << "at once, and after 1 s and 2 s";
  EXPECT_EQ(heard_["LINK"], 3);
  EXPECT_EQ(status_.robot, "biped");
  EXPECT_EQ(status_.session, 17);
  EXPECT_THAT(warnings_, IsEmpty()) << "its own STATUS is no other controller's";
}

TEST_F(CommsTest, EveryAnswerIsSent) {
  outbox_.acks.push(
      {.source = control::Source::make("pendant", 5), .sequence = 3, .verdict = control::Verdict::kNotYours});
  outbox_.acks.push({.source = control::Source::make("pendant", 5), .sequence = 4, .mode = control::Mode::kDamping});
  tick();
  EXPECT_EQ(heard_["ACK"], 2);
  EXPECT_EQ(ack_.robot, "biped");
  EXPECT_EQ(ack_.source, "pendant");
  EXPECT_EQ(ack_.session, 5);
  EXPECT_EQ(ack_.sequence, 4);
  EXPECT_EQ(ack_.mode, pmg_msgs::mode_t::DAMPING);
}

TEST_F(CommsTest, AnswersThatFindTheQueueFullAreCountedAndTheCountIsPublished) {
  constexpr std::size_t kQueue = 64, kTicks = kQueue / control::kMaxRequests + 1;
  record_.result.ack_count = control::kMaxRequests;
  for (std::size_t k = 0; k < kTicks; ++k) outbox_.put(record_);
  record_.result.ack_count = 0;
  tick();
  EXPECT_EQ(heard_["ACK"], static_cast<int>(kQueue));
  EXPECT_EQ(timing_.dropped_acks, static_cast<std::int64_t>(control::kMaxRequests));
}

TEST_F(CommsTest, AFaultIsToldOnceHoweverLongItIsLatched) {
  for (int k = 0; k < 5; ++k) tick();
  record_.result.mode = control::Mode::kFault;
  record_.result.fault = {.code = faults::FaultCode::kTilt, .value = 1.2, .limit = 1.0, .stamp_ns = clock_.now_ns()};
  for (int k = 0; k < 5; ++k) tick();
  EXPECT_EQ(heard_["FAULT"], 1);
  EXPECT_THAT(status_.fault, HasSubstr("tilt"));
  record_.result.mode = control::Mode::kDamping;
  record_.result.fault = faults::Fault{};
  for (int k = 0; k < 5; ++k) tick();
  record_.result.mode = control::Mode::kFault;
  record_.result.fault = {.code = faults::FaultCode::kTilt, .value = 1.2, .limit = 1.0, .stamp_ns = clock_.now_ns()};
  for (int k = 0; k < 5; ++k) tick();
  EXPECT_EQ(heard_["FAULT"], 2) << "the same cause again is another fault";
}

TEST_F(CommsTest, ArmsAreToldTenTimesASecondAndWhenTheySaySomethingNew) {
  for (int k = 0; k < 50; ++k) tick();
  EXPECT_EQ(heard_["ARMS_STATE"], 0) << "a robot without arms";
  record_.result.arms.there = true;
  for (int k = 0; k < 100; ++k) tick();
  EXPECT_EQ(heard_["ARMS_STATE"], 10);
  record_.result.arms.arm[kRight].activity = arms::ArmActivity::kBlocked;
  tick();
  record_.result.arms.order = control::ArmsOrder::kLeaseOver;
  tick();
  record_.result.arms.refused = 1;
  tick();
  tick();
  EXPECT_EQ(heard_["ARMS_STATE"], 13);
}

TEST_F(CommsTest, LinkTellsWhatBecameOfEveryMessage) {
  record_.result.ignored = {
      .accepted = 1, .other_source = 2, .out_of_order = 3, .late = 4, .not_finite = 5, .no_lease = 6, .no_arms = 7};
  link_.send("COMMAND", std::vector<std::uint8_t>{1, 2, 3});
  pmg_msgs::mode_t request = stop();
  request.mode = pmg_msgs::mode_t::STAND;
  const auto send = [&](int times) {
    for (int k = 0; k < times; ++k) link_.publish("MODE", request);
  };
  request.version = pmg_msgs::mode_t::VERSION - 1;
  send(2);
  request.version = pmg_msgs::mode_t::VERSION;
  request.robot = "another";
  send(3);
  request.robot = "biped";
  send(4);  // without a seal
  request.mode = pmg_msgs::mode_t::DAMPING;
  send(4 + 5);  // room for four
  tick();
  EXPECT_EQ(counts_.robot, "biped");
  EXPECT_EQ(counts_.accepted, 1);
  EXPECT_EQ(counts_.malformed, 1);
  EXPECT_EQ(counts_.other_version, 2);
  EXPECT_EQ(counts_.other_robot, 3);
  EXPECT_EQ(counts_.not_fresh, 4);
  EXPECT_EQ(counts_.flooded, 5);
  EXPECT_EQ(counts_.other_source, 2);
  EXPECT_EQ(counts_.out_of_order, 3);
  EXPECT_EQ(counts_.late, 4);
  EXPECT_EQ(counts_.not_finite, 5);
  EXPECT_EQ(counts_.no_lease, 6);
  EXPECT_EQ(counts_.no_arms, 7);
}

TEST_F(CommsTest, WhatIsWrongIsSaidOnTheConsoleOnce) {
  for (int k = 0; k < 5; ++k) {
    link_.send("COMMAND", std::vector<std::uint8_t>{1, 2, 3});
    tick();
  }
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("malformed")));
}

/// Another controller of our name, on the same network.
struct OtherController {
  OtherController(io::LcmLink& link, const io::Clock& clock, std::int64_t number,
                  const std::optional<seal::ControllerKeys>& keys = std::nullopt)
      : run{.robot = "biped", .session = number},
        comms(link, inbox, outbox, test::biped(), run, 100.0, clock, seal::ControllerSeal(keys)) {}

  hal::StopLine stop_line;
  control::OperatorInbox inbox{stop_line};
  control::ControllerOutbox outbox;
  recording::RunInfo run;
  Comms comms;
};

TEST_F(CommsTest, AControllerOfTheSameNameIsRefusedInOneLineThatSaysWhatToDo) {
  OtherController runs(link_, clock_, 16);
  runs.comms.step(0);
  try {
    comms_.listen_for_others(60.0);
    FAIL() << "two controllers of one name";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("\"biped\""), HasSubstr("session 16"), HasSubstr("memq://"),
                                    HasSubstr("--name"), HasSubstr("--lcm-url"), Not(HasSubstr("\n"))));
  }
}

TEST_F(CommsTest, NoRecordingPreventsAStartOrWarnsOfAnotherController) {
  for (const auto& keys : {std::optional<seal::ControllerKeys>(),
                           std::optional(seal::ControllerKeys{.own = seal::random_secret(), .operators = {}})}) {
    std::vector<std::pair<std::string, std::vector<std::uint8_t>>> recorded;
    {  // of earlier starts: two that met, one of them gave way
      io::LcmLink earlier("memq://");
      for (const char* channel : {"STATUS", "CLAIM"}) {
        earlier.subscribe(channel, [&recorded, channel](io::Bytes bytes) {
          recorded.emplace_back(channel, std::vector<std::uint8_t>(bytes.begin(), bytes.end()));
        });
      }
      OtherController first(earlier, clock_, 3, keys), second(earlier, clock_, 4, keys);
      first.outbox.newest.put(record_);
      first.comms.step(0);
      EXPECT_THROW(second.comms.listen_for_others(60.0), std::runtime_error);
      earlier.receive(0);
    }
    EXPECT_GE(recorded.size(), 3u) << "a STATUS, a question and its answer";
    OtherController starts(link_, clock_, 17, keys);
    std::vector<std::string> warnings;
    starts.comms.on_warning = [&](const std::string& text) { warnings.push_back(text); };
    const auto play = [&] {
      for (const auto& [channel, bytes] : recorded) link_.send(channel, bytes);
    };
    play();
    EXPECT_NO_THROW(starts.comms.listen_for_others(0.0));
    for (int k = 0; k < 10; ++k) {
      clock_.advance_to(clock_.now_ns() + 300'000'000);
      play();
      starts.comms.step(0);
    }
    EXPECT_THAT(warnings, IsEmpty());
    EXPECT_EQ(starts.comms.impostors_heard(), 0);
  }
}

TEST_F(CommsTest, RobotsOfOtherNamesAreWelcomeAndNamed) {
  for (int k = 0; k < 3; ++k) say_status("z1", 16);
  say_status("z2", 16);
  say_status("\x1b[2J", 16);
  EXPECT_THAT(comms_.listen_for_others(0.0), ElementsAre("z1", "z2"));
}

TEST_F(CommsTest, OperatorsAreNotHeardBeforeTheControllerRuns) {
  link_.publish("MODE", stop());
  comms_.listen_for_others(0.0);
  control::ModeRequest request;
  EXPECT_FALSE(inbox_.take(request)) << "a stale request would be the first tick's";
  EXPECT_EQ(stop_line_.pulls(), 0u);
}

TEST_F(CommsTest, AStatusThatForgesOurBootNumberIsSaidOnce) {
  for (const auto& keys : {std::optional<seal::ControllerKeys>(),
                           std::optional(seal::ControllerKeys{.own = seal::random_secret(), .operators = {}})}) {
    OtherController robot(link_, clock_, 17, keys);
    std::vector<std::string> warnings;
    robot.comms.on_warning = [&](const std::string& text) { warnings.push_back(text); };
    std::vector<std::uint8_t> said;
    const auto step = [&] {
      clock_.advance_to(clock_.now_ns() + kTick_ns);
      record_.now_ns = clock_.now_ns();
      robot.outbox.newest.put(record_);
      robot.comms.step(0);
      link_.receive(0);
    };
    bool records = true;
    link_.subscribe("STATUS", [&said, &records](io::Bytes bytes) {
      if (records) said.assign(bytes.begin(), bytes.end());
    });
    for (int k = 0; k < 5; ++k) step();
    records = false;
    EXPECT_THAT(warnings, IsEmpty()) << "its own";
    const auto proven = seal::decode_sealed<pmg_msgs::status_t, pmg_msgs::proof_t>(said).value();
    pmg_msgs::status_t forged = proven.message;
    forged.mode = pmg_msgs::mode_t::WALK;
    std::vector<std::uint8_t> bytes;
    seal::append(bytes, forged);
    seal::append(bytes, *proven.seal);
    for (int k = 0; k < 3; ++k) {
      link_.send("STATUS", bytes);
      step();
    }
    EXPECT_THAT(warnings, ElementsAre(HasSubstr("speaks as robot \"biped\"")));
  }
}

TEST_F(CommsTest, AnotherControllerOfOurNameThatComesLaterIsSaidOnce) {
  tick();
  OtherController later(link_, clock_, 18);
  for (int k = 0; k < 250; ++k) {
    say_status("biped", 18);
    say_status("z1", 18);
    tick();
  }
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("another controller (session 18)")));
  EXPECT_EQ(comms_.impostors_heard(), 3) << "asked once a second, and it answered";
}

TEST_F(CommsTest, AFloodOfQuestionsForTheNameIsAnsweredAtABoundedRate) {
  tick();
  int claims = 0;
  link_.subscribe("CLAIM", [&](io::Bytes) { ++claims; });
  constexpr int kPerTick = 100, kTicks = 20;
  for (int k = 0; k < kTicks; ++k) {
    for (int n = 0; n < kPerTick; ++n) {
      seal::ControllerSeal asks;
      link_.send("CLAIM", asks.prove("CLAIM", pmg_msgs::claim_t{.stamp_ns = clock_.now_ns(),
                                                                .robot = "biped",
                                                                .session = n,
                                                                .held = 0,
                                                                .answers = pmg_msgs::claim_t::NOBODY}));
    }
    tick();
  }
  const int answers = claims - kTicks * kPerTick;
  EXPECT_EQ(answers, kTicks) << "those of one step come at one time";
}

TEST_F(CommsTest, WhoIsToldThatARequestWasTakenHasHeardTheStateOfIt) {
  std::vector<std::string> order;
  for (const char* channel : {"STATUS", "ACK"}) {
    link_.subscribe(channel, [&order, channel](io::Bytes) { order.emplace_back(channel); });
  }
  outbox_.acks.push(control::ModeAck{});
  tick();
  EXPECT_THAT(order, ElementsAre("STATUS", "ACK"));
}

TEST_F(CommsTest, AStopIsTakenWithoutWaitingForTheNextTick) {
  link_.publish("MODE", stop());
  comms_.step(0);
  EXPECT_EQ(stop_line_.pulls(), 1u);
}

TEST_F(CommsTest, AFloodIsLeftForTheNextStepsSoThatEveryStepPublishes) {
  for (int k = 0; k < 600; ++k) link_.publish("MODE", stop());
  record_.now_ns = clock_.now_ns();
  outbox_.newest.put(record_);
  comms_.step(0);
  EXPECT_EQ(stop_line_.pulls(), 500u);
  link_.receive(0);
  EXPECT_EQ(heard_["STATUS"], 1);
  EXPECT_EQ(stop_line_.pulls(), 600u);
}

/// Controllers of one name on one network, each starting in a thread of its own; the number that won it.
int winners(int controllers, const std::vector<seal::ControllerKeys>& keys = {}) {
  const std::string url = "udpm://239.255.76.67:7667?ttl=0";
  std::atomic<int> won{0}, refused{0};
  std::vector<std::thread> threads;
  std::barrier<> begin(controllers), end(controllers);
  for (int k = 0; k < controllers; ++k) {
    threads.emplace_back([&, k] {
      const io::WallClock clock;
      io::LcmLink link(url);
      hal::StopLine stop_line;
      control::OperatorInbox inbox(stop_line);
      control::ControllerOutbox outbox;
      const recording::RunInfo run{.robot = "biped", .session = k};
      const auto mine = keys.empty() ? std::nullopt : std::optional(keys[static_cast<std::size_t>(k) % keys.size()]);
      Comms comms(link, inbox, outbox, test::biped(), run, 100.0, clock, seal::ControllerSeal(mine));
      begin.arrive_and_wait();
      std::optional<HeldClaim> claim;
      try {
        comms.listen_for_others(0.3);
        claim.emplace(comms.hold_name());
        ++won;
      } catch (const std::runtime_error&) {
        ++refused;
      }
      end.arrive_and_wait();
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(won + refused, controllers);
  return won;
}

TEST(NameClaim, OfControllersThatStartTogetherExactlyOneGetsTheName) {
  const char* tries = std::getenv("PMG_CLAIM_TRIES");  // 50 for the campaign
  PMG_IN_PRIVATE_NETWORK(io::Multicast::kOnLoopback, [&] {
    for (int k = 0; k < (tries != nullptr ? std::atoi(tries) : 4); ++k) EXPECT_EQ(winners(2 + k % 3), 1) << "try " << k;
  });
}

TEST(NameClaim, ControllersWithDifferentKeysAreDifferentRobotsForTheirOperators) {
  PMG_IN_PRIVATE_NETWORK(io::Multicast::kOnLoopback, [&] {
    const std::vector<seal::ControllerKeys> keys = {{.own = seal::random_secret(), .operators = {}},
                                                    {.own = seal::random_secret(), .operators = {}}};
    EXPECT_EQ(winners(2, keys), 2) << "a forged claim prevents no start";
    EXPECT_EQ(winners(2, {keys[0], keys[0]}), 1);
  });
}

TEST(NameClaim, WhoHoldsTheNameKeepsItUntilItsFirstStatus) {
  PMG_IN_PRIVATE_NETWORK(io::Multicast::kOnLoopback, [&] {
    const io::WallClock clock;
    hal::StopLine stop_line;
    control::OperatorInbox inbox(stop_line);
    control::ControllerOutbox outbox;
    const recording::RunInfo run{.robot = "biped"};
    io::LcmLink first_link("udpm://239.255.76.67:7667?ttl=0"), later_link(first_link.url());
    Comms first(first_link, inbox, outbox, test::biped(), run, 100.0, clock);
    first.listen_for_others(0.0);
    const HeldClaim held = first.hold_name();
    for (int k = 0; k < 4; ++k) {  // whatever their boot numbers are
      Comms later(later_link, inbox, outbox, test::biped(), run, 100.0, clock);
      EXPECT_THROW(later.listen_for_others(60.0), std::runtime_error);
    }
  });
}

TEST(NameLock, OneProgramOfThisComputerHoldsAName) {
  const std::string name = "lock_test_" + std::to_string(::getpid()), url = "udpm://239.255.76.67:7667?ttl=0";
  {
    const NameLock lock(name, url);
    try {
      const NameLock second(name, "udpm://239.255.76.67:7667?ttl=1&recv_buf_size=9");
      FAIL() << "two controllers of one name";
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr(name), HasSubstr("process " + std::to_string(::getpid())),
                                      HasSubstr("--name"), Not(HasSubstr("\n"))));
    }
    const NameLock another_name(name + "b", url), another_address(name, "udpm://239.255.76.67:7668?ttl=0");
    const NameLock long_name(std::string(200, 'x') + name, url);
  }
  const NameLock again(name, url);
}

}  // namespace
}  // namespace pmg::runtime
