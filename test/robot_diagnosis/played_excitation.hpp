// The controller's tick plays an excitation on a simulated robot, whatever bus its drives are on, and its log is as
// pmg_controller writes it.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "control/control_setup.hpp"
#include "hal/backend_json.hpp"
#include "io/log_writer.hpp"
#include "model/clip_library_file.hpp"
#include "recording/tick_log.hpp"
#include "runtime/robot_excitation_session.hpp"
#include "sil/lockstep.hpp"
#include "sil/simulated_robot.hpp"
#include "sim/robots.hpp"

namespace pmg::robot_diagnosis {

/// Z1 with these drives, and with sensor noise; it hangs or stands as the excitation of this name wants it.
inline sim::WorldOptions world_to_excite(const std::string& name, const sim::ActuatorsByJoint& motors) {
  sim::WorldOptions options = sil::world_with_noise(1, name == "hanging");
  options.motors = motors;
  return options;
}

/// How the controller reaches Z1.
struct ExcitedBus {
  hal::Hal& bus;
  sim::World& world;  ///< behind the bus
  std::string backend = "sil";
  hal::BackendLimits limits{};
  /// As the backend's. But the drives in that world take positions once a physics step, whatever stands here.
  hal::BackendDescription description{.command_delay_s = 0.0};
};

struct PlayedExcitation {
  std::filesystem::path log;
  std::string told;  ///< what people were told, line by line
  bool whole = false;
};

/// Plays the excitation once; ends when it is over, at the latest so long after the entry into Stand.
inline PlayedExcitation play_excitation(const std::string& name, const ExcitedBus& robot,
                                        const std::filesystem::path& folder, double duration_s = 80.0) {
  const ClipLibrary clips = model::load_clip_library(z1().directory / "clips", z1());
  control::TickOptions options = control::tick_options(z1());
  control::take_limits(robot.limits, options);
  options.robot_excitation =
      runtime::robot_excitation_plan(name, z1(), clips, options.guard, robot.description.own_gains);
  runtime::RobotExcitationSession session(name, *options.robot_excitation, options.dt_s);
  const io::SimulationClock clock;
  control::Tick tick(z1(), clips, std::make_unique<policy::ReferencePolicy>(), clock, options);

  hal::BackendDescription bus = robot.description;
  bus.drive_sampling_s = sim::WorldOptions{}.timestep_s;
  bus.set_on_simulator = robot.world.set_values();
  nlohmann::ordered_json header = {{"excite", session.json()}};
  hal::add_to(header, bus);
  PlayedExcitation played{.log = folder / (name + ".lcm"), .told = {}};
  io::LogWriter writer(played.log);
  recording::TickLog log(writer, z1(), {.robot = "z1", .backend = robot.backend, .options = header.dump()}, 100.0);

  sil::ScenarioStep stand;
  stand.duration_s = duration_s;
  const sil::Scenario scenario{.name = name, .steps = {stand}};
  sil::WorldPlant plant(robot.world);
  // Nothing but its own feet holds a robot that stands.
  sil::Lockstep lockstep(z1(), robot.bus, plant, tick, scenario, &log,
                         {.balanced_by_policy = true, .always_hoisted = name == "hanging"});
  bool over = false;
  lockstep.after_record = [&](const control::TickRecord& record) {
    const std::string news = session.news(record);
    if (!news.empty()) played.told += news + "\n";
    over = record.result.excitation.over;
  };
  lockstep.interrupted = [&] { return over; };
  lockstep.run();
  played.whole = session.whole();
  writer.flush();
  return played;
}

}  // namespace pmg::robot_diagnosis
