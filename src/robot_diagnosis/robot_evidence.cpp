#include "robot_diagnosis/robot_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "fitting/statistics.hpp"
#include "robot_diagnosis/robot_noise.hpp"
#include "robot_diagnosis/robot_posterior.hpp"

namespace pmg::robot_diagnosis {

namespace {

using fitting::NormalEquations;

NormalEquations left_out(NormalEquations all, const NormalEquations& block) {
  all -= block;
  return all;
}

/// Greedy search: adds the candidate with the most evidence, until none has enough.
class CauseSearch {
 public:
  CauseSearch(std::vector<RobotBlock> blocks, int kinds, const RobotParameterList& list, const EvidenceOptions& options)
      : blocks_(std::move(blocks)),
        kinds_(kinds),
        list_(list),
        options_(options),
        noise_(kinds, options.noise),
        priors_(list) {
    if (std::ranges::all_of(blocks_, [](const RobotBlock& block) { return block.rows.empty(); }))
      throw std::runtime_error("no stretch of the logs that a diagnosis can use");
    learn_noise();
  }

  RobotEvidence run() {
    RobotEvidence evidence;
    const Priors nothing_found = priors_;
    evidence.candidate_log_evidence = candidate_log_evidence();
    while (static_cast<double>(evidence.findings.size()) < options_.most_findings && add_finding(evidence)) {
    }
    evidence.theta = posterior_mean(all_, priors_);
    for (RobotFinding& finding : evidence.findings) estimate_values(finding);
    evidence.held_out_before = held_out_rms(nothing_found);
    evidence.held_out_after = held_out_rms(priors_);
    for (const double variance : noise_levels(blocks_, kinds_, evidence.theta, options_.noise).variance)
      evidence.left.push_back(std::sqrt(variance));
    find_detectable(evidence);
    return evidence;
  }

 private:
  /// Iteratively reweighted least squares: with all parameters free the residual is noise, and its level weighs the
  /// rows.
  void learn_noise() {
    const auto parameters = static_cast<Eigen::Index>(list_.parameters.size());
    Priors free(list_);
    free.widen_all();
    Eigen::VectorXd theta = Eigen::VectorXd::Zero(parameters);
    constexpr int kRounds = 3;  // of reweighting: the levels need the fit, and the fit needs the levels
    for (int round = 0; round < kRounds; ++round) {
      noise_ = noise_levels(blocks_, kinds_, theta, options_.noise);
      sum_blocks(parameters);
      theta = posterior_mean(all_, free);
      clear_own_gains(theta);
    }
    noise_ = noise_levels(blocks_, kinds_, theta, options_.noise);
    sum_blocks(parameters);
  }

  /// Replaces the spring's torque in a gain's coefficient by the torque that the motion requires at theta. With the
  /// encoder's noise in both the row and the coefficient, the estimated gain would be biased low.
  void clear_own_gains(const Eigen::VectorXd& theta) {
    for (RobotBlock& block : blocks_) {
      for (RobotRow& row : block.rows) {
        if (row.own_gain < 0) continue;
        double& coefficient = row.coefficients[static_cast<std::size_t>(row.own_gain)].second;
        coefficient = -row.spring_Nm;
        coefficient -= residual(row, theta);
      }
    }
  }

  void sum_blocks(Eigen::Index parameters) {
    sums_.clear();
    all_ = NormalEquations::zero(parameters);
    for (const RobotBlock& block : blocks_) {
      sums_.push_back(normal_equations(block.rows, noise_, parameters));
      all_ += sums_.back();
    }
  }

  std::vector<double> candidate_log_evidence() const {
    const Posterior now = posterior(all_, priors_);
    const Eigen::VectorXd precision = priors_.precision();
    std::vector<double> result;
    for (std::size_t c = 0; c < list_.candidates.size(); ++c) {
      result.push_back(priors_.wide(static_cast<int>(c)) ? -std::numeric_limits<double>::infinity()
                                                         : log_evidence(list_.candidates[c], list_, now, precision));
    }
    return result;
  }

  bool relevant(int candidate, const Eigen::VectorXd& theta) const {
    for (const int k : list_.candidates[static_cast<std::size_t>(candidate)].parameters) {
      if (std::abs(theta[k]) >= list_.parameters[static_cast<std::size_t>(k)].relevant) return true;
    }
    return false;
  }

  bool add_finding(RobotEvidence& evidence) {
    std::vector<double> score = candidate_log_evidence();
    for (;;) {
      const auto best = std::ranges::max_element(score);
      if (*best < options_.least_log_evidence) return false;
      const int candidate = static_cast<int>(best - score.begin());
      Priors with = priors_;
      with.widen(candidate);
      RobotFinding finding{.candidate = candidate, .log_evidence = *best};
      if (!relevant(candidate, posterior_mean(all_, with)) || !holds_in_folds(with, finding)) {
        *best = -std::numeric_limits<double>::infinity();
        continue;
      }
      name_rivals(score, with, finding);
      priors_ = with;
      evidence.findings.push_back(std::move(finding));
      return true;
    }
  }

