#include "evidence/command_shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace pmg::evidence {

namespace {

constexpr int kResamples = 200;  // 5 of them lie beyond either end of a 95 % interval
constexpr double kLimitStep =
    1.12;  // ratio of neighbouring rate limits of the search: the resolution of the limit found
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// For each cluster (row) and candidate shape (column): squared residual of the full balance, and of a balance without
/// load and acceleration. Their ratio compares shapes fairly: a shape that shrinks the command shrinks both.
struct Profile {
  Eigen::MatrixXd residual, whole;
  double ratio(Eigen::Index shape) const { return residual.col(shape).sum() / whole.col(shape).sum(); }
};

Eigen::MatrixXd basis(const std::vector<Column>& columns, double collinear_share) {
  Eigen::MatrixXd found(columns.front().size(), 0);
  for (const Column& column : columns) {
    Column rest = column;
    for (int twice = 0; twice < 2; ++twice) rest -= found * (found.transpose() * rest);
    if (!(rest.norm() > collinear_share * column.norm())) continue;
    found.conservativeResize(Eigen::NoChange, found.cols() + 1);
    found.col(found.cols() - 1) = rest.normalized();
  }
  return found;
}

Profile profile(TorqueBalance& balance, const std::vector<CommandShape>& shapes, double collinear_share) {
  const std::vector<int> clusters = balance.clusters();
  const auto direction = balance.integral([](const BalancePoint& p) { return p.direction; });
  const auto load = balance.integral([](const BalancePoint& p) { return p.gravity_Nm; });
  const auto heavy = balance.integral([](const BalancePoint& p) { return std::abs(p.gravity_Nm) * p.direction; });
  const Column one = Column::Ones(direction.size());
  const Eigen::MatrixXd small = basis({balance.speed_rad_s(), direction, one, heavy}, collinear_share);
  const Eigen::MatrixXd full = basis(
      {balance.speed_rad_s(), direction, one, heavy, load + balance.load_inertia_Nm(), balance.acceleration_rad_s2()},
      collinear_share);
  Profile found;
  found.residual = found.whole = Eigen::MatrixXd::Zero(clusters.back() + 1, static_cast<Eigen::Index>(shapes.size()));
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    balance.shape(shapes[s]);
    const Column drive = balance.drive();
    const Column residual = drive - full * (full.transpose() * drive),
                 whole = drive - small * (small.transpose() * drive);
    for (Eigen::Index i = 0; i < drive.size(); ++i) {
      const int cluster = clusters[static_cast<std::size_t>(i)];
      found.residual(cluster, static_cast<Eigen::Index>(s)) += residual[i] * residual[i];
      found.whole(cluster, static_cast<Eigen::Index>(s)) += whole[i] * whole[i];
    }
  }
  return found;
}

/// A bootstrap sample: how often each cluster is drawn.
Eigen::VectorXd draw(Eigen::Index clusters, std::mt19937& random) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(clusters);
  for (Eigen::Index i = 0; i < clusters; ++i) {
    weights[static_cast<Eigen::Index>(random() % static_cast<unsigned long>(clusters))] += 1.0;
  }
  return weights;
}

Eigen::VectorXd ratios(const Profile& profile, const Eigen::VectorXd& weights) {
  return (profile.residual.transpose() * weights).array() / (profile.whole.transpose() * weights).array();
}

/// Minimum of the parabola through the lowest value and its two neighbours, as an index into an even grid.
double lowest_at(const Eigen::VectorXd& values) {
  Eigen::Index best = 0;
  values.minCoeff(&best);
  const auto at = static_cast<double>(best);
  if (best == 0 || best + 1 == values.size()) return at;
  const double below = values[best - 1], here = values[best], above = values[best + 1];
  const double bend = below - 2.0 * here + above;
  return bend > 0.0 ? at + 0.5 * (below - above) / bend : at;
}

Interval interval(double value, std::vector<double> drawn) {
  std::sort(drawn.begin(), drawn.end());
  const std::size_t tail = drawn.size() / 40;
  return {value, drawn[tail], drawn[drawn.size() - 1 - tail]};
}

void find_delay(TorqueBalance& balance, const ShapeOptions& options, double collinear_share, double rate_limit_rad_s,
                std::mt19937& random, FoundShape& found) {
  const double step_s = std::max(0.001, 0.25 * balance.sample_s());
  std::vector<CommandShape> shapes;
  for (double delay_s = 0.0; delay_s <= options.longest_delay_s; delay_s += step_s)
    shapes.push_back({delay_s, rate_limit_rad_s});
  const Profile p = profile(balance, shapes, collinear_share);
  const Eigen::VectorXd all = ratios(p, Eigen::VectorXd::Ones(p.residual.rows()));
  std::vector<double> drawn_s;
  for (int i = 0; i < kResamples; ++i)
    drawn_s.push_back(step_s * lowest_at(ratios(p, draw(p.residual.rows(), random))));
  found.delay_s = interval(step_s * lowest_at(all), drawn_s);
  found.delay_gain = 1.0 - all.minCoeff() / all[0];
}

void find_rate(TorqueBalance& balance, const ShapeOptions& options, double collinear_share, double delay_s,
               std::mt19937& random, FoundShape& found) {
  std::vector<CommandShape> shapes;
  for (double share = options.slowest_limit; share < options.fastest_limit; share *= kLimitStep) {
    shapes.push_back({delay_s, share * balance.fastest_rad_s()});
  }
  const auto limits = static_cast<Eigen::Index>(shapes.size());
  shapes.push_back({delay_s, kInfinite});
  const Profile p = profile(balance, shapes, collinear_share);
  const Eigen::VectorXd all = ratios(p, Eigen::VectorXd::Ones(p.residual.rows()));
  Eigen::Index best = 0;
  all.head(limits).minCoeff(&best);
  std::vector<double> drawn_gain, drawn_rad_s;
  for (int i = 0; i < kResamples; ++i) {
    const Eigen::VectorXd values = ratios(p, draw(p.residual.rows(), random));
    Eigen::Index here = 0;
    values.head(limits).minCoeff(&here);
    drawn_gain.push_back(1.0 - values[best] / values[limits]);
    drawn_rad_s.push_back(shapes[static_cast<std::size_t>(here)].rate_limit_rad_s);
  }
  found.rate_gain = interval(1.0 - all[best] / all[limits], drawn_gain);
  found.rate_limit_rad_s = interval(shapes[static_cast<std::size_t>(best)].rate_limit_rad_s, drawn_rad_s);
}

}  // namespace

FoundShape find_shape(TorqueBalance& balance, const ShapeOptions& options, double collinear_share, unsigned seed) {
  FoundShape found;
  found.rate_limit_rad_s = {kInfinite, kInfinite, kInfinite};
  if (!balance.shaped() || static_cast<double>(balance.windows()) < options.fewest_windows) return found;
  found.known = true;
  std::mt19937 random(seed);
  CommandShape shape;
  // Alternate twice: a rate limit is a proxy for a delay until it is known, and vice versa.
  for (int round = 0; round < 2; ++round) {
    find_delay(balance, options, collinear_share, shape.rate_limit_rad_s, random, found);
    shape.delay_s = found.delay_gain > options.least_gain && found.delay_s.low > 0.0 ? found.delay_s.value : 0.0;
    find_rate(balance, options, collinear_share, shape.delay_s, random, found);
    if (!(found.rate_gain.low > options.least_gain)) break;
    shape.rate_limit_rad_s = found.rate_limit_rad_s.value;
  }
  balance.shape(shape);
  return found;
}

}  // namespace pmg::evidence
