#include "sil/simulated_backend.hpp"

#include <memory>
#include <optional>
#include <stdexcept>

#include "sil/camera_stream.hpp"
#include "sil/driving_window.hpp"
#include "sil/simulated_robot.hpp"
#include "sim/motors_in_force.hpp"
#include "sim/set_values.hpp"
#include "sim/world.hpp"

namespace pmg::sil {

namespace {

class SimulatedBackend final : public hal::Backend {
 public:
  explicit SimulatedBackend(const hal::BackendSetup& setup)
      : setup_(setup),
        gantry_(option<bool>("gantry") || !setup.benched_joint.empty()),
        world_options_(world_with_noise(option<std::uint64_t>("seed"), true)) {
    world_options_.motors = sim::motors_in_force(setup.robot, option<std::string>("motor"));
    world_options_.benched_joint = setup.benched_joint;
    if (option<bool>("viewer") && option<bool>("camera"))
      throw std::invalid_argument("--camera and --viewer: expected one of them (a window draws by another OpenGL)");
  }

  hal::OptionValues configuration() const override {
    hal::OptionValues values = setup_.options;
    values.at("gantry") = gantry_;
    return values;
  }
  hal::BackendLimits limits() const override {
    return option<bool>("robot-limits") ? hal::BackendLimits{} : limits_on_shared_host();
  }

  hal::BackendDescription description() const override {
    // Simulated drives read positions once a physics step.
    return {.drive_sampling_s = world_options_.timestep_s,
            .command_delay_s = 0.0,
            .older_joints = {},
            .closed_by_bus = {},
            .own_gains = {},
            .set_on_simulator = sim::set_values(setup_.robot, world_options_)};
  }

  hal::Hal& connect(const std::function<bool()>& /*interrupted*/) override {
    world_.emplace(setup_.robot, world_options_);
    robot_.emplace(*world_, gantry_ ? HoistedBy::kGantry : HoistedBy::kCrane, setup_.keeps_truth);
    if (option<bool>("viewer")) window_.emplace(world_->mj_model(), *robot_, setup_.name, setup_.lcm_url);
    if (option<bool>("camera"))
      camera_.emplace(world_->mj_model(), setup_.robot.torso_link, *robot_, setup_.name, setup_.lcm_url, setup_.clock);
    return *robot_;
  }

  std::string news() override { return camera_ ? camera_->take_failure() : std::string(); }
  hal::HoistLine* hoist() noexcept override { return robot_->hoist_line(); }
  hal::Window* window() noexcept override { return window_ ? &*window_ : nullptr; }
  const hal::TruthSample* take_truth(std::uint64_t bus_sample) noexcept override {
    return robot_->take_truth(bus_sample);
  }

 private:
  template <typename Value>
  const Value& option(const char* name) const {
    return std::get<Value>(setup_.options.at(name));
  }

  hal::BackendSetup setup_;
  bool gantry_;
  sim::WorldOptions world_options_;
  std::optional<sim::World> world_;
  std::optional<SimulatedRobot> robot_;
  std::optional<DrivingWindow> window_;
  std::optional<CameraStream> camera_;
};

}  // namespace

void register_backend(hal::BackendFactory& factory) {
  factory.add(
      {.name = "sil",
       .summary = "MuJoCo in their place",
       .options =
           {{"gantry", "hang the robot in a gantry for ever; otherwise a hoist sets it down when it stands", false},
            {"viewer", "a window with the robot, whose keys drive it", false},
            {"camera", "send what the head's camera shows, ten pictures a second, for pmg_web --camera", false},
            {"motor", "motor.yaml, how the drives really are; robot.yaml's if not given, none for none", std::string()},
            {"robot-limits", "judge old states and late ticks as on a robot, and wait for no late controller", false},
            {"seed", "of the sensor noise", std::uint64_t{0}}},
       .make = [](const hal::BackendSetup& setup) { return std::make_unique<SimulatedBackend>(setup); }});
}

}  // namespace pmg::sil
