#include "effects/separation.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::effects {

namespace {

double mean_square(const fitting::NormalEquations& block) { return block.squares / std::max(1.0, block.samples); }

/// Geometric mean of the blocks' mean squares.
double usual_square(const NestedModel& model, double noise_squares) {
  if (model.blocks.empty()) return noise_squares;
  double sum = 0.0;
  for (const fitting::NormalEquations& block : model.blocks)
    sum += std::log(mean_square(block) + 1e-3 * noise_squares + 1e-300);
  return std::exp(sum / static_cast<double>(model.blocks.size()));
}

/// Sums over blocks: expected log-ratio, and its square plus its variance.
struct Sums {
  double blocks = 0.0, values = 0.0, squares = 0.0;

  void add(double difference_squares, double usual_squares, double noise_squares) {
    const double floor = usual_squares + noise_squares;
    const double value = std::log1p(difference_squares / floor);
    // mean((e + d)^2) - mean(e^2) = d^2 + 2 mean(e d): the last term scatters by 2 |e| |d|.
    const double strays = 2.0 * std::sqrt(usual_squares * difference_squares) / (floor + difference_squares);
    blocks += 1.0;
    values += value;
    squares += value * value + strays * strays;
  }
};

}  // namespace

Separation::Separation(const NestedModel& truth, const NestedModel& other, double noise_squares)
    : other_(other),
      usual_squares_(usual_square(truth, noise_squares)),
      noise_squares_(noise_squares),
      information_(prior(other).information),
      gradient_(Eigen::VectorXd::Zero(other.coordinates.size())) {
  for (const fitting::NormalEquations& block : other.blocks) information_ += block.information;
  for (std::size_t b = 0; b < std::min(truth.blocks.size(), other.blocks.size()); ++b) {
    const double difference = std::log(mean_square(other.blocks[b]) + noise_squares + 1e-300) -
                              std::log(mean_square(truth.blocks[b]) + noise_squares + 1e-300);
    old_blocks_ += 1.0;
    old_squares_ += difference * difference;
  }
}

double Separation::expected(const Eigen::MatrixXd& information, const Eigen::VectorXd& gradient,
                            const Blocks* further) const {
  const Eigen::VectorXd step =
      other_.unknowns.empty() ? Eigen::VectorXd()
                              : fitting::bounded_step(information, gradient, other_.ranges, other_.coordinates, 1e-6);
  Sums sums{old_blocks_, 0.0, old_squares_};
  const auto add = [&](const fitting::NormalEquations& block) {
    sums.add(std::max(0.0, block.squares_after(step)) / std::max(1.0, block.samples), usual_squares_, noise_squares_);
  };
  for (const fitting::NormalEquations& block : added_) add(block);
  if (further != nullptr) {
    for (const fitting::NormalEquations& block : *further) add(block);
  }
  if (sums.blocks < 2.0) return 0.0;
  const double mean = sums.values / sums.blocks;
  const double variance = (sums.squares - sums.blocks * mean * mean) / (sums.blocks - 1.0);
  return mean / std::sqrt(std::max(0.0, variance) / sums.blocks + 1e-300);
}

double Separation::expected_deviations() const { return expected(information_, gradient_, nullptr); }

double Separation::expected_deviations_with(const Blocks& run) const {
  Eigen::MatrixXd information = information_;
  Eigen::VectorXd gradient = gradient_;
  for (const fitting::NormalEquations& block : run) {
    information += block.information;
    gradient += block.gradient;
  }
  return expected(information, gradient, &run);
}

void Separation::add(const Blocks& run) {
  for (const fitting::NormalEquations& block : run) {
    information_ += block.information;
    gradient_ += block.gradient;
  }
  added_.insert(added_.end(), run.begin(), run.end());
}

SeenSeparation seen_separation(const NestedFit& fit, const calib::JointModel& first, const calib::JointModel& other,
                               const Eigen::VectorXd& first_held_out, const Eigen::VectorXd& other_held_out,
                               double noise_squares, double visible_share) {
  fitting::Residuals differences = fit.residuals(first);
  const fitting::Residuals others = fit.residuals(other);
  for (std::size_t i = 0; i < differences.size(); ++i) differences[i] -= others[i];
  const std::vector<double> samples = fit.blocks().samples();
  const Eigen::ArrayXd count =
      Eigen::Map<const Eigen::ArrayXd>(samples.data(), static_cast<Eigen::Index>(samples.size())).max(1.0);
  const Eigen::ArrayXd apart = fit.blocks().squares(differences).array() / count;
  const Eigen::ArrayXd one = first_held_out.array() / count + noise_squares + 1e-300;
  const Eigen::ArrayXd two = other_held_out.array() / count + noise_squares + 1e-300;
  const double floor = std::exp(one.log().mean());
  double sum = 0.0, squares = 0.0, expected = 0.0, blocks = 0.0;
  for (Eigen::Index b = 0; b < apart.size(); ++b) {
    if (!(apart[b] > visible_share * (floor - noise_squares))) continue;
    const double value = std::log(two[b] / one[b]);
    blocks += 1.0;
    sum += value;
    squares += value * value;
    expected += std::log1p(apart[b] / one[b]);
  }
  if (blocks < 2.0) return {};
  const double variance = (squares - sum * sum / blocks) / (blocks - 1.0);
  return {sum / std::sqrt(blocks * std::max(variance, 1e-300)), sum / expected, static_cast<int>(blocks)};
}

}  // namespace pmg::effects
