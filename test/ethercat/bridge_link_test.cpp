// A bridge's process data: order, counting and acknowledgement of batches, in both directions.
#include "ethercat/bridge_link.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace pmg::ethercat {
namespace {

using testing::ElementsAre;

constexpr int kRoom = 3;

drives::Message frame(std::uint32_t id) {
  const std::array<std::uint8_t, 2> data = {static_cast<std::uint8_t>(id), 0x55};
  return drives::Message::of(id, data);
}

/// A bridge's block.
std::vector<std::uint8_t> batch(std::uint8_t sequence, const std::vector<drives::Message>& frames) {
  std::vector<std::uint8_t> block(block_bytes(kRoom), 0);
  put_frames(frames, block);
  block[0] = sequence;
  return block;
}

std::vector<std::uint32_t> fetch(BridgeLink& link, std::size_t most = 16) {
  std::vector<drives::Message> frames(most);
  frames.resize(link.receive(frames));
  std::vector<std::uint32_t> ids;
  for (const drives::Message& one : frames) ids.push_back(one.id);
  return ids;
}

TEST(BridgeLink, FramesGoOutInTheirOrderOnceAndThoseBeyondTheRoomAreCounted) {
  BridgeLink link;
  for (const std::uint32_t id : {1U, 2U, 3U, 4U}) {
    const drives::Message one = frame(id);
    link.send(std::span(&one, 1));
  }
  std::vector<std::uint8_t> block(block_bytes(kRoom), 0);
  link.fill(block);
  std::vector<std::uint32_t> ids;
  for_frames(block, [&](const drives::Message& one) {
    ids.push_back(one.id);
    EXPECT_EQ(one.length, 2);
    EXPECT_EQ(one.data[0], one.id);
  });
  EXPECT_THAT(ids, ElementsAre(1U, 2U, 3U));
  EXPECT_EQ(link.counts().sent, 3u);
  EXPECT_EQ(link.counts().not_sent, 1u);
  const std::uint8_t sequence = block[0];
  link.fill(block);
  EXPECT_NE(block[0], sequence) << "the bridge must see a new batch, though it is empty";
  EXPECT_EQ(block[2], 0) << "nothing goes out twice";
}

TEST(BridgeLink, AnIdentifierOf29BitsStaysOne) {
  BridgeLink link;
  drives::Message wide = frame(0x1ABCDEF0);
  wide.extended = true;
  link.take(batch(1, {wide}));
  std::array<drives::Message, 1> got;
  ASSERT_EQ(link.receive(got), 1u);
  EXPECT_EQ(got[0].id, 0x1ABCDEF0u);
  EXPECT_TRUE(got[0].extended);
}

TEST(BridgeLink, ABatchIsTakenOnceAndAcknowledgedByItsNumber) {
  BridgeLink link;
  std::vector<std::uint8_t> out(block_bytes(kRoom), 0);
  EXPECT_FALSE(link.take(batch(7, {frame(1), frame(2)}))) << "there was room for one more";
  EXPECT_FALSE(link.take(batch(7, {frame(1), frame(2)}))) << "the same again";
  link.fill(out);
  EXPECT_EQ(out[1], 7);
  EXPECT_TRUE(link.take(batch(8, {frame(3), frame(4), frame(5)}))) << "full: there may be more";
  link.fill(out);
  EXPECT_EQ(out[1], 8);
  EXPECT_THAT(fetch(link), ElementsAre(1U, 2U, 3U, 4U, 5U));
  EXPECT_EQ(link.counts().received, 5u);
}

TEST(BridgeLink, WhatNobodyFetchedStaysBeforeTheNextBatch) {
  BridgeLink link;
  link.take(batch(1, {frame(1), frame(2), frame(3)}));
  EXPECT_THAT(fetch(link, 1), ElementsAre(1U));
  link.take(batch(2, {frame(4)}));
  EXPECT_THAT(fetch(link), ElementsAre(2U, 3U, 4U));
}

TEST(BridgeLink, ItsHealthIsThatOfTheBridgesController) {
  BridgeLink link;
  const std::vector<std::pair<std::uint8_t, can::BusHealth>> healths = {
      {1, can::BusHealth::kPassive}, {2, can::BusHealth::kOff}, {9, can::BusHealth::kOff}, {0, can::BusHealth::kGood}};
  for (const auto& [said, health] : healths) {
    std::vector<std::uint8_t> block = batch(1, {});
    block[3] = said;
    link.take(block);
    EXPECT_EQ(link.health(), health) << int{said} << ", though the batch is an old one";
  }
}

}  // namespace
}  // namespace pmg::ethercat
