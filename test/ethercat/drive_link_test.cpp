// Drives that are slaves themselves: what their inputs are to a CANopen client.
#include "ethercat/drive_link.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace pmg::ethercat {
namespace {

TEST(DriveLink, InputsAreTwoAnswersToOneSyncAndOfAnotherLengthNone) {
  DriveLink link({1, 2});
  const drives::Message sync = drives::canopen::sync();
  std::array<drives::Message, 8> got;
  const auto answers_to = [&](std::size_t bytes) {
    link.send(std::span(&sync, 1));
    link.take(1, std::vector<std::uint8_t>(bytes, 7));
    return link.receive(got);
  };
  for (const bool temperature : {false, true}) {
    ASSERT_EQ(answers_to(drive_inputs(temperature)), 2U);
    EXPECT_EQ(got[0].id, drives::canopen::kTransmit1 + 2);
    EXPECT_EQ(got[0].length, 8);
    EXPECT_EQ(got[1].id, drives::canopen::kTransmit2 + 2);
    EXPECT_EQ(got[1].length, temperature ? 8 : 6);
  }
  for (const std::size_t bytes : {0U, 8U, 13U, 15U, 17U, 80U}) EXPECT_EQ(answers_to(bytes), 0U) << bytes;
  link.take(1, std::vector<std::uint8_t>(drive_inputs(true), 7));
  link.take(1, std::vector<std::uint8_t>(drive_inputs(true), 7));
  EXPECT_EQ(link.receive(got), 2U) << "the answer to the last SYNC, once";
}

}  // namespace
}  // namespace pmg::ethercat
