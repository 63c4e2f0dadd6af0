// All motors of a robot, whatever carries their messages: what each is told, what each said, the linkages between
// motors and joints, and what is wrong.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drives/motor_group.hpp"
#include "drives/motor_monitor.hpp"
#include "model/robot_io.hpp"

namespace pmg::drives {

/// The first thing that is wrong with the motors of a group.
struct MotorTrouble {
  Condition condition = Condition::kGood;
  int motor = -1;  ///< index in the group's motors; -1: none
  Trouble trouble = Trouble::kNone;
  DriveFault fault = DriveFault::kNone;
  bool operator==(const MotorTrouble&) const = default;
};

/// "does not answer", "reports over-current", "answers late"
std::string words_of(Trouble trouble, DriveFault fault);

/// No heap after construction, no lock. A cycle: begin(); each motor's request and answers through its monitor; read();
/// then judge() and fill(). What goes over the wire is the caller's.
class RobotDrives {
 public:
  /// A pause between two cycles after which the drives' watchdogs may have acted. They are to be set to 20 ms or more.
  static constexpr std::int64_t kPause_ns = 20'000'000;

  /// Motors that are reached the same way, and for how many cycles their readings count as fresh (MotorMonitor).
  struct Way {
    const MotorGroup* group = nullptr;
    int fresh_cycles = MotorMonitor::kFreshCycles;
  };
  /// joints: of the robot. Keeps references to the groups.
  RobotDrives(const std::vector<Way>& ways, int joints);

  /// (command of the joints, time of the run's clock) => what each motor is wanted to do, through cranks and rods. Ages
  /// every reading by a cycle.
  void begin(const model::JointCommand& command, std::int64_t now_ns) noexcept;
  /// Some motor of the robot is told a gain or a torque: no drive is switched on, as it never jumps.
  bool stiff() const noexcept { return stiff_; }
  /// The robot's gains are others than in the cycle before: no drive waits for its command.
  bool urgent() const noexcept { return urgent_; }
  /// The time since the cycle before was longer than kPause_ns.
  bool paused() const noexcept { return paused_; }

  /// At the joint, or at the crank: before the motor's transmission.
  const MotorCommand& wanted(std::size_t group, std::size_t motor) const noexcept {
    return groups_[group].motors[motor].wanted;
  }
  MotorMonitor& monitor(std::size_t group, std::size_t motor) noexcept { return groups_[group].motors[motor].monitor; }
  const MotorMonitor& monitor(std::size_t group, std::size_t motor) const noexcept {
    return groups_[group].motors[motor].monitor;
  }
  /// Every request is answered, or given up.
  bool all_settled() const noexcept;

  /// (what the motors said) => (joints), through transmissions, cranks and rods.
  void read() noexcept;
  /// Of one group: the first motor that is lost, or a linkage whose motors' angles no joint angles belong to; else the
  /// first one that is late.
  MotorTrouble judge(std::size_t group) const noexcept;
  /// q, dq, tau, temperature_degC of every joint with a motor, and the age of the oldest reading.
  void fill(model::RobotState& state) const noexcept;

 private:
  template <int N>
  struct Linked {
    using Angles = typename RodLinkage<N>::Angles;
    const LinkedMotors<N>* setup = nullptr;
    Angles q_rad = Angles::Zero(), dq_rad_s = Angles::Zero(), theta_rad = Angles::Zero();  // of the last sample
    bool solved = true;  // the joint angles belong to the last motor angles
  };
  struct Motor {
    const MotorSetup* setup = nullptr;
    MotorMonitor monitor;
    MotorCommand wanted{};
    MotorReading joint{};  // what it said, at the joint
  };
  struct Group {
    std::vector<Motor> motors;
    std::vector<Linked<1>> four_bars;
    std::vector<Linked<2>> parallel;
  };
  template <int N>
  static void command_cranks(Group& group, const Linked<N>& linked) noexcept;
  template <int N>
  static void read_joints(Group& group, Linked<N>& linked) noexcept;
  static int unsolved(const Group& group) noexcept;

  std::vector<Group> groups_;
  int joints_;
  bool stiff_ = false, urgent_ = false, paused_ = false;
  JointVector kp_, kd_;  // of the last command
  std::int64_t last_begin_ns_ = 0;
};

}  // namespace pmg::drives
