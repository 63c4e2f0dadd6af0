// A bench that is made of a robot: an excitation's files, the tick that plays them, and the bench that is written.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "bench/bench_writer.hpp"
#include "bench/excitation.hpp"
#include "control/tick.hpp"
#include "model/nearest_name.hpp"
#include "runtime/excitation_recorder.hpp"
#include "sim/joint_load.hpp"

namespace pmg::apps {

/// Every run of an excitation for this joint. Throws std::invalid_argument when the joint's range or gains forbid it.
inline control::ExcitationPlan excitation_plan(const model::RobotModel& robot, const std::string& joint,
                                               const bench::Excitation& excitation) {
  const auto index = robot.joint_index.find(joint);
  if (!index) {
    throw std::invalid_argument(fmt::format("--bench {}: {} has no such joint; {}", joint, robot.name,
                                            model::expected_name(joint, robot.joint_index.names())));
  }
  control::ExcitationPlan plan;
  plan.joint = *index;
  for (const bench::ExcitationRow& row : excitation.rows) {
    plan.runs.push_back(
        {excitation.trajectory(row.trajectory).q_cmd_rad, row.gains.kp_Nm_per_rad, row.gains.kd_Nm_s_per_rad});
  }
  control::check(plan, robot);
  return plan;
}

class BenchSession {
 public:
  /// Everything that input can spoil. Throws std::invalid_argument or model::ConfigError.
  BenchSession(const model::RobotModel& robot, const std::string& joint, const std::filesystem::path& excitation,
               const std::filesystem::path& out, double control_period_s)
      : robot_(robot),
        folder_(excitation),
        out_(out),
        excitation_(bench::read_excitation(excitation)),
        plan_(excitation_plan(robot, joint, excitation_)) {
    if (std::abs(excitation_.rate_hz * control_period_s - 1.0) > 1e-6) {
      throw std::invalid_argument(fmt::format("{}: {} commands a second; expected {:g}, one a control tick",
                                              excitation.string(), excitation_.rate_hz, 1.0 / control_period_s));
    }
    if (std::filesystem::exists(out / "bench.yaml")) {
      throw std::invalid_argument(out.string() + " holds a bench already; expected a new folder");
    }
    load_ = sim::hanging_load(robot, joint);
  }

  const control::ExcitationPlan& plan() const { return plan_; }
  const model::Joint& joint() const { return robot_.joints[static_cast<std::size_t>(plan_.joint)]; }
  /// What a log says of it, so that it can be replayed.
  nlohmann::ordered_json json() const {
    return {{"joint", joint().name},
            {"excitation", folder_.string()},
            {"sha256", bench::excitation_sha256(folder_, excitation_)}};
  }

  double duration_s(double control_period_s) const {
    return control::ExcitationPlayer(plan_, robot_, {joint().stand_rad, joint().kp_Nm_per_rad, joint().kd_Nm_s_per_rad},
                                     control_period_s)
        .duration_s();
  }

  runtime::ExcitationRecorder recorder() const {
    std::vector<std::size_t> samples;
    for (const control::ExcitationRun& run : plan_.runs) samples.push_back(run.q_cmd_rad.size());
    return {plan_.joint, std::move(samples)};
  }

  /// Writes what is complete, if anything is; says how many runs of how many.
  std::string write(const runtime::ExcitationRecorder& recorder) const {
    std::vector<bench::WrittenRun> runs;
    for (const runtime::RecordedRun& run : recorder.complete()) {
      const bench::ExcitationRow& row = excitation_.rows[static_cast<std::size_t>(run.run)];
      runs.push_back({row.file, row.trajectory, row.repeat, row.gains.kp_Nm_per_rad, row.gains.kd_Nm_s_per_rad, run.t_s,
                      run.q_cmd_rad, run.q_rad, run.dq_rad_s, run.torque_Nm, run.temp_C});
    }
    if (!runs.empty()) {
      bench::write_bench(
          out_,
          {.robot = robot_.name,
           .joint = joint().name,
           .design = fmt::format("{} of {} hanging, others hold the standing posture", joint().name, robot_.name),
           .sample_rate_hz = excitation_.rate_hz,
           .effort_limit_Nm = joint().effort_limit_Nm,
           .load_mass_kg = load_.mass_kg,
           .load = {load_.inertia_kg_m2, load_.gravity_Nm, load_.hangs_at_rad}},
          runs);
    }
    return fmt::format("{} of {} runs of {} recorded{}", runs.size(), excitation_.rows.size(), joint().name,
                       recorder.progress().given_up ? "; the robot left Stand, which ended it" : "");
  }

  bool whole(const runtime::ExcitationRecorder& recorder) const {
    return recorder.complete().size() == excitation_.rows.size();
  }

 private:
  const model::RobotModel& robot_;
  std::filesystem::path folder_, out_;
  bench::Excitation excitation_;
  control::ExcitationPlan plan_;
  sim::HangingLoad load_;
};

}  // namespace pmg::apps