  void name_rivals(const std::vector<double>& score, const Priors& with, RobotFinding& finding) const {
    for (std::size_t other = 0; other < score.size(); ++other) {
      if (static_cast<int>(other) != finding.candidate && score[other] > finding.log_evidence - options_.told_apart)
        finding.or_instead.push_back(static_cast<int>(other));
    }
    if (finding.or_instead.empty()) return;
    std::ranges::sort(finding.or_instead, std::greater{}, [&](int c) { return score[static_cast<std::size_t>(c)]; });
    Priors with_rival = priors_;
    with_rival.widen(finding.or_instead.front());
    const Eigen::VectorXd difference = posterior_mean(all_, with) - posterior_mean(all_, with_rival);
    for (const RobotBlock& block : blocks_) {
      for (const RobotRow& row : block.rows) {
        const double apart = residual(row, difference) - row.residual;
        finding.apart[static_cast<std::size_t>(row.support)] += noise_.weight(row) * apart * apart;
      }
    }
  }

  /// True if the evidence does not hang on a single block, and if the log-likelihood of left-out blocks does not
  /// outweigh it. That log-likelihood may be negative: many parameters, each slightly out of tolerance, often predict
  /// as well.
  bool holds_in_folds(const Priors& with, RobotFinding& finding) const {
    const RobotCandidate& candidate = list_.candidates[static_cast<std::size_t>(finding.candidate)];
    const Eigen::VectorXd precision = priors_.precision();
    double gain = 0.0;
    for (const NormalEquations& block : sums_) {
      if (block.samples == 0.0) continue;
      const NormalEquations rest = left_out(all_, block);
      const Posterior now = posterior(rest, priors_);
      gain += 0.5 * (block.squares_after(now.mean) - block.squares_after(posterior_mean(rest, with)));
      ++finding.folds;
      if (log_evidence(candidate, list_, now, precision) > options_.share_in_folds * options_.least_log_evidence)
        ++finding.folds_better;
    }
    return finding.log_evidence + gain > options_.least_log_evidence && finding.folds_better == finding.folds;
  }

  /// Value: posterior mean. Interval: value +- 1.96 sqrt(v + tolerance^2), v the larger of the posterior variance and
  /// the jackknife's over blocks, sum of (mean without the block - mean)^2.
  void estimate_values(RobotFinding& finding) const {
    const auto& parameters = list_.candidates[static_cast<std::size_t>(finding.candidate)].parameters;
    const Posterior now = posterior(all_, priors_);
    const auto count = static_cast<Eigen::Index>(parameters.size());
    Eigen::VectorXd spread = Eigen::VectorXd::Zero(count);
    for (const NormalEquations& block : sums_) {
      const Eigen::VectorXd without_block = posterior_mean(left_out(all_, block), priors_);
      for (Eigen::Index i = 0; i < count; ++i) {
        const int k = parameters[static_cast<std::size_t>(i)];
        spread[i] += (without_block[k] - now.mean[k]) * (without_block[k] - now.mean[k]);
      }
    }
    finding.value.resize(count);
    finding.low.resize(count);
    finding.high.resize(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const int k = parameters[static_cast<std::size_t>(i)];
      const double tolerance = list_.parameters[static_cast<std::size_t>(k)].tolerance;
      const double variance = std::max(now.covariance(k, k), spread[i]);
      const double half = fitting::kNormal95 * std::sqrt(variance + tolerance * tolerance);
      finding.value[i] = now.mean[k];
      finding.low[i] = now.mean[k] - half;
      finding.high[i] = now.mean[k] + half;
    }
  }

  double held_out_rms(const Priors& priors) const {
    double sum = 0.0, rows = 0.0;
    for (const NormalEquations& block : sums_) {
      sum += block.squares_after(posterior_mean(left_out(all_, block), priors));
      rows += block.samples;
    }
    return std::sqrt(sum / std::max(rows, 1.0));
  }

  /// Smallest parameter error whose evidence alone would suffice, all others at their tolerances:
  /// sqrt(2 (least_log_evidence + detectable_margin) v), v the data's variance plus tolerance^2, and at least
  /// `relevant`.
  void find_detectable(RobotEvidence& evidence) const {
    const Posterior now = posterior(all_, Priors(list_));
    const Eigen::VectorXd prior = Priors(list_).precision();
    for (std::size_t k = 0; k < list_.parameters.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const double of_data = std::max(0.0, 1.0 / now.covariance(i, i) - prior[i]);
      const double variance = (of_data > 0.0 ? 1.0 / of_data : std::numeric_limits<double>::infinity()) +
                              list_.parameters[k].tolerance * list_.parameters[k].tolerance;
      evidence.detectable.push_back(
          std::max(std::sqrt(2.0 * (options_.least_log_evidence + options_.detectable_margin) * variance),
                   list_.parameters[k].relevant));
    }
  }

  std::vector<RobotBlock> blocks_;
  int kinds_;
  const RobotParameterList& list_;
  EvidenceOptions options_;
  NoiseLevels noise_;
  Priors priors_;
  std::vector<NormalEquations> sums_;
  NormalEquations all_;
};

}  // namespace

RobotEvidence find_causes(std::vector<RobotBlock> blocks, int kinds, const RobotParameterList& list,
                          const EvidenceOptions& options) {
  return CauseSearch(std::move(blocks), kinds, list, options).run();
}

}  // namespace pmg::robot_diagnosis
