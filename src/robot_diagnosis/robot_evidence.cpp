#include "robot_diagnosis/robot_evidence.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace pmg::robot_diagnosis {

double NormalEquations::chi_square(const Eigen::VectorXd& theta) const {
  return squares - 2.0 * right.dot(theta) + theta.dot(matrix * theta);
}

namespace {

double residual(const RobotRow& row, const Eigen::VectorXd& theta) {
  double r = row.residual;
  for (const auto& [index, coefficient] : row.coefficients) r += coefficient * theta[index];
  return r;
}

/// At standstill dry friction may be anything, and stays the same for long: such rows tell nothing.
bool moves(const RobotRow& row) {
  constexpr double kMostStandstill = 0.2;
  return row.standstill <= kMostStandstill;
}

/// The noise of every kind of row: variances, and how many rows it takes for one independent.
struct NoiseLevels {
  std::vector<double> variance, rows_per_independent;

  explicit NoiseLevels(int kinds)
      : variance(static_cast<std::size_t>(kinds), 0.0), rows_per_independent(static_cast<std::size_t>(kinds), 1.0) {}

  double weight(const RobotRow& row) const {
    if (!moves(row)) return 0.0;
    const auto kind = static_cast<std::size_t>(row.kind);
    return variance[kind] > 0.0 ? 1.0 / ((variance[kind] + row.friction_variance) * rows_per_independent[kind]) : 0.0;
  }
};

/// Residuals of a fit in order, kind by kind: rows of one kind follow each other in time.
NoiseLevels noise_of(const std::vector<RobotBlock>& blocks, int kinds, const Eigen::VectorXd& theta) {
  constexpr std::size_t kFewest = 20;  // rows of a kind; fewer tell no noise
  constexpr int kLongestLag = 30;
  std::vector<std::vector<double>> by_kind(static_cast<std::size_t>(kinds));
  for (const RobotBlock& block : blocks) {
    for (const RobotRow& row : block.rows)
      if (moves(row)) by_kind[static_cast<std::size_t>(row.kind)].push_back(residual(row, theta));
  }
  NoiseLevels levels(kinds);
  for (std::size_t kind = 0; kind < by_kind.size(); ++kind) {
    const std::vector<double>& e = by_kind[kind];
    if (e.size() < kFewest) continue;
    const double square = std::inner_product(e.begin(), e.end(), e.begin(), 0.0) / static_cast<double>(e.size());
    if (square <= 0.0) continue;
    double inflation = 1.0;
    for (int lag = 1; lag <= kLongestLag && static_cast<std::size_t>(lag) < e.size(); ++lag) {
      const double product =
          std::inner_product(e.begin() + lag, e.end(), e.begin(), 0.0) / static_cast<double>(e.size());
      if (product <= 0.05 * square) break;
      inflation += 2.0 * product / square;
    }
    levels.variance[kind] = square;
    levels.rows_per_independent[kind] = inflation;
  }
  return levels;
}

NormalEquations sum_up(const std::vector<RobotRow>& rows, const NoiseLevels& noise, Eigen::Index parameters) {
  NormalEquations sum;
  sum.matrix = Eigen::MatrixXd::Zero(parameters, parameters);
  sum.right = Eigen::VectorXd::Zero(parameters);
  for (const RobotRow& row : rows) {
    const double w = noise.weight(row);
    if (w == 0.0) continue;
    sum.squares += w * row.residual * row.residual;
    sum.rows += 1.0 / noise.rows_per_independent[static_cast<std::size_t>(row.kind)];
    for (const auto& [i, a] : row.coefficients) {
      sum.right[i] -= w * a * row.residual;
      for (const auto& [k, b] : row.coefficients) {
        if (k > i) break;
        sum.matrix(i, k) += w * a * b;
      }
    }
  }
  sum.matrix.triangularView<Eigen::StrictlyUpper>() = sum.matrix.transpose();
  return sum;
}

void accumulate(const NormalEquations& from, NormalEquations& to) {
  to.matrix += from.matrix;
  to.right += from.right;
  to.squares += from.squares;
  to.rows += from.rows;
}

NormalEquations without(const NormalEquations& all, const NormalEquations& block) {
  return {all.matrix - block.matrix, all.right - block.right, all.squares - block.squares, all.rows - block.rows};
}

/// Zero-mean normal priors; parameters of found causes are wide.
class Priors {
 public:
  explicit Priors(const RobotParameterList& list) : list_(&list), wide_(list.parameters.size(), false) {}
  void widen(int candidate) {
    for (const int k : list_->candidates[static_cast<std::size_t>(candidate)].parameters)
      wide_[static_cast<std::size_t>(k)] = true;
  }
  void widen_all() {
    for (std::size_t k = 0; k < wide_.size(); ++k) wide_[k] = list_->parameters[k].wide > 0.0;
  }
  Eigen::VectorXd precision() const {
    Eigen::VectorXd result(static_cast<Eigen::Index>(wide_.size()));
    for (std::size_t k = 0; k < wide_.size(); ++k) {
      const RobotParameter& p = list_->parameters[k];
      const double deviation = wide_[k] ? p.wide : p.tolerance;
      result[static_cast<Eigen::Index>(k)] = 1.0 / (deviation * deviation);
    }
    return result;
  }
  bool wide(int candidate) const {
    return wide_[static_cast<std::size_t>(list_->candidates[static_cast<std::size_t>(candidate)].parameters.front())];
  }

