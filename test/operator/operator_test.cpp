// An operator's requests to a controller, over the network and back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "hal/hoist_line.hpp"
#include "networked_robot.hpp"
#include "operator/drive.hpp"
#include "operator/mode_wish.hpp"
#include "operator/robot_board.hpp"
#include "operator/words.hpp"
#include "pmg_msgs/link_t.hpp"

namespace pmg::ops {
namespace {

using control::Mode;
using test::Network;
using test::NetworkedRobot;
using testing::HasSubstr;

class OperatorTest : public testing::Test {
 protected:
  OperatorTest() {
    network_.link.subscribe("MODE", [this](io::Bytes) { ++requests_sent_; });
    network_.link.subscribe("COMMAND", [this](io::Bytes bytes) {
      if (const auto command = seal::decode_sealed<pmg_msgs::command_t, pmg_msgs::seal_t>(bytes))
        speeds_sent_m_s_.push_back(command->message.vx_m_s);
    });
    for (int k = 0; k < 3; ++k) network_.advance();
  }
  Progress ask(Goal goal, const std::string& robot = "biped") {
    ModeWish wish(mine_, robot, goal, 10.0);
    const Progress progress = network_.finish(wish);
    answers_ = wish.answers();
    elapsed_s_ = wish.elapsed_s();
    return progress;
  }
  static Command forward(double vx_m_s) { return Command{{vx_m_s}}; }
  /// Another source makes the robot walk and goes on driving it.
  std::unique_ptr<Drive> other_drives() {
    auto drive = std::make_unique<Drive>(other_, "biped", forward(0.3), DriveOptions{.duration_s = 100, .climb = true});
    while (!drive->driving()) step(*drive);
    for (int k = 0; k < 100; ++k) step(*drive);
    EXPECT_EQ(robot_.result().mode, Mode::kWalk);
    return drive;
  }
  Progress step(Drive& drive) {
    network_.advance();
    return drive.step();
  }

