// Random operators, random sensors, random stalls: whatever comes, the drives get finite commands within their clamps,
// a fault stays latched, and a stop stops.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <random>

#include "control_rig.hpp"

namespace pmg::runtime {
namespace {

constexpr std::uint64_t kSeed = 20241;
constexpr int kSequences = 2000;

class Chaos {
 public:
  using How = test::BreakablePolicy::Break;

  explicit Chaos(test::ControlRig& rig) : rig_(rig) {}

  template <typename Values>
  auto pick(const Values& values) {
    return values[static_cast<std::size_t>(below(static_cast<int>(values.size())))];
  }
  /// One random thing goes wrong, or somebody says something.
  void strike() {
    switch (below(12)) {
      case 0:
        say_something();
        break;
      case 1:
      case 2:
        ask_something();
        break;
      case 3:
        rig_.bus.status = static_cast<hal::BusStatus>(below(3));
        break;
      case 4:
        spoil_a_sensor();
        break;
      case 5:
        rig_.policy->how = pick(std::array{How::kNone, How::kStatus, How::kNan, How::kLate, How::kFarAction});
        break;
      case 6:
        rig_.policy->meanwhile = [this, cycles = below(9)] { stall(cycles); };
        break;
      case 7:
        rig_.control_frozen = !rig_.control_frozen;
        break;
      case 8:
        rig_.bus_frozen = !rig_.bus_frozen;
        break;
      case 9:
        rig_.control_delay_cycles = below(8);
        break;
      case 10:
        rig_.clock.advance_to(rig_.clock.now_ns() + below(200) * 1'000'000);
        break;
      default:
        corrupt_the_link();
        break;
    }
  }
  void heal() {
    rig_.bus.status = hal::BusStatus::kOk;
    rig_.bus.spoil = nullptr;
    rig_.policy->how = How::kNone;
    rig_.policy->meanwhile = nullptr;
    rig_.control_frozen = rig_.bus_frozen = rig_.silent = false;
    rig_.control_delay_cycles = 0;
    rig_.drive.command = Command{};
  }
  int below(int count) { return static_cast<int>(random_() % static_cast<std::uint64_t>(count)); }

  bool reset_asked = false;  ///< since somebody last cleared it

 private:
  double any_number() {
    const double plain = 4.0 * (static_cast<double>(random_() >> 11) * 0x1p-53 - 0.5);
    return pick(std::array{plain, plain, plain, 0.0, 1e9, -1e308, 1e-310, std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::quiet_NaN()});
  }
  std::int64_t any_integer() {
    return pick(std::array<std::int64_t, 6>{0, 1, -1, below(1000), std::numeric_limits<std::int64_t>::max(),
                                            std::numeric_limits<std::int64_t>::min()});
  }
  Source any_source() {
    if (below(3) == 0) return rig_.drive.source;
    return Source::make(std::to_string(below(12)), any_integer());
  }
  void stall(int cycles) {
    for (int k = 0; k < cycles; ++k) rig_.world();
  }
  void say_something() {
    for (double& value : rig_.drive.command.u) value = any_number();
    rig_.silent = below(4) == 0;
    DriveMessage stranger{.source = any_source(),
                          .sequence = any_integer(),
                          .stamp_ns = any_integer(),
                          .received_ns = any_integer(),
                          .lease_s = 0.02 * any_number(),
                          .command = rig_.drive.command};
    rig_.inbox.put(stranger);
  }
  void ask_something() {
    const bool reset = below(3) == 0;
    const auto mode = static_cast<Mode>(below(6));
    reset_asked = reset_asked || reset;
    if (below(2) == 0) {
      rig_.ask(rig_.drive.source, mode, reset);
      return;
    }
    rig_.inbox.put(ModeRequest{.source = any_source(),
                               .sequence = any_integer(),
                               .stamp_ns = any_integer(),
                               .received_ns = any_integer(),
                               .mode = mode,
                               .reset_fault = reset});
  }
  void spoil_a_sensor() {
    rig_.bus.spoil = [which = below(8), joint = below(10), value = any_number()](model::RobotState& state) {
      switch (which) {
        case 0:
          state.q[joint] = value;
          break;
        case 1:
          state.dq[joint] = value;
          break;
        case 2:
          state.tau[joint] = value;
          break;
        case 3:
          state.temperature_degC[joint] = value;
          break;
        case 4:
          state.gyro_rad_s[joint % 3] = value;
          break;
        case 5:
          state.acceleration_m_s2[joint % 3] = value;
          break;
        case 6:
          state.orientation_WI.coeffs()[joint % 4] = value;
          break;
        default:
          state.q.conservativeResize(joint);
          break;
      }
    };
  }
  void corrupt_the_link() {
    hal::ControlOutput output;
    output.joints = rig_.tick.result().command;
    output.stops_seen = rig_.link.stop.pulls();
    output.trips_seen = rig_.bus_cycle.guard().trips();
    for (JointVector* values :
         {&output.joints.q, &output.joints.dq, &output.joints.kp, &output.joints.kd, &output.joints.tau_ff}) {
      (*values)[below(static_cast<int>(values->size()))] = any_number();
    }
    if (below(4) == 0) output.joints.kd.conservativeResize(below(5));
    rig_.link.commands.put(output);
    corrupted_in = rig_.cycles;
  }

