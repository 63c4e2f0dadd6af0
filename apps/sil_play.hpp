// Plays a scenario in lockstep or with the robot's threads.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "control/control_setup.hpp"
#include "control/tick.hpp"
#include "io/log_writer.hpp"
#include "program.hpp"
#include "runtime/bench_session.hpp"
#include "runtime/excitation_recorder.hpp"
#include "sil/failing_parts.hpp"
#include "sil/live_view.hpp"
#include "sil/lockstep.hpp"
#include "sil_arguments.hpp"
#include "sim/world.hpp"

namespace pmg::apps {

/// Outcome of a played scenario.
struct Played {
  sil::RunOutcome outcome;
  sil::StageTiming timing;
  nlohmann::ordered_json realtime;                // null in lockstep
  std::string film_failure;                       // empty: none, or no film
  std::vector<sil::FailureReaction> reactions{};  // one for each failure that was injected
};

/// Inputs of both ways of playing.
struct Stage {
  const SilArguments& arguments;
  const control::LoadedControl& loaded;
  const sil::Scenario& scenario;
  sim::World& world;
  io::LogWriter& log_file;
  control::Tick& tick;
  sil::LiveView* view;                      // may be null
  const runtime::BenchSession* bench;       // may be null
  runtime::ExcitationRecorder* excitation;  // null without a bench
  const std::vector<sil::Failure>& failures;
  sil::FailureClock& failure_clock;
  bool over() const { return interrupt_requested != 0 || (view != nullptr && view->closed()); }
  bool balanced_by_policy() const { return arguments.control.policy != "none"; }
};

/// (stage) => (outcome). Lockstep: on the simulation's clock, in this thread.
Played play_lockstep(const Stage& stage);
/// (stage) => (outcome). Real time: on the wall clock; without a scenario, operators drive over the network.
Played play_realtime(const Stage& stage);

}  // namespace pmg::apps