  Network network_;
  NetworkedRobot& robot_ = network_.add_robot("biped");
  OperatorSource mine_{network_.link, "pmg_send.1", 1, network_.clock};
  OperatorSource other_{network_.link, "gamepad", 1, network_.clock};
  int requests_sent_ = 0;
  std::vector<double> speeds_sent_m_s_;
  std::vector<Answer> answers_;
  double elapsed_s_ = 0.0;
};

TEST_F(OperatorTest, StandIsReachedAndSaid) {
  EXPECT_EQ(ask(Goal::kStand), Progress::kReached);
  EXPECT_EQ(robot_.result().mode, Mode::kStand);
  ASSERT_EQ(answers_.size(), 1u);
  EXPECT_TRUE(answers_[0].acknowledged);
  EXPECT_EQ(answers_[0].mode, "stand");
}

TEST_F(OperatorTest, AStopReachesARobotThatSomebodyElseDrives) {
  const auto drive = other_drives();
  ModeWish stop(mine_, "", Goal::kStop, 2.0);
  Progress progress = Progress::kPending;
  while (progress == Progress::kPending) {
    step(*drive);
    progress = stop.step();
  }
  EXPECT_EQ(progress, Progress::kReached);
  EXPECT_LE(stop.elapsed_s(), 0.2 + 0.02) << "as long as it listens for other robots";
  EXPECT_EQ(robot_.result().mode, Mode::kDamping);
  EXPECT_EQ(robot_.bus.last_command.kp.sum(), 0.0);
}

TEST_F(OperatorTest, TheBusBrakesBeforeAnyTickHeardOfTheStop) {
  const auto drive = other_drives();
  network_.control_alive = false;
  const ModeWish stop(mine_, "biped", Goal::kStop, 2.0);
  network_.advance();
  EXPECT_EQ(robot_.bus.last_command.kp.sum(), 0.0);
}

TEST_F(OperatorTest, AStopWithoutANameStopsEveryRobot) {
  NetworkedRobot& second = network_.add_robot("second");
  network_.advance();
  EXPECT_EQ(ask(Goal::kStand, "biped"), Progress::kReached);
  EXPECT_EQ(ask(Goal::kStand, "second"), Progress::kReached);
  EXPECT_EQ(ask(Goal::kStop, ""), Progress::kReached);
  EXPECT_EQ(answers_.size(), 2u);
  EXPECT_EQ(robot_.result().mode, Mode::kDamping);
  EXPECT_EQ(second.result().mode, Mode::kDamping);
}

TEST_F(OperatorTest, ARequestIsRepeatedUntilAnsweredAndNotAfter) {
  network_.control_alive = false;
  ModeWish wish(mine_, "biped", Goal::kDamping, 10.0);
  for (int k = 0; k < 50; ++k) {
    network_.advance();
    EXPECT_EQ(wish.step(), Progress::kPending);
  }
  EXPECT_GE(requests_sent_, 9) << "every 50 ms";
  EXPECT_LE(requests_sent_, 11);
  network_.control_alive = true;
  EXPECT_EQ(network_.finish(wish), Progress::kReached);
  const int sent = requests_sent_;
  for (int k = 0; k < 20; ++k) {
    network_.advance();
    wish.step();
  }
  EXPECT_EQ(requests_sent_, sent);
}

TEST_F(OperatorTest, AControllerThatNeverAnswersIsSaidInTime) {
  network_.control_alive = false;
  EXPECT_EQ(ask(Goal::kDamping), Progress::kFailed);
  EXPECT_NEAR(elapsed_s_, 10.0, 0.02);
  EXPECT_EQ(answers_[0].text, "not acknowledged");
  EXPECT_EQ(ask(Goal::kDamping, "nobody"), Progress::kFailed);
  EXPECT_THAT(answers_[0].text, HasSubstr("no controller of this name answers on memq://; heard: "))
      << "one of those may be meant";
}

TEST_F(OperatorTest, ARepeatedWishForLimpDrivesIsStillOneWish) {
  EXPECT_EQ(ask(Goal::kStand), Progress::kReached);
  robot_.acks_lost = true;
  ModeWish wish(mine_, "biped", Goal::kPassive, 10.0);
  for (int k = 0; k < 20; ++k) {
    network_.advance();
    wish.step();
  }
  EXPECT_GE(requests_sent_, 4);
  robot_.acks_lost = false;
  EXPECT_EQ(network_.finish(wish), Progress::kFailed);
  EXPECT_EQ(robot_.result().mode, Mode::kDamping);
  EXPECT_THAT(wish.answers()[0].text, HasSubstr("told twice"));
  EXPECT_EQ(ask(Goal::kPassive), Progress::kReached) << "told again";
}

TEST_F(OperatorTest, OthersMayNotTakeOverWhileSomebodyDrives) {
  const auto drive = other_drives();
  ModeWish wish(mine_, "biped", Goal::kStand, 2.0);
  Progress progress = Progress::kPending;
  while (progress == Progress::kPending) {
    step(*drive);
    progress = wish.step();
  }
  EXPECT_EQ(progress, Progress::kFailed);
  EXPECT_THAT(wish.answers()[0].text, HasSubstr("another source drives: gamepad"));
  EXPECT_EQ(robot_.result().mode, Mode::kWalk);

  Drive second(mine_, "biped", forward(-0.3), {.duration_s = 1.0});
  progress = Progress::kPending;
  while (progress == Progress::kPending) {
    step(*drive);
    progress = second.step();
  }
  EXPECT_EQ(progress, Progress::kFailed);
  EXPECT_EQ(second.text(), "another source drives: gamepad");
}

TEST_F(OperatorTest, AfterAnothersCrashAWalkWaitsForTheEndOfItsLeaseAndSaysSo) {
  other_drives();  // and stops without releasing: no one calls its step() any more
  Drive drive(mine_, "biped", forward(-0.2), {.duration_s = 1.0, .climb = true});
  std::string waited_for;
  Progress progress = Progress::kPending;
  while (progress == Progress::kPending) {
    progress = step(drive);
    if (waited_for.empty()) waited_for = drive.waits_for();
  }
  EXPECT_EQ(progress, Progress::kReached) << drive.text();
  EXPECT_EQ(waited_for, "gamepad");
  EXPECT_NEAR(drive.driven_s(), 1.0, 0.011);
}

TEST_F(OperatorTest, AfterAnothersCrashACommandWaitsForTheEndOfItsLeaseAndSaysSo) {
  other_drives();
  Drive drive(mine_, "biped", forward(-0.2), {.duration_s = 0.2});
  std::string waited_for;
  while (drive.step() == Progress::kPending && !drive.driving()) {
    network_.advance();
    if (waited_for.empty()) waited_for = drive.waits_for();
  }
  EXPECT_TRUE(drive.driving()) << drive.text();
  EXPECT_EQ(waited_for, "gamepad");
  EXPECT_STREQ(robot_.result().driving.name.data(), "pmg_send.1");
}

TEST_F(OperatorTest, AModeIsReachedAfterAnothersCrash) {
  other_drives();
  EXPECT_EQ(ask(Goal::kStand), Progress::kReached);
  EXPECT_EQ(robot_.result().mode, Mode::kStand);
  EXPECT_LT(elapsed_s_, 2.0) << "a lease of half a second, and the way down";
}

TEST_F(OperatorTest, WhoeverStopsTheRobotDuringThatWaitKeepsItStopped) {
  auto crashed = other_drives();
  crashed.reset();
  Drive mine(mine_, "biped", forward(0.2), DriveOptions{.duration_s = 1, .climb = true});
  Progress progress = Progress::kPending;
  while (mine.waits_for().empty()) progress = step(mine);
  ASSERT_EQ(progress, Progress::kPending);
  OperatorSource passer_by(network_.link, "passer_by", 1, network_.clock);
  const ModeWish stop(passer_by, "biped", Goal::kStop, 2.0);
  for (int k = 0; k < 300; ++k) {
    progress = step(mine);
    if (k > 10) {
      EXPECT_EQ(robot_.result().mode, Mode::kDamping);
    }
  }
  EXPECT_EQ(progress, Progress::kFailed);
}

TEST_F(OperatorTest, TheWaitForALeaseIsBounded) {
  // A source that sends every 0.4 s keeps its lease, but looks like one that has crashed.
  const auto crashed = other_drives();
  ModeWish wish(mine_, "biped", Goal::kStand, 1.0);
  Progress progress = Progress::kPending;
  for (int k = 0; progress == Progress::kPending && k < 500; ++k) {
    if (k % 40 == 0) other_.send_command("biped", forward(0.3), 0.5);
    network_.advance();
    progress = wish.step();
  }
  EXPECT_EQ(progress, Progress::kFailed);
  EXPECT_LE(wish.elapsed_s(), 1.02);
  EXPECT_THAT(wish.answers()[0].text, HasSubstr("another source drives: gamepad"));
}

TEST_F(OperatorTest, AWalkClimbsDrivesComesToRestAndStands) {
  Drive drive(mine_, "biped", forward(0.3), {.duration_s = 2.0, .climb = true});
  double fastest = 0.0;
  Progress progress = Progress::kPending;
  while (progress == Progress::kPending) {
    progress = step(drive);
    fastest = std::max(fastest, robot_.result().reference.command[kVx]);
  }
  EXPECT_EQ(progress, Progress::kReached) << drive.text();
  EXPECT_NEAR(drive.driven_s(), 2.0, 0.011);
  EXPECT_NEAR(fastest, 0.3, 1e-6);
  EXPECT_EQ(speeds_sent_m_s_.front(), 0.0) << "it climbs at rest";
  EXPECT_NEAR(static_cast<double>(std::ranges::count(speeds_sent_m_s_, 0.3)), 100.0, 2.0) << "50 Hz";
  EXPECT_THAT(std::vector(speeds_sent_m_s_.end() - 25, speeds_sent_m_s_.end()), testing::Each(0.0)) << "and calms";
  EXPECT_EQ(robot_.result().mode, Mode::kStand);
  EXPECT_EQ(robot_.result().reference.command[kVx], 0.0);
  EXPECT_EQ(robot_.result().driving, control::Source{}) << "whoever comes next need not wait for its lease";
}

TEST_F(OperatorTest, ASlowSimulationsHoistIsWaitedForAsLongAsItSaysThatItWorks) {
  hal::HoistLine hoist;
  robot_.comms.work(&hoist);
  hoist.show(hal::CraneState::kLowering);
  const DriveOptions options{.duration_s = 0.5, .climb = true, .timeout_s = 1.0};
  Drive drive(mine_, "biped", forward(0.3), options);
  EXPECT_EQ(network_.finish(drive, 4.5), Progress::kPending) << drive.text();
  hoist.show(hal::CraneState::kFree);
  EXPECT_EQ(network_.finish(drive), Progress::kReached) << drive.last_words();
  hoist.show(hal::CraneState::kLettingGo);
  Drive stuck(mine_, "biped", forward(0.3), options);
  EXPECT_EQ(network_.finish(stuck, 10.0), Progress::kFailed);
  EXPECT_THAT(stuck.last_words(), HasSubstr("the hoist lets go of the robot and doesn't end"));
}

TEST_F(OperatorTest, ASimulatedControllerMayBeSilentForTwoSecondsARealOneForHalfASecond) {
  for (const auto& [backend, allowed_s] : {std::pair{"can", 0.5}, std::pair{"sil", 2.0}}) {
    Drive drive(mine_, "biped", forward(0.3), {.duration_s = 100.0, .climb = true});
    RobotNews news;
    news.info.emplace();
    news.info->backend = backend;
    const auto go = [&] {
      network_.advance();
      return drive.step(&news);
    };
    while (!drive.driving()) ASSERT_EQ(go(), Progress::kPending) << drive.text();
    network_.comms_alive = false;
    double silent_s = 0.0;
    for (; silent_s < 5.0 && go() == Progress::kPending; silent_s += 0.01) {
    }
    EXPECT_NEAR(silent_s, allowed_s, 0.05) << backend;
    EXPECT_EQ(drive.text(), "the controller is no longer heard");
    network_.comms_alive = true;
    for (int k = 0; k < 200; ++k) network_.advance();
  }
}

TEST_F(OperatorTest, ANewSourcesFirstCommandGoesBeforeItsRequestForWalk) {
  std::vector<std::string> sent;
  const auto note = [&sent](const char* channel) {
    return [&sent, channel](io::Bytes) { sent.emplace_back(channel); };
  };
  network_.link.subscribe("COMMAND", note("COMMAND"));
  network_.link.subscribe("MODE", note("MODE"));
  std::int64_t refused = -1;
  network_.link.subscribe(
      "LINK", [&refused](io::Bytes bytes) { refused = io::decode_message<pmg_msgs::link_t>(bytes)->not_fresh; });
  OperatorSource late(network_.link, "pmg_send.9", 1, network_.clock);  // has heard nothing yet
  Drive drive(late, "biped", forward(0.3), {.duration_s = 0.5, .climb = true});
  for (int k = 0; k < 1000 && !drive.driving(); ++k) step(drive);
  EXPECT_TRUE(drive.driving()) << drive.text();
  ASSERT_GE(sent.size(), 2u);
  EXPECT_EQ(sent.front(), "COMMAND");
  for (int k = 0; k < 200; ++k) step(drive);  // the counts come every second
  EXPECT_EQ(refused, 0) << "none is sent that can't be fresh";
}

TEST_F(OperatorTest, AnInterruptedWalkComesToRestToo) {
  Drive drive(mine_, "biped", forward(0.3), {.duration_s = 100.0, .climb = true});
  while (drive.driven_s() < 1.0) step(drive);
  drive.end_early();
  EXPECT_EQ(network_.finish(drive), Progress::kReached);
  EXPECT_EQ(robot_.result().mode, Mode::kStand);
  EXPECT_NEAR(drive.driven_s(), 1.0, 0.03);
}

TEST_F(OperatorTest, AWalkThatSomebodyStoppedIsNotBegunAgain) {
  Drive drive(mine_, "biped", forward(0.3), {.duration_s = 100.0, .climb = true});
  while (drive.driven_s() < 1.0) step(drive);
  const ModeWish stop(other_, "biped", Goal::kStop, 2.0);
  Progress progress = Progress::kPending;
  while (progress == Progress::kPending) progress = step(drive);
  EXPECT_EQ(progress, Progress::kFailed);
  EXPECT_EQ(drive.text(), "somebody stopped it, mode is damping: pmg_send stand makes it stand up");
  for (int k = 0; k < 100; ++k) {
    step(drive);
    ASSERT_EQ(robot_.result().mode, Mode::kDamping);
  }
}

TEST_F(OperatorTest, DrivingARobotThatDoesNotWalkIsRefusedInWords) {
  EXPECT_EQ(ask(Goal::kStand), Progress::kReached);
  Drive drive(mine_, "biped", forward(0.3), {.duration_s = 100.0});
  EXPECT_EQ(network_.finish(drive), Progress::kFailed);
  EXPECT_EQ(drive.text(), "mode is stand: commands move a robot in walk only");
}

TEST_F(OperatorTest, AControllerThatFallsSilentEndsTheDrive) {
  Drive drive(mine_, "biped", forward(0.3), {.duration_s = 100.0, .climb = true});
  while (drive.driven_s() < 1.0) step(drive);
  network_.control_alive = false;
  EXPECT_EQ(network_.finish(drive, 1.0), Progress::kFailed);
  EXPECT_EQ(drive.text(), "the controller is no longer heard");
}

TEST_F(OperatorTest, AFaultIsSaidInItsOwnWordsUntilItIsReset) {
  EXPECT_EQ(ask(Goal::kStand), Progress::kReached);
  while (robot_.result().maker == control::TargetMaker::kReferenceUnjudged)
    network_.advance();  // its feet are not judged within one tick
  robot_.policy->how = test::BreakablePolicy::Break::kNotANumber;
  for (int k = 0; k < 3; ++k) network_.advance();
  ASSERT_EQ(robot_.result().mode, Mode::kFault);
  EXPECT_EQ(ask(Goal::kStand), Progress::kFailed);
  EXPECT_THAT(answers_[0].text, HasSubstr("policy"));
  EXPECT_THAT(answers_[0].text, HasSubstr("ask for a reset"));
  EXPECT_EQ(ask(Goal::kStop), Progress::kReached) << "a fault brakes already";
  robot_.policy->how = test::BreakablePolicy::Break::kNone;
  EXPECT_EQ(ask(Goal::kReset), Progress::kReached);
  EXPECT_EQ(robot_.result().mode, Mode::kDamping);
}

/// A hundred thousand messages a second: comms receives a hundred every millisecond or two.
class FloodTest : public OperatorTest {
 protected:
  template <typename Errand>
  Progress finish_in_flood(Errand& errand) {
    Progress progress = Progress::kPending;
    while (progress == Progress::kPending) {
      for (int part = 0; part < 10; ++part) {
        for (int k = 0; k < 100; ++k) (k % 2 == 0 ? send_junk() : send_command());
        robot_.comms.step(0);
      }
      network_.advance();
      progress = errand.step();
    }
    return progress;
  }
  void send_junk() {
    ++sent_;
    network_.link.send(sent_ % 4 == 0 ? "MODE" : "COMMAND", junk_);
  }
  void send_command() {
    pmg_msgs::command_t command{};
    command.version = pmg_msgs::command_t::VERSION;
    command.robot = "biped";
    command.source = "flood" + std::to_string(++sent_ % 3);
    command.sequence = sent_;
    command.lease_s = 2.0;
    command.vx_m_s = -1.0;
    network_.link.send("COMMAND", seal_.seal("COMMAND", command, &*mine_.heard("biped")->peer));
  }

