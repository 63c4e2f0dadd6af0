// What first light says of drives that answer otherwise than robot.yaml has it.
#include "can/other_frames.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "../sim/robots.hpp"
#include "can/memory_link.hpp"
#include "can/roll_call.hpp"
#include "drive_protocols/mit_drive.hpp"

namespace pmg::can {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Z1's left leg, whose drives answer as `answer` says; what the roll call hears besides.
class OtherDialects : public testing::Test {
 protected:
  std::vector<std::string> heard(
      const std::function<std::optional<drives::Message>(int node, const drives::Message& right)>& answer) {
    auto [here, there] = test::MemoryLink::pair();
    const Wait wait = [&] {
      std::array<drives::Message, 64> frames;
      const std::size_t count = there->receive(frames);
      for (const drives::Message& asked : std::span(frames).first(count)) {
        const auto motor = std::ranges::find(bus_.motors, static_cast<int>(asked.id), &drives::MotorSetup::node);
        const drives::MitProtocol protocol(drives::as_mit(motor->drive)->ranges());
        const drives::Message right = drives::Message::of(
            0, protocol.reply({.node = static_cast<std::uint8_t>(asked.id), .reading = {.temperature_degC = 31.0}}));
        if (const auto frame = answer(static_cast<int>(asked.id), right)) there->send(std::span(&*frame, 1));
      }
    };
    OtherFrames others;
    problems_ = problems(bus_, ask_bus(bus_, *here, wait, {}, &others));
    return others.lines(bus_);
  }

  can::BusSetup bus_ = can::load_drives(z1()).buses[0];
  std::vector<std::string> problems_;
};

TEST_F(OtherDialects, DrivesAsRobotYamlHasThemAreNoNews) {
  EXPECT_THAT(heard([](int, const drives::Message& right) { return right; }), IsEmpty());
  EXPECT_THAT(problems_, IsEmpty());
}

TEST_F(OtherDialects, AMiniCheetahsShortAnswersAreNamed) {
  for (const int bytes : {6, 7}) {
    const auto lines = heard([bytes](int node, drives::Message right) -> std::optional<drives::Message> {
      if (node == 4) right.length = static_cast<std::uint8_t>(bytes);
      return right;
    });
    EXPECT_THAT(lines, ElementsAre(testing::AllOf(
                           HasSubstr("can0: heard identifier 0x0 with " + std::to_string(bytes) + " bytes, "),
                           HasSubstr("a Mini Cheetah's answer of left_knee"))));
    EXPECT_THAT(problems_, ElementsAre(HasSubstr("left_knee (can0, node 4) does not answer")));
  }
}

TEST_F(OtherDialects, ADaMiaoIsNamedByItsTemperatureAndByItsState) {
  EXPECT_THAT(heard([](int node, drives::Message right) -> std::optional<drives::Message> {
                if (node == 4) right.data[7] = 29;  // rotor's temperature; switched off: state 0
                return right;
              }),
              ElementsAre(HasSubstr(
                  "a DaMiao's answer of left_knee, or a RobStride's: 29 would be no fault code, but a temperature; "
                  "robot.yaml has `protocol: mit`: expected `protocol: damiao` or `protocol: robstride`")));
  EXPECT_THAT(problems_, ElementsAre(HasSubstr("reports a fault that the protocol doesn't name")));
  EXPECT_THAT(heard([](int node, drives::Message right) -> std::optional<drives::Message> {
                if (node == 4) right.data[0] = 0x84;  // over-voltage
                return right;
              }),
              ElementsAre(HasSubstr("a DaMiao's answer of left_knee, whose first byte has a state")));
}

TEST_F(OtherDialects, AnotherReplyIdentifierAnotherProtocolAndOtherNodesAreNamed) {
  EXPECT_THAT(heard([](int node, drives::Message right) -> std::optional<drives::Message> {
                if (node == 4) right.id = 0x11;
                return right;
              }),
              ElementsAre(HasSubstr("an answer of left_knee with another identifier; robot.yaml's `reply_id` should be "
                                    "0x11")));
  EXPECT_THAT(heard([](int node, drives::Message right) -> std::optional<drives::Message> {
                if (node == 4) right.id = 0x2800FD04, right.extended = true;
                return right;
              }),
              ElementsAre(HasSubstr("a protocol with 29-bit identifiers")));
  EXPECT_THAT(heard([](int node, const drives::Message& right) -> std::optional<drives::Message> {
                return node == 4 ? drives::Message::of(0x704, std::array<std::uint8_t, 1>{0x7F}) : right;
              }),
              ElementsAre(HasSubstr("a CANopen node's heartbeat, node 4")));
  EXPECT_THAT(heard([](int node, const drives::Message& right) -> std::optional<drives::Message> {
                return node == 4 ? drives::Message::of(0x3F0, std::array<std::uint8_t, 2>{1, 2}) : right;
              }),
              ElementsAre(HasSubstr("no message of a drive that robot.yaml has")));
}

/// A link whose controller says this.
class TroubledLink final : public Link {
 public:
  std::size_t send(std::span<const drives::Message> frames) noexcept override { return frames.size(); }
  std::size_t receive(std::span<drives::Message> /*frames*/) noexcept override { return 0; }
  BusHealth health() const noexcept override { return state; }
  const LinkCounts& counts() const noexcept override { return counted; }
  BusHealth state = BusHealth::kGood;
  LinkCounts counted;
};

TEST_F(OtherDialects, WhatTheControllerSaysTellsPowerFromBitRate) {
  TroubledLink link;
  EXPECT_EQ(controller_line(bus_, link), "");
  link.state = BusHealth::kPassive;
  link.counted = {.error_frames = 40, .ack_errors = 38, .sending_errors = 128};
  EXPECT_EQ(controller_line(bus_, link),
            "can0: this computer's CAN controller is error-passive, 40 error reports, error counters 128 sending and 0 "
            "receiving; nobody acknowledged a frame 38 times: no drive has power or the cable is off");
  link.counted = {.error_frames = 40, .sending_errors = 128, .receiving_errors = 96};
  EXPECT_THAT(controller_line(bus_, link), HasSubstr("expected that all have 1000000 bit/s, classic frames"));
  bus_.data_bitrate = 5'000'000;
  EXPECT_THAT(controller_line(bus_, link), HasSubstr("and 5000000 bit/s, and take CAN FD"));
}

}  // namespace
}  // namespace pmg::can
