// A bench that is made of a robot: an excitation's files, the tick that plays them, and the bench that is written.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bench/excitation.hpp"
#include "control/control_setup.hpp"
#include "control/excitation_player.hpp"
#include "model/hanging_load.hpp"
#include "runtime/excitation_recorder.hpp"

namespace pmg::runtime {

/// No policy balances a robot while a joint is excited: a setup that names none gets `none`. Throws
/// std::invalid_argument when it names one.
void expect_no_policy(control::ControlSetup& setup);

/// (robot, joint, excitation) => a run of the tick for every row of the excitation. Throws std::invalid_argument when
/// the joint's range or the bus guard forbids a row.
control::ExcitationPlan excitation_plan(const model::RobotModel& robot, const std::string& joint,
                                        const bench::Excitation& excitation, const hal::GuardOptions& guard = {});

class BenchSession {
 public:
  /// Reads and checks the excitation's folder and that out is no bench yet. Keeps a reference to robot. Throws
  /// std::invalid_argument or files::ConfigError.
  BenchSession(const model::RobotModel& robot, const std::string& joint, const std::filesystem::path& excitation,
               const std::filesystem::path& out, const control::TickOptions& options);

  const control::ExcitationPlan& plan() const { return plan_; }
  const model::Joint& joint() const { return robot_.joints[static_cast<std::size_t>(plan_.joint)]; }
  /// What a log says of it, so that it can be replayed.
  nlohmann::ordered_json json() const;
  double duration_s() const;  ///< of all runs, in Stand

  /// Feed it every tick's record.
  ExcitationRecorder recorder() const;

  /// (recorded runs) => the folder's bench.yaml, runs.csv and runs/, of the complete runs if there are any. Returns how
  /// many of how many, in words. Throws std::runtime_error when a file can't be written.
  std::string write(const ExcitationRecorder& recorder) const;
  bool whole(const ExcitationRecorder& recorder) const;  ///< every run is complete

 private:
  const model::RobotModel& robot_;
  std::filesystem::path folder_, out_;
  double control_period_s_;
  hal::GuardOptions guard_;
  bench::Excitation excitation_;
  control::ExcitationPlan plan_;
  model::HangingLoad load_;
};

}  // namespace pmg::runtime
