#include "assembly/candidate_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "assembly/parameters.hpp"
#include "calib/fit_results.hpp"
#include "calib/unknown.hpp"
#include "effects/catalogue.hpp"
#include "fitting/covariance.hpp"

namespace pmg::assembly {

namespace {

/// Load-dependent physics: what one number for all loads may do.
constexpr std::array kLoadPhysics = {"friction.load_driving", "friction.load_backdriving", "load.gravity_scale",
                                     "load.inertia_scale"};

/// The load's torque of each run, or its inertia where no load has weight, about the mean and at most 1.
std::vector<double> load_of_run(const std::vector<calib::SingleJoint>& joints) {
  std::vector<double> weight_Nm, inertia_kg_m2;
  for (const calib::SingleJoint& joint : joints) {
    weight_Nm.push_back(joint.run().load.gravity_Nm);
    inertia_kg_m2.push_back(joint.run().load.inertia_kg_m2);
  }
  const auto [least, most] = std::minmax_element(weight_Nm.begin(), weight_Nm.end());
  Eigen::VectorXd load =
      Eigen::Map<const Eigen::VectorXd>((*most > *least ? weight_Nm : inertia_kg_m2).data(), std::ssize(weight_Nm));
  load.array() -= load.mean();
  load /= std::max(1e-300, load.cwiseAbs().maxCoeff());
  return {load.begin(), load.end()};
}

}  // namespace

std::string refused(const fitting::Comparison& gain, double noise_squares, const AssemblyOptions& by) {
  if (gain.deviations < by.least_deviations || gain.folds_won < by.least_folds_won || gain.gain <= 0.0)
    return "runs left out are predicted no better with it";
  if (std::sqrt(gain.gain) < by.amplitude_of_noise * std::sqrt(noise_squares))
    return "what it explains is small beside the noise";
  return "";
}

CandidateSearch::CandidateSearch(const SearchedIn& in, const AssemblyOptions& options, const effects::BenchScale& scale,
                                 const std::vector<calib::SingleJoint>& runs, std::vector<Grouping> groupings)
    : in_(in), by_(options), groupings_(std::move(groupings)) {
  for (const AssemblyParameter& one : assembly_parameters()) {
    if (one.looked == Looked::kIfPresent && calib::value(in_.fitted.model, one.name) == 0.0) continue;
    candidates_.emplace_back(one.name);
  }
  std::vector<std::string> columns = candidates_;
  const bool loads =
      std::any_of(groupings_.begin(), groupings_.end(), [](const Grouping& g) { return g.follows_load; });
  if (loads) {
    for (const char* name : kLoadPhysics) {
      if (!effects::contains(columns, name)) columns.emplace_back(name);
    }
  }
  const effects::NestedFit fit(runs, in_.fit.threads());
  equations_ = run_equations(fit, with_columns(in_.fitted, in_.bench, scale, columns));
  run_of_block_ = fit.blocks().run_of_block();
  load_of_run_ = load_of_run(runs);
  blocks_ = fit.blocks();
}

double CandidateSearch::tests() const { return static_cast<double>(candidates_.size() * groupings_.size()); }

TestedBeside CandidateSearch::beside(const std::vector<Passed>& taken, Eigen::Index column, bool load_physics) const {
  TestedBeside found;
  for (const Passed& one : taken) found.effects.push_back(one.effect);
  const auto used = [&](Eigen::Index c) {
    const std::string& name = equations_.columns[static_cast<std::size_t>(c)].name;
    const bool of_model = calib::place_of(in_.fitted.unknowns, name) >= 0;
    const bool varies =
        std::any_of(taken.begin(), taken.end(), [&](const Passed& one) { return one.effect.column == c; });
    const bool physics = std::find(kLoadPhysics.begin(), kLoadPhysics.end(), name) != kLoadPhysics.end();
    return c == column || of_model || varies || (load_physics && physics);
  };
  for (Eigen::Index c = 0; c < std::ssize(equations_.columns); ++c) {
    if (!used(c)) found.held.push_back(c);
  }
  if (load_physics) found.load_of_run = load_of_run_;
  return found;
}

std::string CandidateSearch::tested(const std::vector<Passed>& taken, Passed& one, bool load_physics) const {
  const TestedBeside beside = this->beside(taken, one.effect.column, load_physics);
  one.evidence = level_evidence(equations_, beside, one.effect, by_);
  if (!(one.evidence.chance * tests() < by_.chance)) return "chance alone makes levels as different as this";
  if (chance_without_a_run(equations_, beside, one.effect, by_) > by_.chance_without_a_run)
    return "a single run makes the difference";
  if (!(one.evidence.spread > 0.0)) return "the levels' spread is most likely zero";
  const std::vector<fitting::Fold> folds = level_folds(one.effect.grouping, run_of_block_);
  one.effect.penalty = one.evidence.penalty();
  const fitting::HeldOut without = level_held_out(equations_, beside, one.effect, false, folds);
  one.held_out = level_held_out(equations_, beside, one.effect, true, folds);
  one.gain = compared(folds)(without, one.held_out);
  return refused(one.gain, in_.noise_squares, by_);
}

bool CandidateSearch::take_one(std::vector<Passed>& taken) {
  std::vector<Passed> passed;
  for (const Grouping& grouping : groupings_) {
    for (const std::string& parameter : candidates_) {
      const Eigen::Index column = equations_.column(parameter);
      const bool there = std::any_of(taken.begin(), taken.end(), [&](const Passed& one) {
        return one.effect.column == column && one.effect.grouping.columns == grouping.columns;
      });
      if (there) continue;
      Passed one{{column, grouping}, {}, {}, {}};
      if (!tested(taken, one, false).empty()) continue;
      if (grouping.follows_load) {
        Passed beyond = one;
        if (!tested(taken, beyond, true).empty()) {
          do_not_claim(parameter, grouping, "physics that depends on the load explains it with fewer numbers");
          continue;
        }
      }
      passed.push_back(std::move(one));
    }
  }
  if (passed.empty()) return false;
  const auto best = std::max_element(
      passed.begin(), passed.end(), [](const Passed& a, const Passed& b) { return a.gain.log_gain < b.gain.log_gain; });
  varies_.push_back(described(*best, passed));
  taken.push_back(*best);
  return true;
}

Variation CandidateSearch::described(const Passed& best, const std::vector<Passed>& passed) const {
  const calib::Unknown& u = equations_.columns[static_cast<std::size_t>(best.effect.column)];
  Variation found{.parameter = u.name,
                  .unit = calib::unit_on_rig(u.unit(), in_.bench),
                  .columns = best.effect.grouping.columns,
                  .from = best.effect.grouping.from,
                  .lower = u.lower,
                  .upper = u.upper,
                  .spread = best.evidence.spread,
                  .chance = std::min(1.0, best.evidence.chance * tests())};
  for (const Passed& other : passed) {
    if (&other == &best || apart(other, best)) continue;
    const std::vector<std::string>& columns = other.effect.grouping.columns;
    if (columns == found.columns) found.or_instead.push_back(name_of(other));
    if (other.effect.column == best.effect.column)
      found.or_by.insert(found.or_by.end(), columns.begin(), columns.end());
  }
  return found;
}

std::string CandidateSearch::name_of(const Passed& one) const {
  return equations_.columns[static_cast<std::size_t>(one.effect.column)].name;
}

bool CandidateSearch::apart(const Passed& worse, const Passed& better) const {
  const fitting::Comparison gain =
      compared(level_folds(better.effect.grouping, run_of_block_))(worse.held_out, better.held_out);
  return gain.deviations >= by_.apart_deviations;
}

void CandidateSearch::do_not_claim(const std::string& parameter, const Grouping& grouping, const std::string& why) {
  const bool told = std::any_of(not_claimed_.begin(), not_claimed_.end(), [&](const NotVarying& one) {
    return one.parameter == parameter && one.columns == grouping.columns;
  });
  if (!told) not_claimed_.push_back({parameter, grouping.columns, why});
}

bool CandidateSearch::has_own_mean(const Passed& one) const {
  LevelModel model(equations_, {});
  for (const Eigen::Index column : beside({}, one.effect.column, false).held) model.hold(column);
  const Eigen::MatrixXd information = model.sum().information;
  const Eigen::Index c = one.effect.column;
  std::vector<Eigen::Index> other;
  for (Eigen::Index i = 0; i < information.rows(); ++i) {
    if (i != c) other.push_back(i);
  }
  const Eigen::VectorXd mixed = information(other, c);
  const double own = information(c, c) - mixed.dot(fitting::solved(information(other, other), mixed).col(0));
  return own > by_.told_share * information(c, c);
}

fitting::BlockComparison CandidateSearch::compared(const std::vector<fitting::Fold>& folds) const {
  return {blocks_, folds, in_.noise_squares};
}

}  // namespace pmg::assembly
