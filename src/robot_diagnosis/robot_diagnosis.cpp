#include "robot_diagnosis/robot_diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "pmg/types.hpp"

namespace pmg::robot_diagnosis {

namespace {

constexpr double kSample_s = 0.05;  // SampleOptions::ticks_per_sample control ticks of 10 ms

/// (support of each sample) => (the same, but kLoose for `settle` samples on each side of a change): no equation here
/// holds during landing, lifting or the first slip.
std::vector<Support> without_transitions(const std::vector<Support>& seen, std::size_t settle) {
  std::vector<Support> result = seen;
  for (std::size_t i = 1; i < seen.size(); ++i) {
    if (seen[i] == seen[i - 1]) continue;
    const std::size_t from = i > settle ? i - settle : 0, to = std::min(i + settle, seen.size());
    for (std::size_t k = from; k < to; ++k) result[k] = Support::kLoose;
  }
  return result;
}

/// Support of each tick: that of the nearest sample.
std::vector<Support> supports_of_ticks(const RobotRecording& recording, std::span<const RobotSample> samples,
                                       std::span<const Support> supports) {
  std::vector<Support> result;
  std::size_t nearest = 0;
  for (const RobotTick& tick : recording.ticks) {
    while (nearest + 1 < samples.size() &&
           std::abs(samples[nearest + 1].t_s - tick.t_s) < std::abs(samples[nearest].t_s - tick.t_s))
      ++nearest;
    result.push_back(supports[nearest]);
  }
  return result;
}

/// Accelerometer readings without the torque ripple's share. Ticks with standing on both sides stay as they are.
std::vector<Eigen::Vector3d> smooth_readings(RobotEquations& equations, const RobotRecording& recording,
                                             std::span<const Support> supports) {
  const std::vector<JointVector> ripple_Nm = torque_ripple(recording);
  std::vector<Eigen::Vector3d> readings_I;
  for (std::size_t k = 0; k < recording.ticks.size(); ++k) {
    const model::RobotState& state = recording.ticks[k].state;
    readings_I.emplace_back(state.acceleration_m_s2);
    if (supports[k] != Support::kStanding || (k > 0 && supports[k - 1] != Support::kStanding))
      readings_I.back() -= equations.accelerometer_share(state.q, ripple_Nm[k]);
  }
  return readings_I;
}

/// Mean specific force between two ticks while both soles rest, from the legs' kinematics [m/s^2, IMU axes]. Joint
/// speeds at both ends give the exact mean acceleration; an accelerometer that is read once a tick does not.
Eigen::Vector3d specific_force_of_legs(RobotEquations& equations, const model::RobotState& at,
                                       const model::RobotState& after, double period_s) {
  const auto up_I = [](const model::RobotState& s) -> Eigen::Vector3d {
    return s.orientation_WI.conjugate() * Eigen::Vector3d::UnitZ();
  };
  const Eigen::Vector3d from_m_s = equations.imu_velocity_on_resting_soles(at),
                        to_m_s = equations.imu_velocity_on_resting_soles(after);
  const Eigen::Vector3d omega_rad_s = 0.5 * (at.gyro_rad_s + after.gyro_rad_s);
  return (to_m_s - from_m_s) / period_s + omega_rad_s.cross(0.5 * (from_m_s + to_m_s)) +
         0.5 * kGravity_m_s2 * (up_I(at) + up_I(after));
}

/// Mean specific force between every tick and the next one [m/s^2, IMU axes].
std::vector<Eigen::Vector3d> specific_forces(RobotEquations& equations, const RobotRecording& recording,
                                             std::span<const Support> supports) {
  const std::vector<Eigen::Vector3d> readings_I = smooth_readings(equations, recording, supports);
  std::vector<Eigen::Vector3d> forces_I;
  for (std::size_t k = 0; k + 1 < recording.ticks.size(); ++k) {
    const model::RobotState &at = recording.ticks[k].state, &after = recording.ticks[k + 1].state;
    forces_I.push_back(supports[k] == Support::kStanding
                           ? specific_force_of_legs(equations, at, after, recording.period_s)
                           : mean_of_readings(readings_I[k], readings_I[k + 1],
                                              recording.drive.acceleration_share(recording.period_s)));
  }
  return forces_I;
}

/// One diagnosis: recordings => samples => supports => equations => evidence => verdict.
class RobotDiagnosisRun {
 public:
  RobotDiagnosisRun(const model::RobotModel& robot, const RobotDiagnosisOptions& options,
                    const work::Progress& progress)
      : robot_(robot),
        options_(options),
        progress_(progress),
        list_(robot_parameters(robot, options.tolerances, options.causes)),
        equations_(robot, list_, options.support) {
    result_.options = options;
  }