 private:
  const RobotParameterList* list_;
  std::vector<bool> wide_;
};

struct Posterior {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

Posterior posterior(const NormalEquations& data, const Priors& priors) {
  const Eigen::MatrixXd precision = data.matrix + Eigen::MatrixXd(priors.precision().asDiagonal());
  const Eigen::Index n = precision.rows();
  Posterior result;
  result.covariance = precision.llt().solve(Eigen::MatrixXd::Identity(n, n));
  result.mean = result.covariance * data.right;
  return result;
}

Eigen::VectorXd estimate(const NormalEquations& data, const Priors& priors) {
  const Eigen::MatrixXd precision = data.matrix + Eigen::MatrixXd(priors.precision().asDiagonal());
  return precision.llt().solve(data.right);
}

double log_evidence_of(const Eigen::MatrixXd& precision, const Eigen::VectorXd& information,
                       const Eigen::VectorXd& prior_deviation) {
  const Eigen::VectorXd prior = prior_deviation.array().square().inverse();
  const Eigen::LLT<Eigen::MatrixXd> sum(precision + Eigen::MatrixXd(prior.asDiagonal()));
  const Eigen::MatrixXd factor = sum.matrixL();
  return 0.5 * information.dot(sum.solve(information)) - factor.diagonal().array().log().sum() +
         0.5 * prior.array().log().sum();
}

/// How much more probable the data are when the candidate may be anything than when it is as in every robot.
double log_evidence(const RobotCandidate& candidate, const RobotParameterList& list, const Posterior& now,
                    const Eigen::VectorXd& prior_precision) {
  const auto count = static_cast<Eigen::Index>(candidate.parameters.size());
  Eigen::MatrixXd covariance(count, count);
  Eigen::VectorXd mean(count), tolerance(count), wide(count), prior(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const int k = candidate.parameters[static_cast<std::size_t>(i)];
    const RobotParameter& p = list.parameters[static_cast<std::size_t>(k)];
    mean[i] = now.mean[k];
    prior[i] = prior_precision[k];
    tolerance[i] = p.tolerance;
    wide[i] = p.wide;
    for (Eigen::Index j = 0; j < count; ++j)
      covariance(i, j) = now.covariance(k, candidate.parameters[static_cast<std::size_t>(j)]);
  }
  const Eigen::MatrixXd information_matrix = covariance.inverse();
  const Eigen::VectorXd information = information_matrix * mean;
  const Eigen::MatrixXd of_data = information_matrix - Eigen::MatrixXd(prior.asDiagonal());
  return log_evidence_of(of_data, information, wide) - log_evidence_of(of_data, information, tolerance);
}

class Search {
 public:
  Search(std::vector<RobotBlock> blocks, int kinds, const RobotParameterList& list, const EvidenceOptions& options)
      : blocks_(std::move(blocks)), kinds_(kinds), list_(list), options_(options), noise_(kinds), priors_(list) {
    if (std::ranges::all_of(blocks_, [](const RobotBlock& block) { return block.rows.empty(); }))
      throw std::runtime_error("no stretch of the logs that a diagnosis can use");
    learn_noise();
  }

  RobotEvidence run() {
    RobotEvidence evidence;
    const Priors nothing_found = priors_;
    evidence.candidate_log_evidence = scores();
    while (std::ssize(evidence.findings) < options_.most_findings && find_one(evidence)) {
    }
    evidence.theta = estimate(all_, priors_);
    for (RobotFinding& finding : evidence.findings) measure(finding);
    evidence.held_out_before = held_out(nothing_found);
    evidence.held_out_after = held_out(priors_);
    for (const double variance : noise_of(blocks_, kinds_, evidence.theta).variance)
      evidence.left.push_back(std::sqrt(variance));
    tell_detectable(evidence);
    return evidence;
  }

 private:
  /// With everything free what remains is noise; its level weighs the rows, and so on.
  void learn_noise() {
    const auto parameters = static_cast<Eigen::Index>(list_.parameters.size());
    Priors free(list_);
    free.widen_all();
    Eigen::VectorXd theta = Eigen::VectorXd::Zero(parameters);
    constexpr int kRounds = 3;
    for (int round = 0; round < kRounds; ++round) {
      noise_ = noise_of(blocks_, kinds_, theta);
      sum_blocks(parameters);
      theta = estimate(all_, free);
      clear_own_gains(theta);
    }
    noise_ = noise_of(blocks_, kinds_, theta);
    sum_blocks(parameters);
  }

