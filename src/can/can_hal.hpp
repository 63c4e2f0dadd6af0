// A robot's drives on its CAN buses, one bus cycle at a time.
#pragma once

#include <poll.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "can/bus_setup.hpp"
#include "can/link.hpp"
#include "can/xsens_imu.hpp"
#include "drives/motor_channel.hpp"
#include "drives/robot_drives.hpp"
#include "hal/hal.hpp"
#include "io/clock.hpp"
#include "io/mailbox.hpp"

namespace pmg::can {

/// The first thing that is wrong with the drives; names what people look at.
struct BusTrouble {
  hal::BusStatus status = hal::BusStatus::kOk;
  int bus = -1;    ///< index in DriveSetup::buses; -1: none
  int motor = -1;  ///< index in the bus's motors; -1: the bus itself, or its IMU
  bool imu = false;
  drives::Trouble trouble = drives::Trouble::kNone;
  drives::DriveFault fault = drives::DriveFault::kNone;
  BusHealth health = BusHealth::kGood;
  bool operator==(const BusTrouble&) const = default;
};

/// One line: "left_knee (can0, node 4) does not answer".
std::string describe(const BusTrouble& trouble, const DriveSetup& setup);

class CanHal final : public hal::Hal {
 public:
  /// How long an exchange waits for the drives' answers. Answers that come later count in the next cycle.
  static constexpr std::int64_t kWait_ns = 500'000;

  /// One link a bus, in the order of setup.buses. Keeps references; clock is the run's, on which a pause is counted.
  CanHal(const DriveSetup& setup, const model::RobotModel& robot, const io::Clock& clock,
         std::vector<std::unique_ptr<Link>> links);

  /// Sends every motor its command, or the request to enable it, and receives for kWait_ns at most. CANopen drives are
  /// asked first and get their commands from what they answer. Their nodes are set up before (can/canopen_setup.hpp).
  /// - kOk: every motor answered this cycle's command or the one before, and the IMU spoke within 10 ms.
  /// - kStale: somebody is later than that; the state keeps its last value.
  /// - kLost: somebody is silent for 10 ms (the IMU for 20 ms), reports a fault, doesn't follow, can't be believed; or
  /// a
  ///   bus is off.
  /// A motor is enabled only by a cycle whose command has neither stiffness nor feed-forward: it never jumps.
  hal::BusStatus exchange(const model::JointCommand& command, model::RobotState& state) noexcept override;

  /// The two halves of exchange, for a caller that lets emulated drives answer between them.
  void send(const model::JointCommand& command) noexcept;
  hal::BusStatus receive(model::RobotState& state) noexcept;

  const BusTrouble& trouble() const noexcept { return trouble_; }  ///< of the last cycle
  /// A loss that began, another one, or its end, since the last call. For one other thread, wait-free.
  bool take_change(BusTrouble& change) noexcept { return changes_.take(change); }
  const drives::MotorMonitor& motor(std::size_t bus, std::size_t motor) const noexcept {
    return drives_.monitor(bus, motor);
  }
  const Link& link(std::size_t bus) const noexcept { return *buses_[bus].link; }
  const XsensImu& imu() const noexcept { return imu_; }
  std::uint64_t strangers() const noexcept { return strangers_; }    ///< replies of nodes that robot.yaml doesn't have
  std::uint64_t unreadable() const noexcept { return unreadable_; }  ///< frames that are nobody's message

 private:
  struct Bus {
    const BusSetup* setup = nullptr;
    std::unique_ptr<Link> link;
    std::vector<drives::MotorChannel> motors;
    std::unique_ptr<drives::Network> network;  // null: nothing is for all of its drives together
    bool synced = false;                       // the network asks some motor's drive
    std::vector<drives::Message> outgoing;     // room for all of its motors' and the network's
    std::vector<int> asked;                    // one a frame: the motor that it asks; kAllSynced, kNobody
  };
  static constexpr int kAllSynced = -1, kNobody = -2;
  void send(std::size_t b) noexcept;
  static void send_targets(Bus& bus) noexcept;
  void drain() noexcept;
  void drain(Bus& bus) noexcept;
  void hear(Bus& bus, const drives::Message& frame) noexcept;
  bool wait(std::int64_t deadline_ns) noexcept;
  BusTrouble judge() const noexcept;
  void tell() noexcept;

  const io::Clock& clock_;
  drives::RobotDrives drives_;
  std::vector<Bus> buses_;
  std::vector<drives::Message> incoming_;
  std::vector<pollfd> polled_;  // one a bus
  XsensImu imu_;
  bool waits_ = false;
  std::uint64_t cycles_ = 0, strangers_ = 0, unreadable_ = 0;
  BusTrouble trouble_, told_;
  io::Mailbox<BusTrouble> changes_;
};

}  // namespace pmg::can