  RobotDiagnosis run(std::span<const RobotRecording> recordings) {
    const auto total = std::accumulate(recordings.begin(), recordings.end(), std::size_t{0},
                                       [](std::size_t n, const RobotRecording& r) { return n + r.ticks.size(); });
    for (const RobotRecording& recording : recordings) take(recording, static_cast<double>(total));
    result_.ground = ground_friction(equations_, samples_, robot_.total_mass_kg * kGravity_m_s2, options_.ground);
    conclude(find_causes(blocks_, equations_.kinds(), list_, options_.evidence));
    return std::move(result_);
  }

 private:
  SampleOptions sampling(SampleOptions of, double low_pass_s) const {
    of.low_pass_s = low_pass_s;
    of.direction_low_pass_s = options_.direction_low_pass_s;
    of.turning_rad_s = options_.turning_rad_s;
    return of;
  }
  SampleOptions sampling(SampleOptions of) const { return sampling(of, options_.low_pass_s); }

  void take(const RobotRecording& recording, double total_ticks) {
    const std::string from = fmt::format("{}: {}", recording.name, source_text(recording.source));
    if (std::ranges::find(result_.recordings, from) == result_.recordings.end()) result_.recordings.push_back(from);
    const std::string drives = drive_sampling_text(recording.drive);
    if (result_.drive_sampling.find(drives) == std::string::npos)
      result_.drive_sampling += (result_.drive_sampling.empty() ? "" : "; ") + drives;
    const std::vector<RobotSample> crude = robot_samples(recording, sampling({}));
    std::vector<Support> seen;
    for (const RobotSample& sample : crude) seen.push_back(equations_.support(sample));
    const std::vector<Support> supports = without_transitions(seen, static_cast<std::size_t>(options_.settle_samples));
    const std::vector<Eigen::Vector3d> forces_I =
        specific_forces(equations_, recording, supports_of_ticks(recording, crude, supports));
    const std::vector<RobotSample> lively = robot_samples(recording, sampling({.specific_force_I = forces_I})),
                                   calm = robot_samples(recording, sampling({.specific_force_I = forces_I},
                                                                            options_.standing_low_pass_s));
    for (std::size_t i = 0; i < supports.size(); ++i) {
      const Support support = supports[i];
      const std::vector<RobotSample>& samples = support == Support::kStanding ? calm : lively;
      (support == Support::kHanging    ? result_.coverage.hanging_s
       : support == Support::kStanding ? result_.coverage.standing_s
                                       : result_.coverage.other_s) += kSample_s;
      const double since_s = samples[i].t_s - samples.front().t_s;
      if (i == 0 || std::floor(since_s / options_.block_s) > std::floor((since_s - kSample_s) / options_.block_s))
        blocks_.push_back({fmt::format("{} from {:.1f} s", recording.name, samples[i].t_s), {}});
      if (support != Support::kLoose) {  // steps and slips shake the arms: the equations need smooth motion
        for (RobotRow& row : equations_.rows(samples[i], support)) blocks_.back().rows.push_back(std::move(row));
      }
      done_ticks_ += kSample_s / recording.period_s;
      if (i % 20 == 0) progress_.report_or_throw(0.9 * std::min(done_ticks_ / total_ticks, 1.0));
    }
    const std::vector<RobotSample> all =
        robot_samples(recording, sampling({.ticks_per_sample = 1, .specific_force_I = forces_I}));  // a slip is short
    samples_.insert(samples_.end(), all.begin(), all.end());
  }

  std::string candidate_name(int candidate) const {
    const RobotCandidate& c = list_.candidates[static_cast<std::size_t>(candidate)];
    return fmt::format("{} of {}", c.effect, c.place);
  }

  RobotCause cause(const RobotFinding& finding) const {
    const RobotCandidate& candidate = list_.candidates[static_cast<std::size_t>(finding.candidate)];
    RobotCause cause{.effect = candidate.effect,
                     .place = candidate.place,
                     .parameters = {},
                     .log_evidence = finding.log_evidence,
                     .folds_better = finding.folds_better,
                     .folds = finding.folds,
                     .or_instead = {},
                     .told_apart_by = {}};
    for (std::size_t i = 0; i < candidate.parameters.size(); ++i) {
      const RobotParameter& p = list_.parameters[static_cast<std::size_t>(candidate.parameters[i])];
      const auto k = static_cast<Eigen::Index>(i);
      cause.parameters.push_back({name(p), {finding.value[k], finding.low[k], finding.high[k]}, unit(p)});
    }
    for (const int other : finding.or_instead) cause.or_instead.push_back(candidate_name(other));
    const auto apart = [&](Support support) { return finding.apart[static_cast<std::size_t>(support)]; };
    if (!cause.or_instead.empty())
      cause.told_apart_by = apart(Support::kHanging) >= apart(Support::kStanding) ? "hanging" : "standing";
    return cause;
  }

