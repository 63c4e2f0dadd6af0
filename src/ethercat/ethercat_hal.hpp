// A robot's drives and IMU behind EtherCAT slaves, one bus cycle at a time: slaves that bridge CAN, drives that are
// slaves, an IMU that is one.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "can/bus_setup.hpp"
#include "can/can_hal.hpp"
#include "can/roll_call.hpp"
#include "ethercat/bridge_link.hpp"
#include "ethercat/clock_lock.hpp"
#include "ethercat/drive_link.hpp"
#include "ethercat/ethercat_setup.hpp"
#include "ethercat/process_data_imu.hpp"
#include "hal/hal.hpp"
#include "hal/phase_source.hpp"

namespace pmg::ethercat {

class EthercatHal final : public hal::Hal, public hal::PhaseSource {
 public:
  /// Cycles in a row in which the cable fails: the first may be a lost frame, the second is a loss.
  static constexpr int kLostCycles = 2;
  /// Between two requests to slaves that left OP: 0.1 s.
  static constexpr int kRecoverCycles = 50;

  /// Brings the slaves up and asks every drive and the IMU while the drives are off. pause: a millisecond or so between
  /// two exchanges; emulators answer in it. Keeps references. Throws std::runtime_error, one line.
  EthercatHal(const EthercatSetup& setup, const can::DriveSetup& drives, const model::RobotModel& robot,
              const io::Clock& clock, Wire& wire, const can::Wait& pause, const std::function<bool()>& interrupted);

  /// Reads what the slaves got in the last cycle, decides as on a CAN bus (can::CanHal), and writes the commands.
  /// kStale: a working counter is short, a slave isn't operational, clocks are apart, a frame didn't come back, or the
  /// IMU is late. kLost: so for two cycles, a clock runs away, or the IMU is silent; or as can::CanHal says. Slaves
  /// that left OP are told to go back while the command has no stiffness.
  hal::BusStatus exchange(const model::JointCommand& command, model::RobotState& state) noexcept override;
  /// Towards the slaves' clock, if there is one.
  std::int64_t phase_shift_ns() const noexcept override { return shift_ns_; }

  const CableState& cable() const noexcept { return master_.state(); }
  const ClockLock& clock_lock() const noexcept { return lock_; }
  std::uint64_t misses() const noexcept { return misses_; }  ///< cycles in which the cable failed
  can::CanHal& can() noexcept { return can_; }
  /// What has changed since the last call, one line; empty: nothing. For one other thread.
  std::string take_news();

 private:
  struct Channel {
    BridgeLink* link;
    std::size_t slave, offset_out, offset_in;
  };
  struct DriveBus {
    DriveLink* link;
    std::vector<std::size_t> slaves;  // in the order of the bus's motors
  };
  struct Change {
    CableState cable;
    bool lost = false, runs_away = false, imu_silent = false;
    bool operator==(const Change& other) const noexcept {
      return lost == other.lost && runs_away == other.runs_away && imu_silent == other.imu_silent;
    }
  };
  /// The objects of a drive that is a slave: compared with robot.yaml, set up, mapped; its answer to the roll call.
  void prepare_drive(std::size_t bus, std::size_t motor, drives::ObjectDictionary& objects);
  std::vector<std::unique_ptr<can::Link>> make_links();
  /// The links, after every drive has answered over them.
  std::vector<std::unique_ptr<can::Link>> called(const can::Wait& pause, const std::function<bool()>& interrupted);
  /// Empties the bridges of what they still hold for an earlier controller: its drives' answers are none to us.
  void empty_bridges(const can::Wait& pause, const std::function<bool()>& interrupted);
  void await_imu(const can::Wait& pause, const std::function<bool()>& interrupted);
  /// True: a bridge gave as much as there is room for.
  bool read() noexcept;
  void write(bool recover) noexcept;
  /// The cable's status of this cycle.
  hal::BusStatus judge() noexcept;

  EthercatSetup setup_;
  const can::DriveSetup& drives_;
  const io::Clock& clock_;
  std::int64_t sent_ns_ = 0;  // the cycle's first frame
  std::optional<ProcessDataImu> imu_;
  std::size_t imu_slave_ = 0;
  std::vector<std::vector<can::Answer>> drive_answers_;  // of each bus: those of drives that are slaves
  Master master_;
  std::vector<Channel> channels_;
  std::vector<DriveBus> drive_buses_;
  can::CanHal can_;
  model::RobotState whole_;
  ClockLock lock_{Master::kPeriod_ns, Master::kPhase_ns};
  std::int64_t shift_ns_ = 0;
  int bad_cycles_ = 0, since_recovery_ = 0;
  std::uint64_t misses_ = 0;
  Change told_;
  io::Mailbox<Change> changes_;
};

}  // namespace pmg::ethercat
