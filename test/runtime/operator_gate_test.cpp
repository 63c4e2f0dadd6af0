// OperatorGate: no messages of strangers can fill the controller's queues, end it, or hold back a stop.
#include "runtime/operator_gate.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "control/command_intake.hpp"
#include "pmg_msgs/arms_t.hpp"
#include "pmg_msgs/command_t.hpp"
#include "pmg_msgs/mode_t.hpp"
#include "seal/operator_seal.hpp"

namespace pmg::runtime {
namespace {

using Modes = pmg_msgs::mode_t;

constexpr std::int64_t kMillisecond_ns = 1'000'000;

/// The message alone.
template <typename Message>
std::vector<std::uint8_t> encoded(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

class OperatorGateTest : public testing::Test {
 protected:
  OperatorGateTest() {
    command_.version = pmg_msgs::command_t::VERSION;
    mode_.version = Modes::VERSION;
    command_.robot = mode_.robot = "z1";
    command_.source = mode_.source = "gamepad";
    command_.lease_s = 0.5;
    mode_.mode = Modes::STAND;
    arms_.version = pmg_msgs::arms_t::VERSION;
    arms_.robot = "z1";
    arms_.source = "gamepad";
    arms_.lease_s = 0.3;
    arms_.left = pmg_msgs::arms_t::AIM;
    arms_.left_orientation[0] = 1.0;
  }

  void pass_ms(int milliseconds) { clock_.advance_to(clock_.now_ns() + milliseconds * kMillisecond_ns); }
  /// What an operator without a key sends that hears the controller at this moment.
  template <typename Message>
  std::vector<std::uint8_t> sealed(const Message& message) {
    std::vector<std::uint8_t> bytes = encoded(message);
    pmg_msgs::seal_t seal{};
    seal.version = pmg_msgs::seal_t::VERSION;
    seal.boot = seal_.boot();
    seal.heard_ns = clock_.now_ns();
    seal::append(bytes, seal);
    return bytes;
  }
  void send_command(const std::string& source) {
    command_.source = source;
    ++command_.sequence;
    gate_.take_command(sealed(command_));
  }
  void send_mode(const std::string& source, std::int8_t mode) {
    mode_.source = source;
    mode_.mode = mode;
    ++mode_.stamp_ns;
    gate_.take_mode(sealed(mode_));
  }
  /// The commands that the control cycle would take from the inbox, by the names of their sources.
  std::vector<std::string> take_commands() {
    std::vector<std::string> sources;
    for (control::DriveMessage drive; inbox_.take(drive);) sources.emplace_back(drive.source.name.data());
    return sources;
  }
  std::vector<control::ModeRequest> take_requests() {
    std::vector<control::ModeRequest> requests;
    for (control::ModeRequest request; inbox_.take(request);) requests.push_back(request);
    return requests;
  }

  io::SimulationClock clock_;
  hal::StopLine stop_line_;
  control::OperatorInbox inbox_{stop_line_};
  seal::ControllerSeal seal_;
  DatagramOrder order_;
  OperatorGate gate_{inbox_, "z1", clock_, seal_, order_};
  pmg_msgs::command_t command_{};
  Modes mode_{};
  pmg_msgs::arms_t arms_{};
};

TEST_F(OperatorGateTest, ACommandArrivesAsItWasSentWithOurClocksTime) {
  pass_ms(30);
  command_.session = 9;
  command_.sequence = 4;
  command_.stamp_ns = 77;
  command_.vx_m_s = 0.1;
  command_.vy_m_s = 0.2;
  command_.omega_rad_s = 0.3;
  command_.pitch_rad = 0.4;
  command_.roll_rad = 0.5;
  command_.height_m = -0.1;
  gate_.take_command(sealed(command_));
  control::DriveMessage drive;
  ASSERT_TRUE(inbox_.take(drive));
  EXPECT_EQ(drive.source, control::Source::make("gamepad", 9));
  EXPECT_EQ(drive.sequence, 4);
  EXPECT_EQ(drive.stamp_ns, 77);
  EXPECT_EQ(drive.received_ns, 30 * kMillisecond_ns);
  EXPECT_EQ(drive.lease_s, 0.5);
  EXPECT_EQ(drive.command, (Command{{0.1, 0.2, 0.3, 0.4, 0.5, -0.1}}));
  EXPECT_EQ(gate_.counts(), GateCounts{});
}

TEST_F(OperatorGateTest, ForeignMessagesAreCountedByReasonAndIgnored) {
  const auto sent = [&](const std::function<void()>& spoil) {
    const auto [command, mode] = std::pair{command_, mode_};
    spoil();
    gate_.take_command(sealed(command_));
    gate_.take_mode(sealed(mode_));
    command_ = command;
    mode_ = mode;
  };
  sent([&] { command_.version = mode_.version = 1; });
  EXPECT_EQ(gate_.counts().other_version, 2);
  sent([&] { command_.robot = mode_.robot = "z2"; });
  sent([&] { command_.robot = mode_.robot = ""; });
  EXPECT_EQ(gate_.counts().other_robot, 4);
  sent([&] { command_.source = mode_.source = ""; });
  sent([&] { command_.source = mode_.source = "a name of 24 characters."; });
  sent([&] { command_.source = mode_.source = "\x1b[2Jgamepad"; });
  sent([&] { command_.source = mode_.source = std::string("game\0pad", 8); });
  EXPECT_EQ(gate_.counts().malformed, 8);
  gate_.take_command(sealed(mode_));
  gate_.take_mode(sealed(command_));
  EXPECT_EQ(gate_.counts().malformed, 10);
  EXPECT_TRUE(take_commands().empty());
  EXPECT_TRUE(take_requests().empty());
  EXPECT_EQ(stop_line_.pulls(), 0u);
}

TEST_F(OperatorGateTest, WhatWasRecordedIsRefusedAndCounted) {
  pass_ms(5000);
  const std::vector<std::uint8_t> command = sealed(command_), mode = sealed(mode_);
  seal::ControllerSeal restarted;
  OperatorGate after_restart(inbox_, "z1", clock_, restarted, order_);
  after_restart.take_command(command);
  after_restart.take_mode(mode);
  EXPECT_EQ(after_restart.counts(), (GateCounts{.not_fresh = 2})) << "of the controller's last run";
  gate_.take_command(encoded(command_));
  gate_.take_mode(encoded(mode_));
  EXPECT_EQ(gate_.counts(), (GateCounts{.not_fresh = 2})) << "without a seal";
  pass_ms(1001);
  gate_.take_command(command);
  gate_.take_mode(mode);
  EXPECT_EQ(gate_.counts(), (GateCounts{.not_fresh = 4})) << "too old";
  EXPECT_TRUE(take_commands().empty());
  EXPECT_TRUE(take_requests().empty());
}

TEST_F(OperatorGateTest, ARecordingIsRefusedAlsoAfterItsSourceIsForgotten) {
  control::CommandIntake intake;
  const auto accepted = [&] {
    int count = 0;
    for (control::DriveMessage drive; inbox_.take(drive);) {
      count += intake.accept(drive, clock_.now_ns()) == control::CommandIntake::DriveVerdict::kAccepted;
    }
    return count;
  };
  command_.lease_s = 0.01;
  ++command_.sequence;
  const std::vector<std::uint8_t> recorded = sealed(command_);
  gate_.take_command(recorded);
  EXPECT_EQ(accepted(), 1);
  int taken = 0;
  for (int k = 1; k <= 200; ++k) {  // 2 s; every name once, as many as the gate lets in
    pass_ms(10);
    send_command("source " + std::to_string(k));
    accepted();
    gate_.take_command(recorded);
    taken += accepted();
  }
  EXPECT_EQ(taken, 0) << "while it is fresh its source is remembered; afterwards it is not fresh";
  EXPECT_GT(gate_.counts().not_fresh, 90);
}

TEST_F(OperatorGateTest, AStopNeedsNoSealAndWithoutOneItIsNobodysInParticular) {
  mode_.mode = Modes::DAMPING;
  gate_.take_mode(encoded(mode_));
  const std::vector<control::ModeRequest> requests = take_requests();
  ASSERT_EQ(requests.size(), 1u) << "it is acknowledged";
  EXPECT_FALSE(requests[0].sealed);
  EXPECT_EQ(stop_line_.pulls(), 1u);
  send_mode("gamepad", Modes::DAMPING);
  EXPECT_TRUE(take_requests().at(0).sealed);
  mode_.reset_fault = 1;
  gate_.take_mode(encoded(mode_));
  EXPECT_EQ(gate_.counts().not_fresh, 1) << "a reset is no stop";
}

TEST_F(OperatorGateTest, AStopOfAnotherVersionStopsToo) {
  mode_.mode = Modes::DAMPING;
  for (const int version : {0, 1, 3}) {
    mode_.version = version;
    gate_.take_mode(sealed(mode_));
  }
  EXPECT_EQ(stop_line_.pulls(), 3u);
  for (const control::ModeRequest& request : take_requests()) EXPECT_FALSE(request.sealed);
}

TEST_F(OperatorGateTest, AStopStopsWhateverFollowsIt) {
  mode_.mode = Modes::DAMPING;
  std::vector<std::uint8_t> later_seal = sealed(mode_), trailing = sealed(mode_), garbage = encoded(mode_);
  later_seal[encoded(mode_).size()] ^= 1;  // another type's hash
  trailing.push_back(0);
  garbage.insert(garbage.end(), 1000, 0x5a);
  for (const auto& bytes : {later_seal, trailing, garbage}) gate_.take_mode(bytes);
  EXPECT_EQ(stop_line_.pulls(), 3u);
  for (const control::ModeRequest& request : take_requests()) EXPECT_FALSE(request.sealed);
  mode_.mode = Modes::STAND;
  trailing = sealed(mode_);
  trailing.push_back(0);
  gate_.take_mode(trailing);
  EXPECT_EQ(gate_.counts(), (GateCounts{.malformed = 1})) << "any other request must be whole";
}

TEST_F(OperatorGateTest, StopsWithoutASealTakeNobodysPlaceOrAllowance) {
  mode_.mode = Modes::DAMPING;
  for (int k = 0; k < 100; ++k) {
    mode_.source = "stranger " + std::to_string(k);
    gate_.take_mode(encoded(mode_));
  }
  mode_.source = "gamepad";
  for (int k = 0; k < 100; ++k) gate_.take_mode(encoded(mode_));
  EXPECT_EQ(stop_line_.pulls(), 200u);
  take_requests();
  send_command("gamepad");
  send_mode("gamepad", Modes::DAMPING);
  EXPECT_EQ(take_commands().size(), 1u);
  EXPECT_EQ(take_requests().size(), 1u);
}

TEST_F(OperatorGateTest, AStopForNobodyInParticularIsAStopForThisRobot) {
  mode_.robot = "";
  send_mode("pendant", Modes::DAMPING);
  EXPECT_EQ(take_requests().size(), 1u);
  EXPECT_EQ(stop_line_.pulls(), 1u);
  send_mode("pendant", Modes::PASSIVE);
  EXPECT_EQ(stop_line_.pulls(), 2u);
  send_mode("pendant", Modes::STAND);
  mode_.reset_fault = 1;
  send_mode("pendant", Modes::DAMPING);
  EXPECT_EQ(gate_.counts().other_robot, 2) << "standing up and resetting are for one robot";
  EXPECT_EQ(stop_line_.pulls(), 2u);
}

TEST_F(OperatorGateTest, AModeThatDoesNotExistIsAnsweredNotGuessed) {
  for (const int mode : {-128, -1, 4, 5, 127}) {
    pass_ms(100);
    send_mode("gamepad", static_cast<std::int8_t>(mode));
    const std::vector<control::ModeRequest> requests = take_requests();
    ASSERT_EQ(requests.size(), 1u);
    EXPECT_EQ(requests[0].mode, control::Mode::kFault) << "which the intake answers with NO_MODE";
  }
  EXPECT_EQ(stop_line_.pulls(), 0u);
}

TEST_F(OperatorGateTest, AFloodOfOneSourceTakesNoRoomFromAnother) {
  int gamepad = 0, flood = 0;
  for (int ms = 0; ms < 2000; ++ms) {
    pass_ms(1);
    for (int k = 0; k < 100; ++k) {
      command_.session = k;  // a source that invents sessions is one source
      send_command("flood");
    }
    command_.session = 0;
    if (ms % 20 == 0) send_command("gamepad");
    if (ms % 10 == 9) {
      for (const std::string& source : take_commands()) ++(source == "gamepad" ? gamepad : flood);
    }
  }
  EXPECT_EQ(gamepad, 100) << "every one of a 50 Hz source's";
  EXPECT_LE(flood, 2000 / 4 + 8) << "one a 4 ms, and a burst";
  EXPECT_GE(flood, 2000 / 4 - 8);
  EXPECT_EQ(gate_.counts().flooded, 200'000 - flood);
}

TEST_F(OperatorGateTest, RequestsAreTakenOneIn25MillisecondsWithRoomForFour) {
  pass_ms(1000);
  for (int k = 0; k < 10; ++k) send_mode("gamepad", Modes::STAND);
  EXPECT_EQ(take_requests().size(), 4u);
  pass_ms(1000);
  std::size_t taken = 0;
  for (int ms = 0; ms < 1000; ++ms) {
    pass_ms(1);
    send_mode("gamepad", Modes::STAND);
    taken += take_requests().size();
  }
  EXPECT_GE(taken, 1000u / 25);
  EXPECT_LE(taken, 1000u / 25 + 4);
}

TEST_F(OperatorGateTest, WhatIsPlayedBackCostsItsSenderNothing) {
  std::size_t commands = 0, requests = 0;
  std::vector<std::uint8_t> command, request;
  for (int ms = 0; ms < 2000; ++ms) {
    pass_ms(1);
    if (ms % 20 == 0) {
      ++command_.sequence;
      gate_.take_command(command = sealed(command_));
    }
    if (ms % 50 == 0) {  // repetitions of one request
      ++mode_.stamp_ns;
      gate_.take_mode(request = sealed(mode_));
    }
    gate_.take_command(command);
    gate_.take_mode(request);
    if (ms % 10 == 9) {
      commands += take_commands().size();
      requests += take_requests().size();
    }
  }
  EXPECT_EQ(commands, 100u) << "each of them once";
  EXPECT_EQ(requests, 40u);
  EXPECT_EQ(gate_.counts(), (GateCounts{.out_of_order = 4000}));
}

TEST_F(OperatorGateTest, AStopThatIsPlayedBackStopsAndIsNobodysSecondWish) {
  mode_.mode = Modes::PASSIVE;
  const std::vector<std::uint8_t> recorded = sealed(mode_);
  gate_.take_mode(recorded);
  EXPECT_TRUE(take_requests().at(0).sealed);
  gate_.take_mode(recorded);
  EXPECT_EQ(stop_line_.pulls(), 2u);
  EXPECT_FALSE(take_requests().at(0).sealed);
}

TEST_F(OperatorGateTest, ManyNamesOfOneOperatorTakeNoRoomFromAnother) {
  std::size_t anna = 0, bob = 0;
  for (int ms = 0; ms < 2000; ++ms) {
    pass_ms(1);
    for (int name = 0; name < 8; ++name) send_command("bob." + std::to_string(name));
    if (ms % 20 == 10) send_command("anna.1");
    if (ms % 10 == 9) {
      for (const std::string& source : take_commands()) ++(source == "anna.1" ? anna : bob);
    }
  }
  EXPECT_EQ(anna, 100u) << "although bob came first";
  EXPECT_LE(bob, 2000u / 4 + 8) << "as much as one program";
}

TEST_F(OperatorGateTest, ARequestCarriesItsDigestAndWhatItsSenderHadHeard) {
  pass_ms(70);
  const std::vector<std::uint8_t> stand = sealed(mode_), alone = encoded(mode_);
  pass_ms(30);
  gate_.take_mode(stand);
  const control::ModeRequest request = take_requests().at(0);
  EXPECT_EQ(request.digest, seal::digest_of(alone)) << "of the message, without its seal";
  EXPECT_EQ(request.heard_ns, 70 * kMillisecond_ns);
  mode_.mode = Modes::DAMPING;
  gate_.take_mode(encoded(mode_));
  EXPECT_EQ(take_requests().at(0).digest, seal::digest_of(encoded(mode_))) << "a stranger's stop too";
}

TEST_F(OperatorGateTest, WhoHasNoKeyAnyMoreIsToldSoAtABoundedRate) {
  const seal::Secret secret = seal::random_secret();
  const seal::ControllerSeal keyed(seal::ControllerKeys{.own = seal::random_secret(), .operators = {}});
  OperatorGate gate(inbox_, "z1", clock_, keyed, order_);
  seal::OperatorSeal revoked({{"anna", {}, secret}}, true);
  const seal::Peer peer{.boot = keyed.boot(), .heard_ns = 0, .key = 0};
  mode_.source = "anna.1";
  for (int k = 0; k < 100; ++k) gate.take_mode(revoked.seal("MODE", mode_, &peer));
  const auto refusals = gate.take_refusals();
  ASSERT_EQ(refusals.size(), 4u);
  EXPECT_EQ(refusals[0].verdict, control::Verdict::kNoKey);
  EXPECT_EQ(refusals[0].digest, seal::digest_of(encoded(mode_)));
  EXPECT_TRUE(gate.take_refusals().empty());
  EXPECT_TRUE(take_requests().empty());
  EXPECT_EQ(gate.counts().no_key, 100);
}

TEST_F(OperatorGateTest, MessagesThatADelayBunchedAreAllTaken) {
  pass_ms(1000);
  for (int k = 0; k < 8; ++k) send_command("gamepad");  // 160 ms of a 50 Hz source at once
  EXPECT_EQ(take_commands().size(), 8u);
  EXPECT_EQ(gate_.counts().flooded, 0);
}

TEST_F(OperatorGateTest, InventedNamesCannotCrowdOutWhoIsDrivingNorAStop) {
  std::size_t gamepad = 0;
  int name = 0;
  for (int ms = 0; ms < 2000; ++ms) {
    pass_ms(1);
    if (ms % 20 == 0) send_command("gamepad");
    for (int k = 0; k < 50; ++k) send_command("source " + std::to_string(++name));
    if (ms % 10 == 0) {
      for (const std::string& source : take_commands()) gamepad += source == "gamepad";
    }
  }
  EXPECT_EQ(gamepad, 100u);
  EXPECT_TRUE(take_requests().empty());
  send_mode("pendant", Modes::DAMPING);
  EXPECT_EQ(stop_line_.pulls(), 1u);
  EXPECT_EQ(take_requests().size(), 1u) << "and it will be acknowledged";
}

TEST_F(OperatorGateTest, ASourceThatLeftMakesRoom) {
  for (int k = 0; k < 8; ++k) send_command("source " + std::to_string(k));
  send_command("gamepad");
  EXPECT_EQ(take_commands().size(), 8u);
  pass_ms(501);
  send_command("gamepad");
  EXPECT_EQ(take_commands().size(), 1u);
}

TEST_F(OperatorGateTest, EveryStopOfAFloodStopsAndTheQueueStaysBounded) {
  for (int k = 0; k < 10'000; ++k) send_mode("source " + std::to_string(k % 20), Modes::DAMPING);
  EXPECT_EQ(stop_line_.pulls(), 10'000u);
  EXPECT_LE(take_requests().size(), 32u);
}

TEST_F(OperatorGateTest, AFloodOfRequestsLeavesRoomForAnothersStopToBeAcknowledged) {
  for (int ms = 0; ms < 1000; ++ms) {
    pass_ms(1);
    for (int k = 0; k < 100; ++k) send_mode("flood", k % 2 == 0 ? Modes::STAND : Modes::DAMPING);
    if (ms % 10 == 0) take_requests();
  }
  take_requests();
  send_mode("pendant", Modes::DAMPING);
  const std::vector<control::ModeRequest> requests = take_requests();
  ASSERT_EQ(requests.size(), 1u);
  EXPECT_EQ(requests[0].source, control::Source::make("pendant", 0));
}

TEST_F(OperatorGateTest, AFullQueueIsCountedAndAStopGetsThroughAllTheSame) {
  control::ModeRequest request;
  request.mode = control::Mode::kStand;
  int filled = 0;
  while (inbox_.put(request)) ++filled;
  EXPECT_EQ(filled, 32);
  send_mode("pendant", Modes::DAMPING);
  EXPECT_EQ(stop_line_.pulls(), 1u);
  EXPECT_EQ(gate_.counts().flooded, 1);
}

TEST_F(OperatorGateTest, ArmsArriveAsTheyWereSentAndForeignOnesAreCounted) {
  pass_ms(30);
  arms_.session = 9;
  arms_.sequence = 4;
  arms_.stamp_ns = 77;
  arms_.left_p_m[2] = 0.4;
  arms_.right = pmg_msgs::arms_t::HAND_BACK;
  gate_.take_arms(sealed(arms_));
  control::ArmsMessage arms;
  ASSERT_TRUE(inbox_.take(arms));
  EXPECT_EQ(arms.source, control::Source::make("gamepad", 9));
  EXPECT_EQ(arms.sequence, 4);
  EXPECT_EQ(arms.stamp_ns, 77);
  EXPECT_EQ(arms.received_ns, 30 * kMillisecond_ns);
  EXPECT_EQ(arms.lease_s, 0.3);
  EXPECT_EQ(arms.arm[kLeft].wish, control::ArmWish::kAim);
  EXPECT_EQ(arms.arm[kLeft].palm.p_m.z(), 0.4);
  EXPECT_EQ(arms.arm[kLeft].palm.R.w(), 1.0);
  EXPECT_EQ(arms.arm[kRight].wish, control::ArmWish::kHandBack);
  EXPECT_EQ(gate_.counts(), GateCounts{});

  const auto sent = [&](const std::function<void()>& spoil) {
    const pmg_msgs::arms_t good = arms_;
    spoil();
    gate_.take_arms(sealed(arms_));
    arms_ = good;
  };
  sent([&] { arms_.version = 2; });
  sent([&] { arms_.robot = "z2"; });
  sent([&] { arms_.source = ""; });
  sent([&] { arms_.left = 3; });
  sent([&] { arms_.right = -1; });
  gate_.take_arms(sealed(command_));
  gate_.take_arms(encoded(arms_));
  std::vector<std::uint8_t> recorded = sealed(arms_);
  pass_ms(1001);
  gate_.take_arms(recorded);
  EXPECT_EQ(gate_.counts().other_version, 1);
  EXPECT_EQ(gate_.counts().other_robot, 1);
  EXPECT_EQ(gate_.counts().malformed, 4);
  EXPECT_EQ(gate_.counts().not_fresh, 2) << "without a seal, and more than a second old";
  EXPECT_FALSE(inbox_.take(arms));
}

TEST_F(OperatorGateTest, AFloodOfArmsTakesNoRoomFromCommandsRequestsAndStops) {
  for (int k = 0; k < 5000; ++k) {
    arms_.source = "flood." + std::to_string(k % 7);
    ++arms_.sequence;
    gate_.take_arms(sealed(arms_));
  }
  send_command("gamepad");
  send_mode("gamepad", Modes::STAND);
  send_mode("bystander", Modes::DAMPING);
  EXPECT_EQ(stop_line_.pulls(), 1u);
  EXPECT_EQ(take_commands(), std::vector<std::string>{"gamepad"});
  EXPECT_EQ(take_requests().size(), 2u);
  control::ArmsMessage arms;
  int taken = 0;
  while (inbox_.take(arms)) ++taken;
  EXPECT_EQ(taken, 4) << "one operator's under seven names: four that a delay may have bunched";
  EXPECT_EQ(gate_.counts().flooded, 5000 - 4);
}

TEST_F(OperatorGateTest, RandomBytesEndNothing) {
  std::mt19937 random(20);
  std::uniform_int_distribution<int> byte(0, 255);
  std::uniform_int_distribution<std::size_t> size(0, 300), flips(1, 4);
  const std::vector<std::uint8_t> command = sealed(command_), mode = sealed(mode_), arms = sealed(arms_);
  for (int k = 0; k < 100'000; ++k) {
    std::vector<std::uint8_t> bytes;
    if (k % 3 == 0) {
      bytes.resize(size(random));
      for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(byte(random));
    } else {  // nearly correct: with the type's hash, decoders read on
      bytes = k % 3 == 1 ? command : k % 2 == 0 ? mode : arms;
      std::uniform_int_distribution<std::size_t> position(8, bytes.size() - 1);
      for (std::size_t flip = flips(random); flip > 0; --flip) {
        bytes[position(random)] = static_cast<std::uint8_t>(byte(random));
      }
    }
    gate_.take_command(bytes);
    gate_.take_mode(bytes);
    gate_.take_arms(bytes);
    if (k % 100 == 0) {
      pass_ms(10);
      take_commands();
      take_requests();
    }
  }
  EXPECT_GT(gate_.counts().malformed, 100'000);
}

}  // namespace
}  // namespace pmg::runtime
