#include "operator/joined_devices.hpp"

#include <gtest/gtest.h>

namespace pmg::ops {
namespace {

/// Its velocity and its posture are as they are set.
class Part : public Device {
 public:
  explicit Part(std::int32_t id) { hold.id = id; }
  DeviceManner manner() const override { return {}; }
  void set_limits(const CommandLimits& limits) noexcept override { upper = limits.upper[kVx]; }
  std::span<const Hold> holds(std::int64_t /*now_ns*/) noexcept override { return {&hold, 1}; }
  Command command(std::optional<std::int32_t> armed, std::int64_t /*now_ns*/) noexcept override {
    driving = armed == hold.id;
    return Command{{driving ? 1.0 * hold.id : 0.0, 0.0, 0.0, pitch}};
  }
  Requests take_requests() noexcept override { return std::exchange(requests, {}); }
  const PerFoot<PalmWish>* palms() const noexcept override { return &wishes; }
  void rest() noexcept override { driving = false; }
  void upright() noexcept override { pitch = 0.0; }

  Hold hold{};
  Requests requests{};
  PerFoot<PalmWish> wishes{};
  double pitch = 0.0, upper = 0.0;
  bool driving = false;
};

class JoinedDevicesTest : public testing::Test {
 protected:
  Command command(std::optional<std::int32_t> armed) {
    joined_.holds(0);
    return joined_.command(armed, 0);
  }
  Part page_{3}, headset_{-1};
  JoinedDevices joined_{{&page_, &headset_}, {}};
};

TEST_F(JoinedDevicesTest, WhoeverIsArmedCommandsAndLeadsTheArms) {
  EXPECT_EQ(joined_.holds(0).size(), 2U);
  EXPECT_EQ(command(3)[kVx], 3.0);
  EXPECT_EQ(joined_.palms(), &page_.wishes);
  EXPECT_FALSE(headset_.driving);
  EXPECT_EQ(command(-1)[kVx], -1.0);
  EXPECT_EQ(joined_.palms(), &headset_.wishes);
  EXPECT_FALSE(page_.driving);
  EXPECT_EQ(command(std::nullopt)[kVx], 0.0);
  EXPECT_EQ(joined_.palms(), nullptr);
  EXPECT_EQ(command(77), Command{}) << "nobody's";
}

TEST_F(JoinedDevicesTest, ThePostureOfWhoDroveLastStaysUntilAnotherDrives) {
  headset_.pitch = 0.2;
  EXPECT_EQ(command(std::nullopt)[kPitch], 0.0) << "it never drove";
  command(-1);
  EXPECT_EQ(command(std::nullopt)[kPitch], 0.2);
  EXPECT_EQ(command(3)[kPitch], 0.0);
  EXPECT_EQ(command(std::nullopt)[kPitch], 0.0);
  EXPECT_EQ(command(-1)[kPitch], 0.0) << "what it was before another one drove is over";
}

TEST_F(JoinedDevicesTest, EverybodysStopCountsAndWhatIsToldToAllReachesAll) {
  headset_.requests.stop = true;
  page_.requests.other = Request::kStand;
  const Requests requests = joined_.take_requests();
  EXPECT_TRUE(requests.stop);
  EXPECT_EQ(requests.other, Request::kStand);
  EXPECT_FALSE(joined_.take_requests().stop);
  CommandLimits limits;
  limits.upper[kVx] = 0.7;
  joined_.set_limits(limits);
  EXPECT_EQ(page_.upper + headset_.upper, 1.4);
  command(3);
  joined_.rest();
  EXPECT_FALSE(page_.driving);
  EXPECT_EQ(joined_.palms(), nullptr);
}

}  // namespace
}  // namespace pmg::ops
