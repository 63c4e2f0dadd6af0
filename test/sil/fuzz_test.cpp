// Random operators, sensors and stalls: in every case the drives get finite commands within their clamps, a fault stays
// latched, and a stop stops.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <random>

#include "control/control_rig.hpp"

namespace pmg::sil {
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
  /// One random failure or operator message.
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
        rig_.policy->how = pick(std::array{How::kNone, How::kStatus, How::kNotANumber, How::kLate, How::kFarAction});
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

  bool reset_asked = false;  ///< since the last clearing

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
  control::Source any_source() {
    if (below(3) == 0) return rig_.drive.source;
    return control::Source::make(std::to_string(below(12)), any_integer());
  }
  void stall(int cycles) {
    for (int k = 0; k < cycles; ++k) rig_.world();
  }
  void say_something() {
    for (double& value : rig_.drive.command.u) value = any_number();
    rig_.silent = below(4) == 0;
    control::DriveMessage stranger{.source = any_source(),
                                   .sequence = any_integer(),
                                   .stamp_ns = any_integer(),
                                   .received_ns = any_integer(),
                                   .lease_s = 0.02 * any_number(),
                                   .command = rig_.drive.command};
    rig_.inbox.put(stranger);
  }
  void ask_something() {
    const bool reset = below(3) == 0;
    const auto mode = static_cast<control::Mode>(below(6));
    reset_asked = reset_asked || reset;
    if (below(2) == 0) {
      rig_.ask(rig_.drive.source, mode, reset);
      return;
    }
    rig_.inbox.put(control::ModeRequest{.source = any_source(),
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
  int corrupted_in = -1;  ///< cycle before which the link was corrupted: no tick gave its command

 private:
  test::ControlRig& rig_;
  std::mt19937_64 random_{kSeed};
};

/// The invariants; counts violations.
class Watch {
 public:
  Watch(const model::RobotModel& robot, test::ControlRig& rig, Chaos& chaos)
      : rig_(rig), chaos_(chaos), lower_(robot.q_lower()), upper_(robot.q_upper()) {
    speed_.resize(lower_.size());
    effort_.resize(lower_.size());
    for (Eigen::Index i = 0; i < lower_.size(); ++i) {
      speed_[i] = robot.joints[static_cast<std::size_t>(i)].velocity_limit_rad_s;
      effort_[i] = robot.joints[static_cast<std::size_t>(i)].effort_limit_Nm;
    }
  }

  void after_bus_cycle() {
    if (rig_.bus.exchanges == 0) return;
    if (!rig_.bus.finite()) ++not_finite;
    if (!within_clamps(rig_.bus.last_command)) ++beyond_clamps;
    const bool in_fault =
        mode_ == control::Mode::kFault && rig_.mode() == control::Mode::kFault && rig_.cycles > fault_since_;
    const bool foreign = chaos_.corrupted_in >= fault_since_;  // a command that no tick gave
    if (in_fault && !foreign && !rig_.bus_frozen && !rig_.bus.damping() && !rig_.sits()) ++undamped;
    sat_cycles_ = in_fault && !rig_.bus.damping() ? sat_cycles_ + 1 : 0;
    if (sat_cycles_ > kLongestSitDown) ++sat_too_long;
  }
  void after_tick() {
    const control::Mode now = rig_.mode();
    if (mode_ == control::Mode::kFault && now != control::Mode::kFault) {
      if (now != control::Mode::kDamping || !chaos_.reset_asked) ++unlatched;
      chaos_.reset_asked = false;
    }
    if (mode_ != control::Mode::kFault && now == control::Mode::kFault) {
      fault_since_ = rig_.cycles;
      ++faults[static_cast<std::size_t>(rig_.fault())];
    }
    mode_ = now;
    ++modes[static_cast<std::size_t>(now)];
  }

  int not_finite = 0, beyond_clamps = 0, undamped = 0, unlatched = 0, sat_too_long = 0;
  std::array<int, faults::kFaultCodes> faults{};
  std::array<int, 5> modes{};

 private:
  bool within_clamps(const model::JointCommand& command) const {
    const auto within = [](const JointVector& values, const JointVector& least, const JointVector& most) {
      return (values - least).minCoeff() >= 0.0 && (most - values).minCoeff() >= 0.0;
    };
    const hal::GuardOptions guard;
    const JointVector none = JointVector::Zero(lower_.size()), all = JointVector::Ones(lower_.size());
    return within(command.q, lower_, upper_) && within(command.dq, -speed_, speed_) &&
           within(command.tau_ff, -effort_, effort_) && within(command.kp, none, guard.max_kp_Nm_per_rad * all) &&
           within(command.kd, none, guard.max_kd_Nm_s_per_rad * all);
  }

  test::ControlRig& rig_;
  Chaos& chaos_;
  JointVector lower_, upper_, speed_, effort_;
  control::Mode mode_ = control::Mode::kPassive;
  static constexpr int kLongestSitDown =
      520;  // 0.95 s, a late tick, and what the guard needs when the control thread freezes
  int sat_cycles_ = 0;
  int fault_since_ = 0;  // cycle after which the tick latched
};

TEST(Fuzz, CommandsStayFiniteAndWithinTheirClampsAndFaultsStayLatched) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  test::ControlRig rig(test::biped());
  rig.drive.lease_s = 0.02;
  Chaos chaos(rig);
  Watch watch(test::biped(), rig, chaos);
  rig.after_cycle = [&] { watch.after_bus_cycle(); };
  const auto run = [&](int cycles) {
    for (int cycle = 0; cycle < cycles; ++cycle) {
      rig.cycle();
      watch.after_tick();
    }
  };
  for (int sequence = 0; sequence < kSequences; ++sequence) {
    chaos.heal();
    // A source that was impersonated with the highest sequence number starts a new session.
    ++rig.drive.source.session;
    if (chaos.below(2) == 0) {
      run(25);
      rig.reset();
      chaos.reset_asked = true;
    }
    if (chaos.below(2) == 0) rig.ask(control::Mode::kWalk);
    if (chaos.below(3) == 0) run(400);  // time for a ramp into Stand
    const int strikes = 1 + chaos.below(4);
    for (int k = 0; k < strikes; ++k) {
      run(chaos.below(25));
      chaos.strike();
    }
  }
  EXPECT_EQ(watch.not_finite, 0);
  EXPECT_EQ(watch.beyond_clamps, 0);
  EXPECT_EQ(watch.undamped, 0);
  EXPECT_EQ(watch.unlatched, 0);
  EXPECT_EQ(watch.sat_too_long, 0);
  EXPECT_GE(std::ranges::count_if(watch.faults, [](int count) { return count > 0; }), 10) << "kinds: it must bite";
  for (const int count : watch.modes) EXPECT_GT(count, 100) << "and visit every mode";
}

}  // namespace
}  // namespace pmg::sil
