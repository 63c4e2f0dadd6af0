// A simulated robot led by a headset: (what a headset says) => the code behind pmg_web's socket, the network, the
// controller, MuJoCo, in lockstep with one clock.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "arms_operator/arms_board.hpp"
#include "control/control_cycle.hpp"
#include "control/control_setup.hpp"
#include "hal/bus_cycle.hpp"
#include "io/clock.hpp"
#include "io/lcm_link.hpp"
#include "operator/mode_wish.hpp"
#include "operator/robot_board.hpp"
#include "operator/robot_driver.hpp"
#include "runtime/comms.hpp"
#include "sil/sil_hal.hpp"
#include "sim/world.hpp"
#include "vr/vr_command.hpp"

namespace pmg::teleoperation {

/// Whether both arms of this robot can be led. Its palms become boxes in a world: friction 0.8.
std::vector<sim::HandBox> palm_boxes(const model::RobotModel& robot);

/// Messages travel within the tick in which they are sent; what a network adds is the headset's affair.
class LedRobot {
 public:
  static constexpr const char* kName = "robot";

  /// Keeps a reference to loaded, whose policy it takes. Throws what loading throws.
  LedRobot(control::LoadedControl& loaded, const sim::WorldOptions& world);

  /// One tick of 10 ms. news: what the headset says; null: nothing.
  void step(const vr::VrNews* news);
  void ask_for_stand();  ///< as the button on its page does

  std::int64_t now_ns() const noexcept { return clock_.now_ns(); }
  double time_s() const noexcept { return static_cast<double>(now_ns()) * 1e-9; }

  // What its page tells the operator:
  std::optional<std::int8_t> mode() const;  ///< pmg_msgs::mode_t's
  bool driving() const noexcept { return driver_.driving(); }
  std::string text() const;  ///< why it doesn't move
  const ops::HeardArms* arms() const { return arms_.of(kName); }

  // For a judge alone:
  const model::RobotModel& model() const noexcept { return model_; }
  const control::TickResult& result() const noexcept { return cycle_.record().result; }
  sim::World& world() noexcept { return world_; }
  const sim::World& world() const noexcept { return world_; }
  void set_hoist(double engaged) noexcept { world_.set_hoist(0.0, engaged); }

 private:
  const model::RobotModel& model_;
  recording::RunInfo run_{.robot = kName, .session = 1};
  io::SimulationClock clock_;
  io::LcmLink link_{"memq://"};
  sim::World world_;
  sil::SilHal bus_;
  hal::BusLink bus_link_;
  control::OperatorInbox inbox_{bus_link_.stop};
  control::ControllerOutbox outbox_;
  runtime::Comms comms_;
  std::unique_ptr<control::Tick> tick_;
  hal::BusCycle bus_cycle_;
  control::ControlCycle cycle_;
  ops::RobotBoard board_{link_, clock_};
  ops::ArmsBoard arms_{link_, clock_};
  vr::VrCommand headset_{-1};
  ops::OperatorSource source_{link_, "vr.1", 1, clock_};
  ops::RobotDriver driver_{source_, kName, headset_};
  std::optional<ops::ModeWish> stand_;
};

}  // namespace pmg::teleoperation
