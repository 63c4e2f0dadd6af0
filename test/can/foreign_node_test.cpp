// The client against a CANopen node that this project did not write (test/can/foreign_node.py), in lockstep: a cycle
// goes on when the node has answered all that it was asked, however long that takes. So counts and positions decide,
// and no clock. foreign_node_test.sh starts the node and this; elsewhere these tests are skipped.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "../sim/robots.hpp"
#include "can/bus_ids.hpp"
#include "can/can_hal.hpp"
#include "can/canopen_setup.hpp"
#include "can/first_light.hpp"
#include "can/socket_link.hpp"
#include "drive_protocols/canopen_drive.hpp"

namespace pmg::can {
namespace {

using drives::Cia402Mode;
using hal::BusStatus;

constexpr int kNode = 4;

/// What went over the bus, seen by a socket of its own. Frames of one bus have one order for all who hear it.
class Watcher {
 public:
  struct Counts {
    int requests = 0, answers = 0;           // SDO
    int syncs = 0, firsts = 0, seconds = 0;  // and the node's two PDOs
    int commands = 0, emergencies = 0;
    int astray = 0;  // positions that are no target of the cycle before
    std::uint64_t ours = 0;
  };

  /// What this link sends is awaited, too, while the object lives.
  class Watched {
   public:
    Watched(Watcher& watcher, const Link& link) : watcher_(watcher), link_(link) {
      watcher_.senders_.push_back(&link_);
    }
    ~Watched() {
      watcher_.gone_ += link_.counts().sent;
      std::erase(watcher_.senders_, &link_);
    }
    Watched(const Watched&) = delete;
    Watched& operator=(const Watched&) = delete;

   private:
    Watcher& watcher_;
    const Link& link_;
  };
  /// Until all that was sent has passed here, and the node has answered it.
  void wait() {
    hear();
    for (int k = 0; !answered(); ++k) {
      if (k == kPatience) throw std::runtime_error("the foreign node does not answer");
      pollfd polled{.fd = link_.descriptor(), .events = POLLIN, .revents = 0};
      poll(&polled, 1, 1000);
      hear();
    }
  }
  const Counts& counts() const { return counts_; }
  /// Whether the node shows the position that it was told: in position mode, switched on.
  void compare(bool positions) { compares_ = positions; }
  std::int32_t position() const { return position_; }

 private:
  static constexpr int kPatience = 30;  // s without an answer: it is dead

  bool answered() const {
    std::uint64_t sent = gone_;
    for (const Link* link : senders_) sent += link->counts().sent;
    return counts_.ours >= sent && counts_.answers >= counts_.requests && counts_.firsts >= counts_.syncs &&
           counts_.seconds >= counts_.syncs;
  }
  void hear() {
    std::array<drives::Message, 64> frames;
    while (const std::size_t count = link_.receive(frames)) {
      for (const drives::Message& frame : std::span(frames).first(count)) hear(frame);
    }
  }
  void hear(const drives::Message& frame) {
    constexpr std::array kOurs = {std::uint32_t{drives::canopen::kNetworkManagement},
                                  std::uint32_t{drives::canopen::kSync}, drives::canopen::kReceive1 + kNode,
                                  drives::canopen::kSdoRequest + kNode,
                                  drives::canopen::kHeartbeat + drives::canopen::kHostNode};
    if (std::ranges::find(kOurs, frame.id) != kOurs.end()) ++counts_.ours;
    drives::Cia402Inputs inputs;
    switch (frame.id) {
      case drives::canopen::kSdoRequest + kNode:
        ++counts_.requests;
        break;
      case drives::canopen::kSdoAnswer + kNode:
        ++counts_.answers;
        break;
      case drives::canopen::kSync:
        ++counts_.syncs;
        break;
      case drives::canopen::kReceive1 + kNode:
        ++counts_.commands;
        target_ = static_cast<std::int32_t>(frame.data[2] | frame.data[3] << 8U | frame.data[4] << 16U |
                                            static_cast<std::uint32_t>(frame.data[5]) << 24U);
        on_ = (frame.data[0] & 0xFU) == 0xFU;
        break;
      case drives::canopen::kTransmit1 + kNode:
        ++counts_.firsts;
        drives::canopen::take_transmit1(frame, inputs);
        position_ = inputs.position;
        if (compares_ && on_ && drives::cia402_state(inputs.status_word) == drives::Cia402State::kOperationEnabled)
          counts_.astray += position_ == target_ ? 0 : 1;
        break;
      case drives::canopen::kTransmit2 + kNode:
        ++counts_.seconds;
        break;
      case drives::canopen::kEmergency + kNode:
        ++counts_.emergencies;
        break;
      default:
        break;
    }
  }

