// What the backend takes from robot.yaml before it opens a bus.
#include "can/can_backend.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

#include "../sim/robots.hpp"
#include "can/bus_ids.hpp"
#include "can/mixed_drives.hpp"
#include "io/clock.hpp"
#include "model/temporary_copy.hpp"

namespace pmg::can {
namespace {

std::unique_ptr<hal::Backend> make(const model::RobotModel& robot, const io::Clock& clock) {
  hal::BackendFactory factory;
  register_backend(factory);
  return factory.kind("can").make({.robot = robot,
                                   .clock = clock,
                                   .name = "z1",
                                   .lcm_url = "memq://",
                                   .benched_joint = "",
                                   .keeps_truth = false,
                                   .options = {}});
}

TEST(CanBackend, ARobotWhoseBusCantCarryItsDrivesIsRefusedBeforeABusIsOpened) {
  const model::TemporaryCopy copy(test::kZ1Folder);
  copy.replace("robot.yaml", "can2: {bitrate: 1000000}", "can2: {bitrate: 500000}");
  const model::RobotModel robot = model::load_robot(copy.directory());
  const io::SimulationClock clock;
  try {
    make(robot, clock);
    FAIL() << "seven motors at 500 kbit/s";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("can2: 14 frames a cycle take 3.78 ms at 500000 bit/s"));
  }
}

TEST(CanBackend, ItsConfigurationSaysWhatEachBusCarries) {
  const io::SimulationClock clock;
  const auto backend = make(z1(), clock);
  EXPECT_EQ(std::get<std::string>(backend->configuration().at("can0")),
            "6 motors, 1000000 bit/s, 12 frames a cycle, 81 % of it at the worst bit stuffing");
  EXPECT_EQ(backend->description().drive_sampling_s, 0.0) << "an MIT drive reads its encoder in each of its own cycles";
}

TEST(CanBackend, ItSaysWhichLoopsTheBusThreadClosesAndWhichDrivesHaveTheirOwnGains) {
  const hal::BackendDescription plain = description(can::load_drives(z1())),
                                mixed = description(test::mixed_drives(z1()));
  EXPECT_THAT(plain.closed_by_bus, testing::IsEmpty());
  EXPECT_THAT(plain.own_gains, testing::IsEmpty());
  EXPECT_EQ(mixed.drive_sampling_s, std::nullopt) << "what a drive in position mode does isn't known";
  EXPECT_THAT(mixed.closed_by_bus, testing::UnorderedElementsAre("left_hip_pitch", "left_hip_roll", "left_hip_yaw",
                                                                 "right_hip_pitch", "right_hip_roll", "right_hip_yaw",
                                                                 "waist_yaw", "waist_roll", "waist_pitch"));
  EXPECT_EQ(mixed.bus_loop_age_s, 0.001) << "half a cycle";
  EXPECT_THAT(mixed.own_gains,
              testing::UnorderedElementsAre("left_shoulder_pitch", "left_shoulder_roll", "left_shoulder_yaw",
                                            "right_shoulder_pitch", "right_shoulder_roll", "right_shoulder_yaw"));
}

TEST(CanBackend, ASocketHearsWhatTheDrivesAndTheImuOfItsBusSendAndNothingElse) {
  const can::DriveSetup plain = can::load_drives(z1()), mixed = test::mixed_drives(z1());
  EXPECT_THAT(awaited_ids(plain.buses[0]), testing::ElementsAre(0x000)) << "every MIT drive answers to one identifier";
  const auto with_imu = std::ranges::find(plain.buses, true, &can::BusSetup::imu);
  EXPECT_THAT(awaited_ids(*with_imu), testing::ElementsAre(0x000, 0x21, 0x32, 0x34));
  EXPECT_THAT(awaited_ids(mixed.buses[0]),
              testing::UnorderedElementsAre(0x181, 0x281, 0x081, 0x701, 0x581, 0x182, 0x282, 0x082, 0x702, 0x582,  //
                                            0x183, 0x283, 0x083, 0x703, 0x583, test::kMixedReplyId));
}

}  // namespace
}  // namespace pmg::can
