#include "runtime/bench_session.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bench/bench_writer.hpp"
#include "files/nearest_name.hpp"
#include "files/result_folder.hpp"

namespace pmg::runtime {

void expect_no_policy(control::ControlSetup& setup) {
  if (setup.policy.empty()) setup.policy = "none";
  if (setup.policy != "none")
    throw std::invalid_argument("joints are excited without a policy (--bench, --excite); expected --policy none");
}

control::ExcitationPlan excitation_plan(const model::RobotModel& robot, const std::string& joint,
                                        const bench::Excitation& excitation, const hal::GuardOptions& guard) {
  const auto index = robot.joint_index.find(joint);
  if (!index) {
    throw std::invalid_argument(fmt::format("--bench {}: {} has no such joint; {}", joint, robot.name,
                                            files::expected_name(joint, robot.joint_index.names())));
  }
  control::ExcitationPlan plan;
  plan.joint = *index;
  for (const bench::ExcitationRow& row : excitation.rows) {
    plan.runs.push_back(
        {excitation.trajectory(row.trajectory).q_cmd_rad, row.gains.kp_Nm_per_rad, row.gains.kd_Nm_s_per_rad});
  }
  control::check(plan, robot, guard);
  return plan;
}

BenchSession::BenchSession(const model::RobotModel& robot, const std::string& joint,
                           const std::filesystem::path& excitation, const std::filesystem::path& out,
                           const control::TickOptions& options)
    : robot_(robot),
      folder_(excitation),
      out_(out),
      control_period_s_(options.dt_s),
      guard_(options.guard),
      excitation_(bench::read_excitation(excitation)),
      plan_(excitation_plan(robot, joint, excitation_, options.guard)) {
  if (std::abs(excitation_.rate_hz * control_period_s_ - 1.0) > 1e-6) {
    throw std::invalid_argument(fmt::format("{}: {} commands a second; expected {:g}, one a control tick",
                                            excitation.string(), excitation_.rate_hz, 1.0 / control_period_s_));
  }
  files::expect_unused(out, "a bench", {"bench.yaml"});
  load_ = model::hanging_load(robot, joint);
}

nlohmann::ordered_json BenchSession::json() const {
  return {{"joint", joint().name},
          {"excitation", folder_.string()},
          {"sha256", bench::excitation_sha256(folder_, excitation_)}};
}

double BenchSession::duration_s() const {
  const control::ExcitationPlayer::Told rest{joint().stand_rad, joint().kp_Nm_per_rad, joint().kd_Nm_s_per_rad};
  return control::ExcitationPlayer(plan_, robot_, rest, control_period_s_, guard_).duration_s();
}

ExcitationRecorder BenchSession::recorder() const {
  std::vector<std::size_t> samples;
  for (const control::ExcitationRun& run : plan_.runs) samples.push_back(run.q_cmd_rad.size());
  return {plan_.joint, std::move(samples)};
}

std::string BenchSession::write(const ExcitationRecorder& recorder) const {
  std::vector<bench::WrittenRun> runs;
  for (const RecordedRun& run : recorder.complete()) {
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

bool BenchSession::whole(const ExcitationRecorder& recorder) const {
  return recorder.complete().size() == excitation_.rows.size();
}

}  // namespace pmg::runtime