  seal::OperatorSeal seal_;
  const std::vector<std::uint8_t> junk_ = std::vector<std::uint8_t>(200, 0x5a);
  int sent_ = 0;
};

TEST_F(FloodTest, WhoDrivesGoesOnDriving) {
  Drive drive(mine_, "biped", forward(0.3), {.duration_s = 3.0, .climb = true});
  while (!drive.driving()) step(drive);
  EXPECT_EQ(finish_in_flood(drive), Progress::kReached) << drive.text();
  EXPECT_NEAR(drive.driven_s(), 3.0, 0.02);
  EXPECT_EQ(robot_.result().mode, Mode::kStand);
  EXPECT_GT(robot_.comms.gate_counts().malformed, 100'000);
  EXPECT_GT(robot_.comms.gate_counts().flooded, 100'000);
}

TEST_F(FloodTest, AStopIsObeyedAndAcknowledged) {
  EXPECT_EQ(ask(Goal::kStand), Progress::kReached);
  ModeWish stop(mine_, "biped", Goal::kStop, 2.0);
  EXPECT_EQ(finish_in_flood(stop), Progress::kReached);
  EXPECT_LE(stop.elapsed_s(), 0.021);
  EXPECT_EQ(robot_.result().mode, Mode::kDamping);
}

TEST_F(OperatorTest, AStopForEveryRobotIsAcknowledgedBesideAFloodOfStrangersStops) {
  NetworkedRobot& second = network_.add_robot("second");
  network_.advance();
  pmg_msgs::mode_t strangers{};
  strangers.version = pmg_msgs::mode_t::VERSION;
  strangers.source = "stranger";
  strangers.mode = pmg_msgs::mode_t::DAMPING;
  const auto flood = [&] {
    for (int k = 0; k < 10; ++k) network_.link.publish("MODE", strangers);  // 1,000 a second
    network_.advance();
  };
  for (int k = 0; k < 100; ++k) flood();
  ModeWish stop(mine_, "", Goal::kStop, 2.0);
  Progress progress = Progress::kPending;
  while (progress == Progress::kPending) {
    flood();
    progress = stop.step();
  }
  EXPECT_EQ(progress, Progress::kReached);
  EXPECT_EQ(stop.answers().size(), 2u);
  EXPECT_LE(stop.elapsed_s(), 0.22) << "as long as it listens for other robots";
  EXPECT_EQ(second.result().mode, Mode::kDamping);
}

/// A robot with keys, and an operator that has one of them.
class KeyedTest : public testing::Test {
 protected:
  KeyedTest() {
    for (int k = 0; k < 3; ++k) network_.advance();
  }
  /// Answers every request as the controller might.
  void forge_acks() {
    network_.link.subscribe("MODE", [this](io::Bytes bytes) {
      const auto request = seal::decode_sealed<pmg_msgs::mode_t, pmg_msgs::seal_t>(bytes);
      pmg_msgs::ack_t ack{};
      ack.robot = "biped";
      ack.stamp_ns = network_.clock.now_ns() + 1;
      ack.source = request.value().message.source;
      ack.session = request->message.session;
      ack.sequence = request->message.sequence;
      ack.mode = pmg_msgs::mode_t::DAMPING;
      network_.link.publish("ACK", ack);
    });
  }

  Network network_;
  seal::Secret secret_ = seal::random_secret();
  seal::ControllerKeys keys_{.own = seal::random_secret(), .operators = {{"anna", secret_}}};
  NetworkedRobot& robot_ = network_.add_robot("biped", keys_);
  seal::OperatorKey key_{"anna", seal::Signer(keys_.own).public_key(), secret_};
  OperatorSource anna_{network_.link, "anna.1", 1, network_.clock, seal::OperatorSeal({key_}, false)};
  OperatorSource stranger_{network_.link, "stranger.1", 1, network_.clock};
};

TEST_F(KeyedTest, WhoHasAKeyDrivesAndWhoHasNoneStopsOnly) {
  ModeWish stand(anna_, "biped", Goal::kStand, 10.0);
  EXPECT_EQ(network_.finish(stand), Progress::kReached);
  ModeWish walk(stranger_, "biped", Goal::kWalk, 1.0);
  EXPECT_EQ(network_.finish(walk), Progress::kFailed);
  EXPECT_EQ(walk.answers().front().text, kNoKey);
  ModeWish stop(stranger_, "biped", Goal::kStop, 2.0);
  EXPECT_EQ(network_.finish(stop), Progress::kReached);
  EXPECT_EQ(robot_.result().mode, Mode::kDamping);
}

TEST_F(KeyedTest, NobodyDrivesUnderAnothersName) {
  OperatorSource as_bob(network_.link, "bob.1", 1, network_.clock, seal::OperatorSeal({key_}, false));
  for (int k = 0; k < 3; ++k) network_.advance();
  ModeWish stand(as_bob, "biped", Goal::kStand, 1.0);
  EXPECT_EQ(network_.finish(stand), Progress::kFailed);
  const auto command = [&](OperatorSource& source) {
    for (int k = 0; k < 5; ++k) {
      source.send_command("biped", Command{}, 0.5);
      network_.advance();
    }
    return std::string(robot_.result().driving.name.data());
  };
  EXPECT_EQ(command(as_bob), "") << "a key of anna, and bob's name";
  EXPECT_EQ(command(anna_), "anna.1");
  ModeWish stop(as_bob, "biped", Goal::kStop, 2.0);
  EXPECT_EQ(network_.finish(stop), Progress::kReached) << "a stop is everybody's";
}

TEST_F(KeyedTest, WhoseKeyWasRevokedIsToldSo) {
  OperatorSource former(network_.link, "bob.1", 1, network_.clock,
                        seal::OperatorSeal({{"bob", key_.controller, seal::random_secret()}}, false));
  for (int k = 0; k < 3; ++k) network_.advance();
  ModeWish stand(former, "biped", Goal::kStand, 5.0);
  EXPECT_EQ(network_.finish(stand), Progress::kFailed);
  EXPECT_EQ(stand.answers().front().text, kNoKey);
  EXPECT_LT(stand.elapsed_s(), 0.1) << "at once";
}

TEST_F(KeyedTest, AForgedAcknowledgementOfAStopIsNotBelieved) {
  network_.control_alive = false;
  forge_acks();
  ModeWish stop(anna_, "biped", Goal::kStop, 2.0);
  EXPECT_EQ(network_.finish(stop), Progress::kFailed);
  EXPECT_FALSE(stop.answers().front().acknowledged);
}

TEST_F(KeyedTest, AForgedStatusNeitherShowsAModeNorMisleadsASeal) {
  pmg_msgs::status_t status{};
  status.robot = "biped";
  status.session = 99;
  status.stamp_ns = network_.clock.now_ns() + 1'000'000'000;
  status.mode = pmg_msgs::mode_t::WALK;
  network_.link.publish("STATUS", status);
  network_.link.receive(0);
  EXPECT_EQ(anna_.heard("biped")->mode(), pmg_msgs::mode_t::PASSIVE);
  ModeWish stand(anna_, "biped", Goal::kStand, 10.0);
  EXPECT_EQ(network_.finish(stand), Progress::kReached);
}

/// What the controller says while it is recorded.
class RecordedTest : public OperatorTest {
 protected:
  RecordedTest() {
    network_.link.subscribe("STATUS", [this](io::Bytes bytes) {
      if (records_) statuses_.emplace_back(bytes.begin(), bytes.end());
    });
  }
  void say(std::int64_t session, std::int8_t mode, std::int64_t stamp_ns) {
    pmg_msgs::status_t status{};
    status.robot = "biped";
    status.session = session;
    status.stamp_ns = stamp_ns;
    status.mode = mode;
    network_.link.publish("STATUS", status);
    network_.link.receive(0);
  }

  bool records_ = false;
  std::vector<std::vector<std::uint8_t>> statuses_;
};

TEST_F(RecordedTest, AStatusOfAnotherStartIsIgnoredWhileTheControllerSpeaks) {
  const auto mode = [&] { return mine_.heard("biped")->mode(); };
  for (const std::int64_t session : {0, 2}) {  // a clock that was set back makes no difference
    say(session, pmg_msgs::mode_t::WALK, 1'000'000);
    EXPECT_EQ(mode(), pmg_msgs::mode_t::PASSIVE);
  }
  network_.control_alive = false;
  for (int k = 0; k < 31; ++k) network_.advance();
  say(0, pmg_msgs::mode_t::DAMPING, 2'000'000);
  EXPECT_EQ(mode(), pmg_msgs::mode_t::DAMPING) << "started anew";
}

TEST_F(RecordedTest, NoRecordingDrivesADeadRobot) {
  Drive drive(mine_, "biped", forward(0.3), {.duration_s = 100.0, .climb = true});
  while (!drive.driving()) step(drive);
  records_ = true;
  for (int k = 0; k < 300; ++k) step(drive);
  records_ = false;
  network_.control_alive = false;
  for (int k = 0; k < 100; ++k) network_.advance();
  for (const bool whole : {false, true}) {
    // As in a container: the same process number, so the same name, as that of the recorded driver.
    OperatorSource again(network_.link, mine_.name(), mine_.session() + 1, network_.clock);
    Drive dead(again, "biped", forward(0.3), {.duration_s = 1.0, .timeout_s = 2.0});
    Progress progress = Progress::kPending;
    for (std::size_t k = 0; progress == Progress::kPending && k < 1000; ++k) {
      network_.link.send("STATUS", statuses_.at(whole ? k % statuses_.size() : 0));
      network_.advance();
      progress = dead.step();
    }
    EXPECT_EQ(progress, Progress::kFailed);
    EXPECT_EQ(dead.driven_s(), 0.0);
  }
}

TEST_F(KeyedTest, AnAcknowledgementIsOfTheVeryRequestOrOfNone) {
  OperatorSource lender(network_.link, anna_.name(), anna_.session(), network_.clock);
  network_.advance();
  lender.request("biped", pmg_msgs::mode_t::DAMPING,
                 false);  // a stop with the source, session and number of what follows
  network_.link.receive(0);
  robot_.control();
  robot_.comms.step(0);
  ASSERT_FALSE(lender.heard("biped")->ack);
  anna_.request("biped", pmg_msgs::mode_t::STAND, false);
  network_.link.receive(0);
  ASSERT_TRUE(lender.heard("biped")->ack);
  EXPECT_EQ(lender.heard("biped")->ack->verdict, pmg_msgs::ack_t::TAKEN);
  EXPECT_FALSE(anna_.heard("biped")->ack) << "the stop was taken, not this request";
}

}  // namespace
}  // namespace pmg::ops