  /// A spring's torque as the motion with these parameters takes it, not as the encoder shows it: the same encoder
  /// noise in a row and in its gain's coefficient would look like too small a gain.
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
    all_ = {Eigen::MatrixXd::Zero(parameters, parameters), Eigen::VectorXd::Zero(parameters), 0.0, 0.0};
    for (const RobotBlock& block : blocks_) {
      sums_.push_back(sum_up(block.rows, noise_, parameters));
      accumulate(sums_.back(), all_);
    }
  }

  std::vector<double> scores() const {
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

  bool find_one(RobotEvidence& evidence) {
    std::vector<double> score = scores();
    for (;;) {
      const auto best = std::ranges::max_element(score);
      if (*best < options_.least_log_evidence) return false;
      const int candidate = static_cast<int>(best - score.begin());
      Priors with = priors_;
      with.widen(candidate);
      RobotFinding finding{.candidate = candidate, .log_evidence = *best};
      if (!relevant(candidate, estimate(all_, with)) || !holds_in_folds(with, finding)) {
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
    const Eigen::VectorXd difference = estimate(all_, with) - estimate(all_, with_rival);
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      if (blocks_[b].rows.empty()) continue;
      const auto support = static_cast<std::size_t>(3 * blocks_[b].rows.front().kind / kinds_);
      finding.apart[support] += difference.dot(sums_[b].matrix * difference);
    }
  }

  /// No one block carries the evidence, and what blocks that are left out say against the cause doesn't outweigh it.
  /// They needn't speak for it: many numbers, each a little further off than is normal, often predict as well.
  bool holds_in_folds(const Priors& with, RobotFinding& finding) const {
    const RobotCandidate& candidate = list_.candidates[static_cast<std::size_t>(finding.candidate)];
    const Eigen::VectorXd precision = priors_.precision();
    double gain = 0.0;
    for (const NormalEquations& block : sums_) {
      if (block.rows == 0.0) continue;
      const NormalEquations rest = without(all_, block);
      const Posterior now = posterior(rest, priors_);
      gain += 0.5 * (block.chi_square(now.mean) - block.chi_square(estimate(rest, with)));
      ++finding.folds;
      if (log_evidence(candidate, list_, now, precision) > 0.5 * options_.least_log_evidence) ++finding.folds_better;
    }
    return finding.log_evidence + gain > options_.least_log_evidence && finding.folds_better == finding.folds;
  }

  /// Value from everything; interval from the posterior or from how the blocks disagree, whichever is wider.
  void measure(RobotFinding& finding) const {
    const auto& parameters = list_.candidates[static_cast<std::size_t>(finding.candidate)].parameters;
    const Posterior now = posterior(all_, priors_);
    const auto count = static_cast<Eigen::Index>(parameters.size());
    Eigen::VectorXd spread = Eigen::VectorXd::Zero(count);
    for (const NormalEquations& block : sums_) {
      const Eigen::VectorXd left_out = estimate(without(all_, block), priors_);
      for (Eigen::Index i = 0; i < count; ++i) {
        const int k = parameters[static_cast<std::size_t>(i)];
        spread[i] += (left_out[k] - now.mean[k]) * (left_out[k] - now.mean[k]);
      }
    }
    finding.value.resize(count);
    finding.low.resize(count);
    finding.high.resize(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const int k = parameters[static_cast<std::size_t>(i)];
      const double tolerance = list_.parameters[static_cast<std::size_t>(k)].tolerance;
      const double variance = std::max(now.covariance(k, k), spread[i]);
      const double half = 1.96 * std::sqrt(variance + tolerance * tolerance);
      finding.value[i] = now.mean[k];
      finding.low[i] = now.mean[k] - half;
      finding.high[i] = now.mean[k] + half;
    }
  }

  double held_out(const Priors& priors) const {
    double sum = 0.0, rows = 0.0;
    for (const NormalEquations& block : sums_) {
      sum += block.chi_square(estimate(without(all_, block), priors));
      rows += block.rows;
    }
    return std::sqrt(sum / std::max(rows, 1.0));
  }

  /// Where the evidence of one parameter alone would just suffice, the rest being as in every robot.
  void tell_detectable(RobotEvidence& evidence) const {
    const Posterior now = posterior(all_, Priors(list_));
    const Eigen::VectorXd prior = Priors(list_).precision();
    for (std::size_t k = 0; k < list_.parameters.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const double of_data = std::max(0.0, 1.0 / now.covariance(i, i) - prior[i]);
      const double variance = (of_data > 0.0 ? 1.0 / of_data : std::numeric_limits<double>::infinity()) +
                              list_.parameters[k].tolerance * list_.parameters[k].tolerance;
      evidence.detectable.push_back(
          std::max(std::sqrt(2.0 * (options_.least_log_evidence + 2.0) * variance), list_.parameters[k].relevant));
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

RobotEvidence weigh(std::vector<RobotBlock> blocks, int kinds, const RobotParameterList& list,
                    const EvidenceOptions& options) {
  return Search(std::move(blocks), kinds, list, options).run();
}

}  // namespace pmg::robot_diagnosis