  SocketLink link_{"can0", {}, false};
  std::vector<const Link*> senders_;
  std::uint64_t gone_ = 0;  // frames that links sent which are no more
  Counts counts_;
  bool compares_ = false, on_ = false;
  std::int32_t target_ = 0, position_ = 0;
};

/// Z1's left knee alone on can0: the foreign node.
class ForeignNode : public testing::Test {
 protected:
  void SetUp() override {
    if (std::getenv("PMG_FOREIGN_NODE") == nullptr) GTEST_SKIP() << "needs test/can/foreign_node_test.sh";
    watcher_.emplace();  // first: a kernel delivers a frame to the newest socket first, so the others have it by then
    link_ = std::make_unique<SocketLink>("can0", std::vector<std::uint32_t>{}, false);
    watched_.emplace(*watcher_, *link_);
  }
  void TearDown() override {
    if (!watcher_) return;
    // Its answer comes after it has taken the last command.
    SocketLink last("can0", {drives::canopen::kSdoAnswer + kNode}, false);
    const Watcher::Watched watched(*watcher_, last);
    EXPECT_TRUE(SdoClient(kNode, last, wait_).read(drives::object::kDeviceType));
    const Watcher::Counts& c = watcher_->counts();
    EXPECT_EQ(c.answers, c.requests);
    EXPECT_EQ(c.firsts, c.syncs);
    EXPECT_EQ(c.seconds, c.syncs);
    fmt::print("counts: {} SYNCs, {} commands\n", c.syncs, c.commands);
  }
  can::DriveSetup setup(Cia402Mode mode) const {
    can::DriveSetup setup = can::load_drives(z1());
    setup.buses.resize(1);
    can::BusSetup& bus = setup.buses[0];
    bus.motors = {bus.motors[3]};
    const model::Joint& joint = z1().joints[static_cast<std::size_t>(bus.motors[0].index)];
    bus.motors[0].drive = drives::cia402_drive({.mode = mode,
                                                .counts_per_turn = 65536.0,
                                                .velocity_unit_rad_s = 1e-3,
                                                .rated_torque_Nm = 40.0,
                                                .largest_torque_Nm = 120.0,
                                                .kp_Nm_per_rad = joint.kp_Nm_per_rad,
                                                .kd_Nm_s_per_rad = joint.kd_Nm_s_per_rad});
    return setup;
  }
  Wiggle wiggle(const can::DriveSetup& setup, const WiggleOptions& options) {
    return can::wiggle(z1(), z1().q_stand(), setup.buses[0], setup.buses[0].motors[0], *link_, options, wait_, {});
  }

