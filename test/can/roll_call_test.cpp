// Who answers on a bus whose adapter holds answers back, loses and doubles some: no drive is counted twice, and a
// second drive is found all the same.
#include "can/roll_call.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "../sim/robots.hpp"
#include "can/bus_ids.hpp"
#include "can/emulated_drives.hpp"
#include "can/memory_link.hpp"
#include "can/mixed_drives.hpp"
#include "drive_protocols/canopen.hpp"
#include "drive_protocols/damiao.hpp"
#include "drive_protocols/mit_drive.hpp"

namespace pmg::can {
namespace {

/// One end of a bus behind an adapter: what it receives comes in bunches, one in so many waits.
class BunchingLink final : public Link {
 public:
  explicit BunchingLink(Link& inner) : inner_(inner) {}
  std::size_t send(std::span<const drives::Message> frames) noexcept override {
    sent.insert(sent.end(), frames.begin(), frames.end());
    return inner_.send(frames);
  }
  std::size_t receive(std::span<drives::Message> frames) noexcept override {
    if (!open_) return 0;
    const std::size_t count = inner_.receive(frames);
    for (std::size_t i = 0; i < count; ++i) {
      ++received_;
      if (lost_every != 0 && received_ % lost_every == 0) frames[i] = drives::Message{.id = 0x7FF};
    }
    open_ = count > 0 || period == 0;
    return count;
  }
  void wait() { open_ = period == 0 || ++waits_ % period == 0; }
  BusHealth health() const noexcept override { return state; }
  const LinkCounts& counts() const noexcept override { return inner_.counts(); }

  int period = 0, lost_every = 0;
  BusHealth state = BusHealth::kGood;
  std::vector<drives::Message> sent;

 private:
  Link& inner_;
  int waits_ = 0, received_ = 0;
  bool open_ = true;
};

/// A leg's bus with three CiA 402 drives and one of the MIT protocol.
class RollCall : public testing::Test {
 protected:
  RollCall() {
    std::unique_ptr<test::MemoryLink> there;
    std::tie(here_, there) = test::MemoryLink::pair();
    std::vector<std::unique_ptr<Link>> far;
    far.push_back(std::move(there));
    setup_.buses.resize(1);
    drives_.emplace(setup_, std::move(far));
    link_.emplace(*here_);
  }
  std::vector<std::string> scan() {
    const Wait wait = [this] {
      drives_->answer();
      link_->wait();
    };
    return problems(setup_.buses[0], ask_bus(setup_.buses[0], *link_, wait, {}));
  }