  void conclude(const RobotEvidence& evidence) {
    bool ambiguous = false;
    for (const RobotFinding& finding : evidence.findings) {
      result_.causes.push_back(cause(finding));
      ambiguous = ambiguous || !finding.or_instead.empty();
    }
    result_.held_out_before = evidence.held_out_before;
    result_.held_out_after = evidence.held_out_after;
    add_unexplained(evidence);
    result_.verdict = ambiguous                     ? evidence::Verdict::kAmbiguous
                      : !result_.causes.empty()     ? evidence::Verdict::kFound
                      : !result_.depends_on.empty() ? evidence::Verdict::kUnexplained
                                                    : evidence::Verdict::kNone;
    add_others(evidence);
    add_not_seen(evidence);
  }

  /// With correct parameters, a hanging joint's residual holds only the shape of dry friction near standstill and
  /// acceleration noise. A joint with a cause is left out: the equations are linear in the cause, and a strong one
  /// makes a linearisation error.
  void add_unexplained(const RobotEvidence& evidence) {
    const JointVector moved_kg_m2 = moved_inertia_kg_m2(robot_);
    for (int j = 0; j < robot_.joint_index.size(); ++j) {
      const std::string& joint = robot_.joint_index.name(j);
      const double left_Nm = evidence.left[static_cast<std::size_t>(equations_.kind_of_joint(Support::kHanging, j))];
      const double usual_Nm = options_.remains_of_friction * robot_.joints[static_cast<std::size_t>(j)].friction_Nm +
                              options_.remains_rad_s2 * moved_kg_m2[j];
      if (left_Nm <= usual_Nm ||
          std::ranges::any_of(result_.causes, [&](const RobotCause& cause) { return cause.place == joint; }))
        continue;
      result_.depends_on.push_back(fmt::format("{}: {:.2g} Nm remain in its equation; noise and friction leave {:.2g}",
                                               joint, left_Nm, usual_Nm));
    }
  }

  void add_others(const RobotEvidence& evidence) {
    constexpr std::size_t kMost = 8;
    std::vector<int> order(list_.candidates.size());
    std::iota(order.begin(), order.end(), 0);
    const auto& score = evidence.candidate_log_evidence;
    std::ranges::sort(
        order, [&](int a, int b) { return score[static_cast<std::size_t>(a)] > score[static_cast<std::size_t>(b)]; });
    for (const int candidate : order) {
      if (result_.others.size() == kMost || score[static_cast<std::size_t>(candidate)] <= 0.0) break;
      if (std::ranges::any_of(evidence.findings, [&](const RobotFinding& f) { return f.candidate == candidate; }))
        continue;
      const RobotCandidate& c = list_.candidates[static_cast<std::size_t>(candidate)];
      result_.others.push_back(
          {.effect = c.effect, .place = c.place, .log_evidence = score[static_cast<std::size_t>(candidate)]});
    }
  }

  void add_not_seen(const RobotEvidence& evidence) {
    for (const RobotCandidate& candidate : list_.candidates) {
      const bool seen = std::ranges::all_of(candidate.parameters, [&](int k) {
        const auto i = static_cast<std::size_t>(k);
        return evidence.detectable[i] < list_.parameters[i].wide;
      });
      if (!seen) result_.not_seen.push_back(fmt::format("{} of {}", candidate.effect, candidate.place));
    }
  }

  const model::RobotModel& robot_;
  const RobotDiagnosisOptions& options_;
  const work::Progress& progress_;
  const RobotParameterList list_;
  RobotEquations equations_;
  std::vector<RobotBlock> blocks_;
  std::vector<RobotSample> samples_;
  double done_ticks_ = 0.0;
  RobotDiagnosis result_;
};

}  // namespace

RobotDiagnosis diagnose_robot(const model::RobotModel& robot, std::span<const RobotRecording> recordings,
                              const RobotDiagnosisOptions& options, const work::Progress& progress) {
  return RobotDiagnosisRun(robot, options, progress).run(recordings);
}

}  // namespace pmg::robot_diagnosis