  std::optional<Watcher> watcher_;
  std::unique_ptr<Link> link_;
  std::optional<Watcher::Watched> watched_;
  Wait wait_ = [this] { watcher_->wait(); };
};

TEST_F(ForeignNode, InPositionModeItMovesToEachTargetByTheCount) {
  watcher_->compare(true);
  const Wiggle moved = wiggle(setup(Cia402Mode::kPosition), {.by_rad = 0.05});
  constexpr double kCount_rad = 2.0 * M_PI / 65536.0;
  EXPECT_NEAR(moved.moved_rad, 0.05, kCount_rad) << "its start and its end are rounded to half a count each";
  EXPECT_EQ(watcher_->counts().astray, 0);
  // 0.05 rad at 0.1 rad/s there, twice back, and there again: 2 s, and 0.2 s at each of three ends.
  EXPECT_GE(watcher_->counts().commands, 1300);
}

TEST_F(ForeignNode, InTorqueModeTheClientsLoopMovesItsInertia) {
  const Wiggle moved = wiggle(setup(Cia402Mode::kTorque), {.by_rad = 0.05, .gain_share = 0.3});
  // A count of torque is 40 mNm: at 210 Nm/rad the loop is at rest within 0.2 mrad of its target, at each of both ends.
  EXPECT_NEAR(moved.moved_rad, 0.05, 4e-4);
  EXPECT_NEAR(moved.held_Nm, 0.0, 0.04) << "a motor without load holds nothing";
  EXPECT_GE(watcher_->counts().commands, 1300);
}

/// The bus thread's own cycle: follows a sine in position mode, is told a fault in the cycle in which the node reports
/// it, and drives again after the reset.
TEST_F(ForeignNode, TheBusCycleFollowsItAndNamesItsFaultInTheSameCycle) {
  const can::DriveSetup drives = setup(Cia402Mode::kPosition);
  const io::SimulationClock clock;
  std::optional<CanHal> bus;
  std::vector<std::unique_ptr<Link>> links;
  links.push_back(std::make_unique<SocketLink>("can0", awaited_ids(drives.buses[0]), false));
  const Watcher::Watched watched(*watcher_, *links[0]);  // ends before the link does
  set_up_nodes(drives, links, wait_, {});
  CanHal& hal = bus.emplace(drives, z1(), clock, std::move(links));
  const int knee = drives.buses[0].motors[0].index;
  model::JointCommand limp = standing_command(z1()), damping = limp, holding = limp;
  limp.kp.setZero();
  limp.kd.setZero();
  damping.kp.setZero();
  model::RobotState state;
  const auto cycle = [&](const model::JointCommand& command) {
    hal.send(command);
    watcher_->wait();
    return hal.receive(state);
  };
  // The other joints have no drive here, and their gains are nobody's.
  for (int k = 0; k < 10; ++k) cycle(limp);
  const double start_rad = state.q[knee];
  watcher_->compare(true);
  for (int k = 0; k < 500; ++k) {
    holding.q[knee] = start_rad + 0.2 * std::sin(2.0 * M_PI * 0.002 * k);
    ASSERT_EQ(cycle(holding), BusStatus::kOk) << k << ": " << describe(hal.trouble(), drives);
    ASSERT_EQ(hal.motor(0, 0).age_cycles(), 0) << k;
  }
  EXPECT_EQ(watcher_->counts().astray, 0);
  EXPECT_EQ(hal.motor(0, 0).lost() + hal.motor(0, 0).uncalled() + hal.motor(0, 0).refused(), 0u);
  EXPECT_EQ(hal.unreadable() + hal.strangers(), 0u);

  SocketLink other("can0", {drives::canopen::kSdoAnswer + kNode}, false);
  const Watcher::Watched also(*watcher_, other);
  SdoClient objects(kNode, other, wait_);
  constexpr drives::ObjectId kErrorToReport{0x2000, 0, 2};
  ASSERT_TRUE(objects.write(kErrorToReport, 0x4310));
  EXPECT_EQ(cycle(holding), BusStatus::kLost) << "in the cycle in which it is reported";
  EXPECT_EQ(describe(hal.trouble(), drives), "left_knee (can0, node 4) reports over-temperature of the motor");
  EXPECT_EQ(watcher_->counts().emergencies, 1);
  ASSERT_TRUE(objects.write(kErrorToReport, 0));
  const std::int32_t stopped_at = watcher_->position();
  for (int k = 0; k < 300; ++k) ASSERT_EQ(cycle(holding), BusStatus::kLost) << "not reset under stiffness";
  EXPECT_EQ(watcher_->position(), stopped_at) << "nor moved";
  for (int k = 0; k < 300; ++k) cycle(damping);
  for (int k = 0; k < 10; ++k) ASSERT_EQ(cycle(holding), BusStatus::kOk) << describe(hal.trouble(), drives);
}

}  // namespace
}  // namespace pmg::can
