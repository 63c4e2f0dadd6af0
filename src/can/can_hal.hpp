// A robot's drives on its CAN buses, one bus cycle at a time.
#pragma once

#include <poll.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "can/bus_motor.hpp"
#include "can/link.hpp"
#include "can/xsens_imu.hpp"
#include "drives/drive_setup.hpp"
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
std::string describe(const BusTrouble& trouble, const drives::DriveSetup& setup);

class CanHal final : public hal::Hal {
 public:
  /// How long an exchange waits for the drives' answers. Answers that come later count in the next cycle.
  static constexpr std::int64_t kWait_ns = 500'000;
  /// A pause of the bus thread after which the drives' watchdogs may have acted. They are to be set to 20 ms or more.
  static constexpr std::int64_t kPause_ns = 20'000'000;

  /// One link a bus, in the order of setup.buses. Keeps references; clock is the run's, on which a pause is counted.
  CanHal(const drives::DriveSetup& setup, const model::RobotModel& robot, const io::Clock& clock,
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
    return buses_[bus].motors[motor].monitor();
  }
  const Link& link(std::size_t bus) const noexcept { return *buses_[bus].link; }
  const XsensImu& imu() const noexcept { return imu_; }
  std::uint64_t strangers() const noexcept { return strangers_; }    ///< replies of nodes that robot.yaml doesn't have
  std::uint64_t unreadable() const noexcept { return unreadable_; }  ///< frames that are nobody's message

 private:
  template <int N>
  struct Linked {
    using Angles = typename drives::RodLinkage<N>::Angles;
    const drives::LinkedMotors<N>* setup = nullptr;
    Angles q_rad = Angles::Zero(), dq_rad_s = Angles::Zero(), theta_rad = Angles::Zero();  // of the last sample
    bool solved = true;  // the joint angles belong to the last motor angles
  };
  struct Bus {
    const drives::BusSetup* setup = nullptr;
    std::unique_ptr<Link> link;
    std::vector<BusMotor> motors;
    bool canopen = false;                        // some motor's drive is a CANopen one
    std::vector<Frame> outgoing;                 // room for one a motor and the network's two
    std::vector<int> asked;                      // one a frame: the motor that it asks; kAllCanopen, kNobody
    std::vector<drives::MotorCommand> wanted;    // one a motor, before its transmission: at the joint, or at the crank
    std::vector<drives::MotorReading> readings;  // one a motor, of its joint
    std::vector<Linked<1>> four_bars;
    std::vector<Linked<2>> parallel;
  };
  template <int N>
  static void command_cranks(Bus& bus, const Linked<N>& linked) noexcept;
  template <int N>
  static void read_joints(Bus& bus, Linked<N>& linked) noexcept;
  static void read_joints(Bus& bus) noexcept;
  static constexpr int kAllCanopen = -1, kNobody = -2;
  void send(Bus& bus, const model::JointCommand& command, bool paused) noexcept;
  static void send_targets(Bus& bus) noexcept;
  static int unsolved(const Bus& bus) noexcept;
  void drain() noexcept;
  void drain(Bus& bus) noexcept;
  void hear(Bus& bus, const Frame& frame) noexcept;
  bool all_answered() const noexcept;
  bool wait(std::int64_t deadline_ns) noexcept;
  BusTrouble judge() const noexcept;
  void tell() noexcept;

  const model::RobotModel& robot_;
  const io::Clock& clock_;
  std::vector<Bus> buses_;
  std::vector<Frame> incoming_;
  std::vector<pollfd> polled_;  // one a bus
  XsensImu imu_;
  bool stiff_ = false, urgent_ = false, waits_ = false;
  JointVector kp_, kd_;  // of the last command
  std::int64_t last_send_ns_ = 0;
  std::uint64_t cycles_ = 0, strangers_ = 0, unreadable_ = 0;
  BusTrouble trouble_, told_;
  io::Mailbox<BusTrouble> changes_;
};

}  // namespace pmg::can
