// Z1's drives behind emulated bridges: bring-up, exchange, and after how many bus cycles each fault is seen.
#include "ethercat/ethercat_hal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "drive_protocols/mit_drive.hpp"
#include "ethercat/lockstep_cable.hpp"
#include "ethercat/packet_wire.hpp"
#include "generator_core/allocation_count.hpp"

namespace pmg::ethercat {
namespace {

using hal::BusStatus;

class Bridges : public testing::Test, protected test::LockstepCable {
 protected:
  int cycles_until_lost() { return cycles_until(BusStatus::kLost, standing); }
};

TEST_F(Bridges, CommandsArriveAndStatesComeBackWithinAStepOfTheirFields) {
  stand();
  for (const auto& slave : cabled.wire.slaves) EXPECT_EQ(slave->al_status(), 8);
  for (int j = 0; j < truth.q.size(); ++j) {
    EXPECT_NEAR(state.q[j], truth.q[j], 12.6 / 65535 / 2 + 1e-12) << "half a step of 16 bits";
    EXPECT_NEAR(acting.q[j], standing.q[j], 12.6 / 65535);
    EXPECT_NEAR(acting.kp[j], standing.kp[j], 1000.0 / 4095);
  }
  EXPECT_EQ(hal->misses(), 0u);
}

TEST_F(Bridges, NoFrameIsLostInAThousandCycles) {
  stand();
  for (int k = 0; k < 1000; ++k) ASSERT_EQ(cycle(standing), BusStatus::kOk) << k;
  for (std::size_t b = 0; b < cabled.setup.buses.size(); ++b) {
    EXPECT_EQ(hal->can().link(b).counts().not_sent, 0u);
    for (std::size_t m = 0; m < cabled.setup.buses[b].motors.size(); ++m)
      EXPECT_EQ(hal->can().motor(b, m).lost() + hal->can().motor(b, m).uncalled(), 0u);
  }
}

TEST_F(Bridges, ACycleDoesNotAllocate) {
  stand();
  cabled.drives->feel(truth);
  cabled.drives->serve();
  const auto before = test::allocation_count();
  hal->exchange(standing, state);
  EXPECT_EQ(test::allocation_count(), before);
}

TEST_F(Bridges, EachFaultOfTheCableIsLostInItsSecondCycle) {
  const std::vector<std::pair<const char*, std::function<void(test::MemoryWire&)>>> faults = {
      {"cut", [](test::MemoryWire& wire) { wire.cut = true; }},
      {"slave without power", [](test::MemoryWire& wire) { wire.slaves[2]->dead = true; }},
      {"slave reset", [](test::MemoryWire& wire) { wire.slaves[2]->power_up(); }},
      {"working counter short", [](test::MemoryWire& wire) { wire.slaves[2]->takes_nothing = true; }},
      {"no inputs", [](test::MemoryWire& wire) { wire.slaves[2]->gives_nothing = true; }},
      {"safe-operational without an error",
       [](test::MemoryWire& wire) { wire.slaves[2]->join(test::EmulatedSlave::kSafeOperational); }},
      {"operational with an error",
       [](test::MemoryWire& wire) {
         wire.slaves[2]->join(test::EmulatedSlave::kOperational | test::EmulatedSlave::kError);
       }},
      {"a slave too many",
       [](test::MemoryWire& wire) {
         wire.slaves.push_back(std::make_unique<test::EmulatedBridge>(8, 12, test::MemoryLink::pair().first));
         wire.slaves.back()->join(test::EmulatedSlave::kOperational);
       }},
      {"outputs' frames lost",
       [](test::MemoryWire& wire) {
         wire.spoil = [](std::span<std::uint8_t> frame) {
           if (frame[16] == 11) frame[17] ^= 0x80U;
         };
       }},
      {"bytes spoilt",
       [](test::MemoryWire& wire) { wire.spoil = [](std::span<std::uint8_t> frame) { frame[17] ^= 0x80U; }; }}};
  for (const auto& [name, cause] : faults) {
    cabled.wire.slaves.resize(cabled.setup.buses.size());
    for (const auto& slave : cabled.wire.slaves) {
      slave->dead = slave->takes_nothing = slave->gives_nothing = false;
      slave->power_up();
    }
    cabled.wire.cut = false;
    cabled.wire.spoil = nullptr;
    hal.reset();
    stand();
    cause(cabled.wire);
    EXPECT_EQ(cycles_until_lost(), 2) << name;
    EXPECT_THAT(hal->take_news(), testing::HasSubstr("expected all operational")) << name;
  }
}

TEST_F(Bridges, ASilentHostTakesTheSlavesOutOfOperationAndALimpRobotGetsThemBack) {
  stand();
  for (int k = 0; k < 20; ++k) {
    for (const auto& slave : cabled.wire.slaves) slave->tick();
  }
  EXPECT_EQ(cabled.wire.slaves[0]->al_status(), 0x14) << "safe-operational with error";
  EXPECT_EQ(cycles_until_lost(), 2);
  for (int k = 0; k < 200; ++k) cycle(standing);
  EXPECT_EQ(cabled.wire.slaves[0]->al_status(), 0x14) << "never while the robot is stiff";
  model::JointCommand pushing = limp;
  pushing.tau_ff[3] = 1.0;
  for (int k = 0; k < 200; ++k) cycle(pushing);
  EXPECT_EQ(cabled.wire.slaves[0]->al_status(), 0x14) << "nor while it pushes";
  for (int k = 1; k < EthercatHal::kRecoverCycles; ++k) cycle(limp);
  EXPECT_EQ(cabled.wire.slaves[0]->al_status(), 0x14) << "every 0.1 s";
  for (int k = 0; k < 60; ++k) cycle(limp);
  EXPECT_EQ(cabled.wire.slaves[0]->al_status(), 8);
  EXPECT_EQ(cycle(standing), BusStatus::kOk);
}

TEST_F(Bridges, ASlaveThatWantsSeveralOutputsBeforeItIsOperationalGetsThem) {
  cabled.wire.slaves[1]->wanted_outputs = 5;
  stand();
  EXPECT_EQ(cabled.wire.slaves[1]->al_status(), test::EmulatedSlave::kOperational);
}

TEST_F(Bridges, TheSlavesGoBackToInitWhenTheProgramEnds) {
  stand();
  hal.reset();
  for (const auto& slave : cabled.wire.slaves) EXPECT_EQ(slave->al_status(), test::EmulatedSlave::kInit);
}

// Bridges run on while the controller is started anew; what they got for the earlier one waits in them.
TEST_F(Bridges, OldAnswersInABridgeAreNoneToANewController) {
  stand();
  hal.reset();
  for (std::size_t b = 0; b < cabled.setup.buses.size(); ++b) {
    for (int k = 0; k < 20; ++k) {
      for (const drives::MotorSetup& motor : cabled.setup.buses[b].motors) {
        const auto& ranges = drives::as_mit(motor.drive)->ranges();
        const drives::Message old = drives::Message::of(
            ranges.reply_id, drives::MitProtocol(ranges).reply({static_cast<std::uint8_t>(motor.node), {}}));
        cabled.drives->link(b).send(std::span(&old, 1));
      }
    }
  }
  EXPECT_EQ(refusal(), "connected");
  for (int k = 0; k < 5; ++k) cycle(limp);
  EXPECT_EQ(cycle(standing), BusStatus::kOk) << hal->take_news();
}

TEST_F(Bridges, ADriveThatDoesNotAnswerIsNamedBeforeTheFirstCycle) {
  cabled.drives->drive(0, 3).silent = true;
  EXPECT_THAT(refusal(), testing::StartsWith("left_knee (can0, node 4) does not answer"));
}

TEST_F(Bridges, ABridgeWhoseCanIsOffIsALostBus) {
  stand();
  cabled.bridge(1).health = 2;
  EXPECT_EQ(cycles_until_lost(), 1);
}

TEST_F(Bridges, AFrameThatWasGivenUpIsNotTakenForTheAnswer) {
  stand();
  for (int k = 0; k < 20; ++k) {
    cabled.wire.late = 1 + k % 3;
    ASSERT_EQ(cycle(standing), BusStatus::kOk) << k;
  }
  EXPECT_EQ(hal->misses(), 0u);
}

TEST_F(Bridges, AThreadThatWasHeldUpTakesTheAnswerThatCameMeanwhile) {
  stand();
  cabled.wire.held_up = true;
  EXPECT_EQ(cycle(standing), BusStatus::kOk);
  EXPECT_EQ(hal->misses(), 0u);
}

TEST_F(Bridges, WhatIsNotAsInRobotYamlIsRefusedInOneLine) {
  cabled.wire.slaves[1]->lie(10, 0x99);
  cabled.cable.product_code = 0x5678;
  EXPECT_EQ(refusal(), "eth9: slave 2 (Bridge) has product code 0x99; expected 0x5678 as in robot.yaml");
  cabled.wire.slaves[1]->lie(10, 0x5678);
  cabled.cable.frames_in = 11;
  EXPECT_THAT(refusal(),
              testing::HasSubstr("slave 1 (Bridge) takes 108 bytes and gives 160 in a cycle; expected 108 and 147"));
  cabled.cable.frames_in = 12;
  cabled.cable.frames_out = 7;
  EXPECT_THAT(refusal(), testing::HasSubstr("takes 108 bytes and gives 160 in a cycle; expected 95 and 160"));
  cabled.cable.frames_out = 8;
  cabled.cable.vendor_id = 0x99;
  EXPECT_EQ(refusal(), "eth9: slave 1 (Bridge) has vendor 0x1234; expected 0x99 as in robot.yaml");
  cabled.cable.vendor_id = 0;
  std::swap(cabled.wire.slaves[0], cabled.wire.slaves[1]);  // the legs have the same nodes
  EXPECT_EQ(refusal(), "eth9: slave 1 (Bridge) has alias 0x66; expected 0x65 as in robot.yaml");
  std::swap(cabled.wire.slaves[0], cabled.wire.slaves[1]);
  cabled.wire.slaves[3]->refused_state = 8;
  EXPECT_THAT(refusal(),
              testing::AllOf(testing::HasSubstr("slave 4 (Bridge) stays in state 0x14, AL status code 0x0001"),
                             testing::HasSubstr("expected operational")));
  cabled.wire.slaves[3]->refused_state = 0;
  cabled.wire.slaves.push_back(std::make_unique<test::EmulatedBridge>(8, 12, test::MemoryLink::pair().first));
  EXPECT_EQ(refusal(), "eth9: 6 slaves answer; expected 5 as in robot.yaml");
  cabled.wire.slaves.resize(4);
  EXPECT_EQ(refusal(), "eth9: 4 slaves answer; expected 5 as in robot.yaml");
  cabled.wire.slaves.clear();
  EXPECT_EQ(refusal(), "eth9: no EtherCAT slave answers; expected 5");
}

// Seeded; a slave that a lie keeps from a state costs half a second of waiting.
TEST_F(Bridges, AnEepromThatLiesIsRefusedInOneLineOrDoesNoHarm) {
  std::mt19937_64 random(1);
  test::EmulatedSlave& liar = *cabled.wire.slaves[0];  // SOEM takes what it read there for all slaves of its kind
  int refused = 0;
  for (int run = 0; run < 20; ++run) {
    std::vector<std::pair<std::size_t, std::uint16_t>> kept;
    for (auto lies = 1 + random() % 4; lies > 0; --lies) {
      const std::size_t at = random() % std::min<std::size_t>(liar.eeprom_words(), 160);  // beyond: entries alike
      kept.emplace_back(at, liar.eeprom_word(at));
      liar.lie(at, static_cast<std::uint16_t>(random()));
    }
    const std::string said = refusal();
    EXPECT_TRUE(said == "connected" || said.find("; expected ") != std::string::npos) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos);
    refused += said != "connected" ? 1 : 0;
    hal.reset();
    for (auto word = kept.rbegin(); word != kept.rend(); ++word) liar.lie(word->first, word->second);
    liar.power_up();
  }
  EXPECT_GT(refused, 0);
  EXPECT_EQ(refusal(), "connected");
}

TEST(PacketWire, AMissingInterfaceIsNamed) {
  try {
    PacketWire wire("nosuch0");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "nosuch0: no such interface; expected the network card of the EtherCAT slaves");
  }
}

}  // namespace
}  // namespace pmg::ethercat
