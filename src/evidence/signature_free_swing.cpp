#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "evidence/cluster_regression.hpp"
#include "evidence/signature_checks.hpp"
#include "evidence/torque_balance.hpp"

namespace pmg::evidence {

namespace {

/// The share is relative to the gravity torque `weight`: with the drive off there is no drive to compare with.
Signature check(const std::string& effect, const ClusterRegression& regression, const Column& column,
                const Column& weight, const std::string& what, const std::string& unit,
                const SignatureOptions& options) {
  Signature s{effect, "free swing", Agreement::kCannotTell, {}, unit, ""};
  const TermEstimate e = regression.term(column);
  s.value = {e.coefficient, e.coefficient - 2.0 * e.deviation, e.coefficient + 2.0 * e.deviation};
  const double per_unit = column.norm() / std::max(1e-300, weight.norm());
  const double share = std::abs(e.coefficient) * per_unit;
  if (e.own > options.own_share && e.t() > options.sure_deviations && share > options.swing_worth_share)
    s.agreement = Agreement::kAgrees;
  if (e.own > options.own_share &&
      share + 2.0 * e.deviation * per_unit < options.disagrees_share * options.swing_worth_share)
    s.agreement = Agreement::kDisagrees;
  s.sentence = fmt::format("switched off, the swing loses {}: {:.3g} {} (deviation {:.2g}), {:.1f} % of its weight",
                           what, e.coefficient, unit, e.deviation, 100.0 * share);
  return s;
}

}  // namespace

std::vector<Signature> free_swing_checks(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                         const SignatureOptions& options) {
  if (bench.rig != bench::Rig::kPendulum) return {};
  const TorqueBalance balance(bench, runs, options.balance, TorqueBalance::While::kOff);
  if (balance.windows() == 0) return {};
  const std::vector<int> clusters = balance.clusters();
  if (clusters.back() + 1 < options.swing_fewest_clusters) return {};
  // With the drive off, friction and the rotor's inertia account for the rest of the load's torque.
  const Column weight = balance.integral([](const BalancePoint& p) { return p.gravity_Nm; });
  const Column left = -(weight + balance.load_inertia_Nm());
  const Column direction = balance.integral([](const BalancePoint& p) { return p.direction; });
  const Column one = Column::Ones(direction.size());
  const auto regression = [&](const Column& other) {
    return ClusterRegression({balance.acceleration_rad_s2(), other, one}, left, clusters,
                             options.balance.collinear_share);
  };
  return {
      check("coulomb", regression(balance.speed_rad_s()), direction, weight, "the same at any speed", "Nm", options),
      check("viscous", regression(direction), balance.speed_rad_s(), weight, "more the faster it is", "Nm s/rad",
            options)};
}

}  // namespace pmg::evidence
