// What the backend does when a kernel's CAN controller reports bus-off, error-passive and ACK errors. test/can/canrun
// brings a kernel with slcan; elsewhere these tests are skipped.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>

#include "../sim/robots.hpp"
#include "can/can_hal.hpp"
#include "can/mit_emulator.hpp"
#include "can/slcan_adapter.hpp"
#include "can/socket_link.hpp"

namespace pmg::can {
namespace {

using hal::BusStatus;

/// Limp cycles after a loss: an answer, a pause in which what was lost is given up, and two that enable.
constexpr int kBackCycles = 4;

/// Z1's left leg behind slcan, in lockstep: the kernel has passed on every frame before a cycle ends.
class SocketsSlcan : public testing::Test {
 protected:
  void SetUp() override {
    if (adapter_.interface().empty()) GTEST_SKIP() << "this kernel has no slcan: run test/can/canrun";
    setup_ = can::load_drives(z1());
    setup_.buses.resize(1);
    setup_.buses[0].name = adapter_.interface();
    std::vector<std::unique_ptr<Link>> links;
    links.push_back(std::make_unique<SocketLink>(adapter_.interface(), std::vector<std::uint32_t>{0}, false));
    watcher_.emplace(adapter_.interface(), std::vector<std::uint32_t>{0}, false);
    hal_.emplace(setup_, z1(), clock_, std::move(links));
    for (const drives::MotorSetup& motor : setup_.buses[0].motors)
      drives_.push_back(std::make_unique<test::MitEmulator>(motor));
    limp_.kp.setZero();
    limp_.kd.setZero();
  }
  /// The drives answer what reaches the wire, if anything does. said: by the adapter, before the answers.
  BusStatus cycle(const model::JointCommand& command, const std::string& said = {}, bool wire = true) {
    hal_->send(command);
    std::size_t awaited = 0;
    for (const drives::Message& frame : adapter_.sent(wire ? drives_.size() : 0)) {
      for (const auto& drive : drives_) {
        test::Replies replies;
        const int count = drive->hear(frame, replies);
        for (int i = 0; i < count; ++i) adapter_.hear(replies[static_cast<std::size_t>(i)]);
        awaited += static_cast<std::size_t>(count);
      }
    }
    if (!said.empty()) adapter_.say(said);
    await(awaited, said.empty() ? 0 : 1);
    return hal_->receive(state_);
  }
  void await(std::size_t frames, std::size_t errors) {
    const std::uint64_t wanted_frames = watcher_->counts().received + frames,
                        wanted_errors = watcher_->counts().error_frames + errors;
    pollfd polled{.fd = watcher_->descriptor(), .events = POLLIN, .revents = 0};
    std::array<drives::Message, 64> buffer;
    for (int wait = 0; wait < 100; ++wait) {
      watcher_->receive(buffer);
      if (watcher_->counts().received >= wanted_frames && watcher_->counts().error_frames >= wanted_errors) return;
      poll(&polled, 1, 100);
    }
  }
  void stand() {
    for (int k = 0; k < 2; ++k) cycle(limp_);
    for (int k = 0; k < 3; ++k) ASSERT_EQ(cycle(standing_), BusStatus::kOk) << trouble();
  }
  std::string trouble() const { return describe(hal_->trouble(), setup_); }
  const Link& link() const { return hal_->link(0); }

