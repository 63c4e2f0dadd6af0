#include "evaluation/yardstick.hpp"

#include <Eigen/Geometry>
#include <limits>
#include <utility>

#include "control/control_cycle.hpp"
#include "evaluation/step_measure.hpp"
#include "gco/motion_composition.hpp"
#include "pmg/command_limiter.hpp"

namespace pmg::evaluation {

namespace {

/// A body that moves exactly as commanded: v, omega, pitch, roll and height are the command's.
class IdealRobot {
 public:
  explicit IdealRobot(double standing_height_m) : standing_height_m_(standing_height_m) {}

  model::GroundTruth move(const Command& command) {
    yaw_rad_ += command[kOmega] * control::ControlCycle::kPeriod_s;
    const Eigen::AngleAxisd turn(yaw_rad_, Eigen::Vector3d::UnitZ());
    model::GroundTruth truth;
    truth.p_WB.z() = standing_height_m_ + command[kHeight];
    truth.q_WB = turn;
    truth.v_WB_W = turn * Eigen::Vector3d(command[kVx], command[kVy], 0.0);
    truth.omega_WB_B.z() = command[kOmega];
    truth.q_WT = turn * Eigen::AngleAxisd(command[kPitch], Eigen::Vector3d::UnitY()) *
                 Eigen::AngleAxisd(command[kRoll], Eigen::Vector3d::UnitX());
    return truth;
  }

 private:
  double standing_height_m_;
  double yaw_rad_ = 0.0;
};

}  // namespace

Yardstick yardstick(const Candidate& candidate, const sil::Scenario& scenario, const work::Progress& progress) {
  const model::RobotModel robot = control::load_robot(candidate.control);
  const GeneratorOptions options = gco::generator_options(robot);
  StepMeasure nothing(robot, scenario), follower(robot, scenario);
  IdealRobot still(robot.standing_height_m), moving(robot.standing_height_m);
  CommandLimiter limiter(options.limits, options.double_support_rate, options.stop_within_s, options.turn_s);
  double double_support = 1.0;
  const auto judge = [&](const sil::RunProgress& now, sim::World&) {
    const Command asked = now.result.mode == control::Mode::kWalk ? now.step.command : Command{};
    const Command& limited = limiter.step(asked, double_support, control::ControlCycle::kPeriod_s);
    const PerFoot<double>& weight = now.result.reference.contact_weight;
    double_support = weight[kLeft] * weight[kRight];
    nothing.add(now.time_s, now.result, still.move({}), false, now.step);
    follower.add(now.time_s, now.result, moving.move(limited), false, now.step);
    return true;
  };
  Candidate hanging = candidate;
  hanging.control.policy = "none";  // no policy runs in the air
  const TrialResult hung = run_trial(hanging, scenario, {}, {.gantry = true, .progress = progress, .observer = judge});
  Yardstick result;
  nothing.report(result.nothing);
  follower.report(result.follower);
  result.nothing.complete = result.follower.complete = hung.complete;
  return result;
}

Yardstick mean(const std::vector<Yardstick>& all) {
  const auto mean_of = [&](TrialResult Yardstick::*end) {
    TrialResult mean;
    mean.complete = true;
    for (const Yardstick& one : all) {
      const TrialResult& run = one.*end;
      mean.complete = mean.complete && run.complete;
      for (std::size_t e = 0; e < kErrors; ++e) {
        mean.errors[e] += run.errors[e] / static_cast<double>(all.size());
        mean.errors_raw[e] += run.errors_raw[e] / static_cast<double>(all.size());
      }
    }
    return mean;
  };
  return {.nothing = mean_of(&Yardstick::nothing), .follower = mean_of(&Yardstick::follower)};
}

Errors share_left(const Errors& errors, const Yardstick& between) {
  Errors share{};
  for (std::size_t e = 0; e < kErrors; ++e) {
    const double span = between.nothing.errors[e] - between.follower.errors[e];
    share[e] = span > 0.0 ? (errors[e] - between.follower.errors[e]) / span : std::numeric_limits<double>::quiet_NaN();
  }
  return share;
}

}  // namespace pmg::evaluation