 public:
  int corrupted_in = -1;  ///< cycle before which the link was corrupted: its command comes from nobody

 private:
  test::ControlRig& rig_;
  std::mt19937_64 random_{kSeed};
};

TEST(Fuzz, CommandsStayFiniteAndWithinTheirClampsAndFaultsStayLatched) {
  const model::RobotModel& robot = test::biped();
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  test::ControlRig rig(robot);
  Chaos chaos(rig);
  const JointVector lower = robot.q_lower(), upper = robot.q_upper();
  const hal::GuardOptions guard;
  std::int64_t broken = 0, beyond = 0, unlatched = 0, undamped = 0;
  std::array<int, kFaultCodes> seen{};
  std::array<int, 5> modes{};
  Mode mode = Mode::kPassive;
  int fault_since = -1;  // cycle after which the tick latched

  rig.after_cycle = [&] {
    const model::JointCommand& command = rig.bus.last_command;
    if (rig.bus.exchanges == 0) return;
    broken += rig.bus.finite() ? 0 : 1;
    beyond += ((command.q - lower).minCoeff() >= 0.0 && (upper - command.q).minCoeff() >= 0.0 &&
               command.kp.minCoeff() >= 0.0 && command.kp.maxCoeff() <= guard.max_kp_Nm_per_rad &&
               command.kd.minCoeff() >= 0.0 && command.kd.maxCoeff() <= guard.max_kd_Nm_s_per_rad)
                  ? 0
                  : 1;
    const bool latched_before = fault_since >= 0 && rig.cycles > fault_since;
    if (latched_before && mode == Mode::kFault && rig.tick.result().mode == Mode::kFault && !rig.bus_frozen &&
        chaos.corrupted_in < fault_since) {
      undamped += rig.bus.damping() ? 0 : 1;
    }
  };
  rig.drive.lease_s = 0.02;
  const auto run = [&](int cycles) {
    for (int cycle = 0; cycle < cycles; ++cycle) {
      rig.cycle();
      const Mode now = rig.tick.result().mode;
      if (mode == Mode::kFault && now != Mode::kFault) {
        unlatched += now == Mode::kDamping && chaos.reset_asked ? 0 : 1;
        chaos.reset_asked = false;
      }
      if (now == Mode::kFault && mode != Mode::kFault) {
        fault_since = rig.cycles;
        ++seen[static_cast<std::size_t>(rig.fault())];
      }
      mode = now;
      ++modes[static_cast<std::size_t>(now)];
    }
  };
  for (int sequence = 0; sequence < kSequences; ++sequence) {
    chaos.heal();
    // Whoever was impersonated with the highest of all sequence numbers starts anew.
    ++rig.drive.source.session;
    if (chaos.below(2) == 0) {
      run(25);
      rig.reset();
      chaos.reset_asked = true;
    }
    if (chaos.below(2) == 0) rig.ask(Mode::kWalk);
    if (chaos.below(3) == 0) run(400);  // time for a ramp into Stand
    const int strikes = 1 + chaos.below(4);
    for (int k = 0; k < strikes; ++k) {
      run(chaos.below(25));
      chaos.strike();
    }
  }
  EXPECT_EQ(broken, 0);
  EXPECT_EQ(beyond, 0);
  EXPECT_EQ(unlatched, 0);
  EXPECT_EQ(undamped, 0);
  EXPECT_GE(std::ranges::count_if(seen, [](int count) { return count > 0; }), 10) << "kinds of faults: it must bite";
  for (const int count : modes) EXPECT_GT(count, 100) << "and visit every mode";
}

}  // namespace
}  // namespace pmg::runtime