  test::SlcanAdapter adapter_;
  can::DriveSetup setup_;
  io::SimulationClock clock_;
  std::optional<SocketLink> watcher_;
  std::optional<CanHal> hal_;
  std::vector<std::unique_ptr<test::DriveEmulator>> drives_;
  model::RobotState state_;
  model::JointCommand standing_ = standing_command(z1()), limp_ = standing_command(z1());
};

TEST_F(SocketsSlcan, BusOffIsLostInTheSameCycleAndEndsWithTheInterfacesRestartUnderDamping) {
  stand();
  EXPECT_EQ(cycle(standing_, "sb256256"), BusStatus::kLost);
  EXPECT_EQ(trouble(), adapter_.interface() + " is off");
  EXPECT_EQ(link().counts().bus_offs, 1u);
  for (int k = 0; k < 10; ++k) EXPECT_EQ(cycle(standing_, {}, false), BusStatus::kLost);
  EXPECT_GT(link().counts().not_sent, 0u) << "a controller that is off sends nothing";
  adapter_.restart();
  for (int k = 0; k < 2; ++k) EXPECT_EQ(cycle(standing_), BusStatus::kLost) << "not enabled under stiffness";
  EXPECT_THAT(trouble(), testing::HasSubstr("is not enabled"));
  for (int k = 0; k < kBackCycles; ++k) cycle(limp_);
  EXPECT_EQ(cycle(standing_), BusStatus::kOk) << trouble();
}

TEST_F(SocketsSlcan, ErrorPassiveIsNoLossWhileTheDrivesAnswer) {
  stand();
  EXPECT_EQ(cycle(standing_, "sp128128"), BusStatus::kOk);
  EXPECT_EQ(link().counts().error_frames, 1u);
  EXPECT_EQ(link().health(), BusHealth::kPassive);
  EXPECT_EQ(cycle(standing_, "sa000000"), BusStatus::kOk);
  EXPECT_EQ(link().health(), BusHealth::kGood);
}

TEST_F(SocketsSlcan, FramesThatNobodyAcknowledgesAreCountedAndTheirMotorsLostInTheSixthCycle) {
  stand();
  for (const auto& drive : drives_) drive->silent = true;
  for (int k = 1; k <= 5; ++k) EXPECT_NE(cycle(standing_, "e1a"), BusStatus::kLost) << k;
  EXPECT_EQ(cycle(standing_, "e1a"), BusStatus::kLost);
  EXPECT_THAT(trouble(), testing::HasSubstr("does not answer"));
  EXPECT_EQ(link().counts().ack_errors, 6u);
  for (const auto& drive : drives_) drive->silent = false;
  for (int k = 0; k < kBackCycles; ++k) cycle(limp_);
  EXPECT_EQ(cycle(standing_), BusStatus::kOk) << trouble();
}

/// Sends until the kernel takes no more. Nobody reads the adapter.
std::uint64_t taken(const std::string& interface, int most_waiting) {
  SocketLink link(interface, {}, false, most_waiting);
  const drives::Message command = drives::Message::of(1, drives::kMitDisable);
  for (int k = 0; k < 5000 && link.counts().not_sent < 20; ++k) {
    link.send(std::span(&command, 1));
    pollfd polled{.fd = link.descriptor(), .events = POLLOUT, .revents = 0};
    if (link.counts().not_sent > 0) poll(&polled, 1, 10);  // the driver works off what its line takes
  }
  return link.counts().sent;
}

TEST_F(SocketsSlcan, FramesOfFourCyclesAndNoMoreWaitForAWireThatIsOut) {
  const std::string queue = "ip link set " + adapter_.interface() + " txqueuelen 1000";
  ASSERT_EQ(std::system(queue.c_str()), 0);  // NOLINT(cert-env33-c,concurrency-mt-unsafe)
  adapter_.restart();
  constexpr int kMost = 4 * 9;
  const std::uint64_t bounded = taken(adapter_.interface(), kMost);  // the line's room is full now
  EXPECT_GE(bounded, static_cast<std::uint64_t>(kMost));
  const std::uint64_t more = taken(adapter_.interface(), kMost), unbounded = taken(adapter_.interface(), 0);
  EXPECT_LE(more, static_cast<std::uint64_t>(1.2 * kMost) + 1) << "a second socket's";
  EXPECT_GE(more, static_cast<std::uint64_t>(0.8 * kMost)) << "a cycle's frames find room";
  EXPECT_GT(unbounded, 3 * more) << "what a kernel takes else";
}

}  // namespace
}  // namespace pmg::can
