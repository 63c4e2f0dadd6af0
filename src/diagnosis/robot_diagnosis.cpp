#include "diagnosis/robot_diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace pmg::diagnosis {

namespace {

constexpr double kGravity_m_s2 = 9.81;
constexpr double kSample_s = 0.05, kBlock_s = 4.0;
constexpr int kTicksPerSample = 5;
constexpr int kSettle = 4;  // samples to each side of a change of support that aren't believed

/// A change of support takes its neighbours with it: landing, lifting and the first slip obey no equation here.
std::vector<Support> settled(const std::vector<Support>& seen) {
  std::vector<Support> result = seen;
  for (std::size_t i = 1; i < seen.size(); ++i) {
    if (seen[i] == seen[i - 1]) continue;
    const std::size_t from = i > kSettle ? i - kSettle : 0, to = std::min(i + kSettle, seen.size());
    for (std::size_t k = from; k < to; ++k) result[k] = Support::kLoose;
  }
  return result;
}

/// Per tick, from the support of the nearest sample.
std::vector<Eigen::Vector3d> accelerometer_ripple(RobotEquations& equations, const RobotRecording& recording,
                                                  std::span<const RobotSample> samples,
                                                  std::span<const Support> supports) {
  std::vector<Eigen::Vector3d> ripple_I;
  if (samples.empty()) return ripple_I;
  const std::vector<JointVector> torque = torque_ripple(recording);
  std::size_t nearest = 0;
  for (std::size_t k = 0; k < torque.size(); ++k) {
    const RobotTick& tick = recording.ticks[k];
    while (nearest + 1 < samples.size() &&
           std::abs(samples[nearest + 1].t_s - tick.t_s) < std::abs(samples[nearest].t_s - tick.t_s))
      ++nearest;
    ripple_I.push_back(equations.accelerometer_share(tick.state.q, torque[k], supports[nearest]));
  }
  return ripple_I;
}

class Diagnosing {
 public:
  Diagnosing(const model::RobotModel& robot, const RobotDiagnosisOptions& options, const RobotProgress& progress)
      : robot_(robot),
        options_(options),
        progress_(progress),
        list_(robot_parameters(robot, options.tolerances)),
        equations_(robot, list_) {}

  RobotDiagnosis run(std::span<const RobotRecording> recordings) {
    const auto total = std::accumulate(recordings.begin(), recordings.end(), std::size_t{0},
                                       [](std::size_t n, const RobotRecording& r) { return n + r.ticks.size(); });
    for (const RobotRecording& recording : recordings) take(recording, static_cast<double>(total));
    result_.ground = ground_friction(equations_, samples_, robot_.total_mass_kg * kGravity_m_s2);
    tell(weigh(blocks_, equations_.kinds(), list_, options_.evidence));
    return std::move(result_);
  }

 private:
  void take(const RobotRecording& recording, double total_ticks) {
    const std::vector<RobotSample> crude = robot_samples(recording);
    std::vector<Support> seen;
    for (const RobotSample& sample : crude) seen.push_back(equations_.support(sample));
    const std::vector<Support> supports = settled(seen);
    const std::vector<Eigen::Vector3d> ripple = accelerometer_ripple(equations_, recording, crude, supports);
    const std::vector<RobotSample> samples = robot_samples(recording, kTicksPerSample, ripple);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Support support = supports[i];
      (support == Support::kHanging    ? result_.coverage.hanging_s
       : support == Support::kStanding ? result_.coverage.standing_s
                                       : result_.coverage.other_s) += kSample_s;
      const double since_s = samples[i].t_s - samples.front().t_s;
      if (i == 0 || std::floor(since_s / kBlock_s) > std::floor((since_s - kSample_s) / kBlock_s))
        blocks_.push_back({fmt::format("{} from {:.1f} s", recording.name, samples[i].t_s), {}});
      if (support != Support::kLoose) {  // steps and slips shake the arms: no equations of smooth motion
        for (RobotRow& row : equations_.rows(samples[i], support)) blocks_.back().rows.push_back(std::move(row));
      }
      done_ticks_ += kSample_s / recording.period_s;
      if (progress_ && i % 20 == 0 && !progress_(0.9 * std::min(done_ticks_ / total_ticks, 1.0)))
        throw std::runtime_error("interrupted");
    }
    const std::vector<RobotSample> all = robot_samples(recording, 1, ripple);  // a slip is short
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
                     .or_instead = {}};
    for (std::size_t i = 0; i < candidate.parameters.size(); ++i) {
      const RobotParameter& p = list_.parameters[static_cast<std::size_t>(candidate.parameters[i])];
      const auto k = static_cast<Eigen::Index>(i);
      cause.parameters.push_back({name(p), {finding.value[k], finding.low[k], finding.high[k]}, unit(p)});
    }
    for (const int other : finding.or_instead) cause.or_instead.push_back(candidate_name(other));
    return cause;
  }

  void tell(const RobotEvidence& evidence) {
    bool ambiguous = false;
    for (const RobotFinding& finding : evidence.findings) {
      result_.causes.push_back(cause(finding));
      ambiguous = ambiguous || !finding.or_instead.empty();
    }
    result_.held_out_before = evidence.held_out_before;
    result_.held_out_after = evidence.held_out_after;
    result_.verdict = ambiguous ? Verdict::kAmbiguous : !result_.causes.empty() ? Verdict::kFound : Verdict::kNone;
    constexpr double kMoreThanNoise = 1.5;
    for (std::size_t kind = 0; kind < evidence.unexplained.size(); ++kind) {
      if (evidence.unexplained[kind] > kMoreThanNoise)
        result_.depends_on.push_back(fmt::format(
            "{}: {:.1f} times its noise", equations_.kind_name(static_cast<int>(kind)), evidence.unexplained[kind]));
    }
    tell_others(evidence);
    tell_not_seen(evidence);
  }

  void tell_others(const RobotEvidence& evidence) {
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

  void tell_not_seen(const RobotEvidence& evidence) {
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
  const RobotProgress& progress_;
  const RobotParameterList list_;
  RobotEquations equations_;
  std::vector<RobotBlock> blocks_;
  std::vector<RobotSample> samples_;
  double done_ticks_ = 0.0;
  RobotDiagnosis result_;
};

}  // namespace

RobotDiagnosis diagnose_robot(const model::RobotModel& robot, std::span<const RobotRecording> recordings,
                              const RobotDiagnosisOptions& options, const RobotProgress& progress) {
  return Diagnosing(robot, options, progress).run(recordings);
}

}  // namespace pmg::diagnosis