  can::DriveSetup setup_ = test::mixed_drives(z1());
  std::unique_ptr<test::MemoryLink> here_;
  std::optional<test::EmulatedDrives> drives_;
  std::optional<BunchingLink> link_;
};

TEST_F(RollCall, AnswersThatADelayBunchesAreThoseOfOneDrive) {
  for (const int period : {0, 7, 25, 45, 90}) {  // waits of some 1 ms; a request is repeated after 20
    link_->period = period;
    for (int k = 0; k < 3; ++k) EXPECT_THAT(scan(), testing::IsEmpty()) << period;
  }
}

TEST_F(RollCall, TwoDrivesOfOneNodeAreFoundThoughTheirAnswersComeBunched) {
  drives_->drive(0, 1).twice = drives_->drive(0, 3).twice = true;
  for (const int period : {0, 7, 25, 45, 90}) {
    link_->period = period;
    EXPECT_THAT(scan(), testing::ElementsAre(
                            "left_hip_roll (can0a, node 2) answers 2 times; expected one drive of each node number",
                            "left_knee (can0a, node 4) answers 2 times; expected one drive of each node number"))
        << period;
  }
}

TEST_F(RollCall, AnswersOfAProgramThatJustEndedAreNobodysSecond) {
  for (int k = 0; k < 5; ++k) {  // its last commands, answered while the roll is called
    const drives::Message command = drives::Message::of(4, drives::kMitDisable);
    here_->send(std::span(&command, 1));
  }
  EXPECT_THAT(scan(), testing::IsEmpty());
}

TEST_F(RollCall, ALostAndADoubledAnswerChangeNoCount) {
  link_->lost_every = 5;
  for (int k = 0; k < 5; ++k) {
    for (const std::string& problem : scan()) EXPECT_THAT(problem, testing::Not(testing::HasSubstr("times"))) << k;
  }
  link_->lost_every = 0;
  int asked = 0;
  const Wait wait = [&] {
    drives_->drive(0, 3).twice = ++asked == 2;  // one of its answers comes twice
    drives_->answer();
  };
  EXPECT_THAT(problems(setup_.buses[0], ask_bus(setup_.buses[0], *link_, wait, {})), testing::IsEmpty());
}

/// The same bus with drives that robot.yaml doesn't have: MIT nodes 9 and 100, CANopen nodes 33 and 127.
class StrangersRollCall : public testing::Test {
 protected:
  StrangersRollCall() : far_(setup_) {
    far_.buses.resize(1);
    setup_.buses.resize(1);
    std::vector<drives::MotorSetup>& motors = far_.buses[0].motors;
    for (const auto& [like, node] : {std::pair{3, 9}, std::pair{3, 100}, std::pair{0, 33}, std::pair{0, 127}}) {
      motors.push_back(motors[static_cast<std::size_t>(like)]);
      motors.back().node = node;
    }
    std::unique_ptr<test::MemoryLink> there;
    std::tie(here_, there) = test::MemoryLink::pair();
    std::vector<std::unique_ptr<Link>> far;
    far.push_back(std::move(there));
    drives_.emplace(far_, std::move(far));
    link_.emplace(*here_);
  }
  void wait() {
    ++waits_;
    drives_->answer();
    link_->wait();
  }
  Strangers ask() {
    return ask_strangers(
        bus(), *link_, [this] { wait(); }, {}, &others_);
  }
  const can::BusSetup& bus() const { return setup_.buses[0]; }

  can::DriveSetup setup_ = test::mixed_drives(z1()), far_;
  std::unique_ptr<test::MemoryLink> here_;
  std::optional<test::EmulatedDrives> drives_;
  std::optional<BunchingLink> link_;
  OtherFrames others_;
  int waits_ = 0;
};

TEST_F(StrangersRollCall, EveryNodeThatRobotYamlDoesntHaveIsFoundAndNoneIsSwitchedOnOrMoved) {
  for (std::size_t m = 0; m < drives_->motors(0); ++m) drives_->drive(0, m).heard = 0;
  for (const int period : {0, 7, 25}) {
    link_->period = period;
    const Strangers strangers = ask();
    EXPECT_EQ(strangers.why_not, "");
    EXPECT_EQ(strangers.asked, 127 - 4 - 1) << "all but the bus's own motors and 0x7E, with which one of them answers";
    ASSERT_THAT(strangers.answers, testing::SizeIs(2)) << period;
    EXPECT_EQ(strangers.answers[0].node, 9);
    EXPECT_EQ(strangers.answers[1].node, 100);
  }
  EXPECT_LE(waits_, 3 * 300) << "of some 1 ms";
  const std::vector<std::uint32_t> awaited = awaited_ids(bus());
  for (const drives::Message& frame : link_->sent) {
    ASSERT_EQ(frame.length, 8);
    EXPECT_TRUE(std::ranges::equal(frame.bytes(), drives::kMitDisable)) << "switches off";
    EXPECT_EQ(std::ranges::find(awaited, frame.id), awaited.end()) << "somebody else sends 0x" << std::hex << frame.id;
    EXPECT_FALSE(
        std::ranges::any_of(bus().motors, [&](const auto& motor) { return motor.node == static_cast<int>(frame.id); }));
  }
  for (std::size_t m = 0; m < drives_->motors(0); ++m) EXPECT_FALSE(drives_->drive(0, m).enabled());
}

TEST_F(StrangersRollCall, CanopenNodesAreAskedForAnObjectAlone) {
  std::vector<Answer> answers = ask_bus(
      bus(), *link_, [this] { wait(); }, {}, &others_);
  const Strangers strangers = ask();
  answers.insert(answers.end(), strangers.answers.begin(), strangers.answers.end());
  EXPECT_THAT(problems(bus(), answers),
              testing::ElementsAre("can0a: somebody answers as node 33 (CANopen device type 0x00020192: profile 402); "
                                   "expected only the nodes of robot.yaml",
                                   "can0a: somebody answers as node 127 (CANopen device type 0x00020192: profile 402); "
                                   "expected only the nodes of robot.yaml",
                                   "can0a: somebody answers as node 9; expected only the nodes of robot.yaml",
                                   "can0a: somebody answers as node 100; expected only the nodes of robot.yaml"));
  for (const drives::Message& frame : link_->sent) {
    for (const std::uint32_t node : {33U, 127U}) {
      if ((frame.id & drives::canopen::kNodeBits) != node || frame.id == node) continue;
      EXPECT_EQ(frame.id, drives::canopen::kSdoRequest + node);
      EXPECT_EQ(frame.data[0], 0x40) << "reads";
    }
  }
}

TEST_F(StrangersRollCall, WhereAnotherProgramSpeaksNobodyElseIsAsked) {
  const drives::Message command = drives::Message::of(0x42, drives::kMitEnable);
  auto [program, end] = test::MemoryLink::pair();
  // What it sends reaches this computer, too.
  const Strangers strangers = ask_strangers(
      bus(), *end, [&] { program->send(std::span(&command, 1)); }, {}, nullptr);
  EXPECT_EQ(strangers.why_not, "something else sends 0x42 there and may drive them");
  EXPECT_EQ(strangers.asked, 0);
  std::array<drives::Message, 4> got;
  EXPECT_EQ(program->receive(got), 0u) << "nothing was sent";
}

TEST_F(StrangersRollCall, OnABusThatIsntWellAndByProtocolsWithoutAHarmlessMessageNobodyElseIsAsked) {
  link_->state = BusHealth::kPassive;
  EXPECT_EQ(ask().why_not, "the bus isn't well");
  link_->state = BusHealth::kGood;
  EXPECT_EQ(ask().why_not, "");
  EXPECT_THROW(ask_strangers(
                   bus(), *link_, [] {}, [] { return true; }),
               std::runtime_error)
      << "interrupted";
  EXPECT_THAT(link_->sent, testing::Not(testing::IsEmpty()));
}

// A drive that answers with another identifier than robot.yaml's: nobody else may send with it.
TEST_F(StrangersRollCall, AnIdentifierThatWasHeardIsSomebodysOwn) {
  others_.note(drives::Message::of(0x55, drives::kMitDisable));
  EXPECT_EQ(ask().asked, 127 - 4 - 1 - 1);
  EXPECT_TRUE(std::ranges::none_of(link_->sent, [](const drives::Message& frame) { return frame.id == 0x55; }));
}

// A DaMiao's answer has four bits for its node.
TEST(StrangersRange, OnlyNodesThatADialectCanHaveAreAsked) {
  can::BusSetup bus = can::load_drives(z1()).buses[0];
  for (drives::MotorSetup& motor : bus.motors)
    motor.drive = std::make_shared<drives::DamiaoDrive>(drives::as_mit(motor.drive)->ranges());
  auto [here, there] = test::MemoryLink::pair();
  EXPECT_EQ(ask_strangers(bus, *here, [] {}, {}).asked, 15 - static_cast<int>(bus.motors.size()));
}

}  // namespace
}  // namespace pmg::can
