#include "assembly/variation.hpp"

#include <algorithm>

#include "assembly/candidate_search.hpp"
#include "calib/joint_runs.hpp"
#include "calib/unknown.hpp"

namespace pmg::assembly {

namespace {

std::vector<const bench::BenchRun*> runs_of(const std::vector<calib::SingleJoint>& joints) {
  std::vector<const bench::BenchRun*> runs;
  for (const calib::SingleJoint& joint : joints) runs.push_back(&joint.run());
  return runs;
}

class Search {
 public:
  Search(const SearchedIn& in, const AssemblyOptions& options)
      : in_(in), by_(options), scale_(effects::scale_of(in.bench, in.fit.runs(), in.fitted.model)) {
    found_.fitted = in.fitted;
  }

  AssemblyDifferences run() {
    const std::vector<calib::SingleJoint> runs =
        calib::spread(in_.fit.runs(), static_cast<std::size_t>(by_.searched_runs));
    Groupings all = grouped(runs);
    found_.unused = std::move(all.unused);
    leave_out_two_loads(all);
    if (!in_.loads_too) std::erase_if(all.usable, [](const Grouping& one) { return one.follows_load; });
    if (all.usable.empty()) return std::move(found_);
    CandidateSearch search(in_, by_, scale_, runs, std::move(all.usable));
    std::vector<Passed> taken;
    while (taken.size() < static_cast<std::size_t>(by_.most_varying)) {
      if (!search.take_one(taken)) break;
    }
    found_.varies = search.varies();
    found_.not_claimed = search.not_claimed();
    while (!taken.empty() && !fitted(search, taken)) taken.pop_back();
    found_.varies.resize(taken.size());
    return std::move(found_);
  }

 private:
  /// A line through two loads meets both: physics that depends on the load would explain any difference.
  void leave_out_two_loads(Groupings& all) {
    std::erase_if(all.usable, [&](const Grouping& one) {
      const bool line = one.follows_load && one.levels.size() < 3;
      if (line)
        found_.unused.push_back(
            {one.columns.front(),
             "follows the load and has two values: physics that depends on the load explains any difference"});
      return line;
    });
  }

  Groupings grouped(const std::vector<calib::SingleJoint>& runs) const {
    return groupings(in_.bench, runs_of(runs), static_cast<std::size_t>(by_.fewest_runs),
                     static_cast<std::size_t>(by_.most_levels));
  }

  /// Fits all levels to all runs. False if runs left out are predicted no better.
  bool fitted(const CandidateSearch& search, const std::vector<Passed>& taken) {
    found_.varies.resize(taken.size());
    std::vector<std::string> names;
    for (const Passed& one : taken) names.push_back(search.name_of(one));
    effects::NestedModel at = with_columns(in_.fitted, in_.bench, scale_, names);
    if (at.prior_weight == 0.0) {
      for (fitting::Coordinate& range : at.ranges) range.deviation = 0.0;
      at.prior_weight = taken.front().evidence.unit_squares;
    }
    const std::vector<Grouping> groupings = grouped(in_.fit.runs()).usable;
    std::vector<VaryingParameter> varying;
    for (const Passed& one : taken) {
      const auto all = std::find_if(groupings.begin(), groupings.end(), [&](const Grouping& grouping) {
        return grouping.columns == one.effect.grouping.columns;
      });
      if (all == groupings.end()) return false;  // on all runs it groups them otherwise
      const Eigen::Index column = calib::place_of(at.unknowns, search.name_of(one));
      if (!search.has_own_mean(one)) pin(at.ranges[static_cast<std::size_t>(column)], at.coordinates[column]);
      varying.push_back({{column, *all, one.effect.penalty}, one.evidence.unit_squares, one.evidence.freedom});
    }
    const std::vector<fitting::Fold> folds =
        level_folds(varying.front().effect.grouping, in_.fit.blocks().run_of_block());
    const LevelFit fit(in_.fit, at, varying);
    const int iterations = static_cast<int>(by_.iterations);
    const FittedLevels without = fit.fitted(folds, false, iterations), with = fit.fitted(folds, true, iterations);
    const fitting::Comparison gain =
        fitting::BlockComparison(in_.fit.blocks(), folds, in_.noise_squares)(without.held_out, with.held_out);
    if (!refused(gain, in_.noise_squares, by_).empty()) return false;
    found_.fitted = std::move(at);
    found_.fitted.model = with.model;
    found_.fitted.coordinates = calib::coordinates(found_.fitted.unknowns, with.model);
    take_over(with, gain);
    return true;
  }

  void take_over(const FittedLevels& levels, const fitting::Comparison& gain) {
    for (std::size_t v = 0; v < found_.varies.size(); ++v) {
      Variation& one = found_.varies[v];
      one.levels = levels.levels[v];
      one.mean = levels.means[v];
      const double neutral = calib::value(in_.neutral, one.parameter);
      one.has_mean = neutral < one.mean.low || neutral > one.mean.high;
      one.deviations = gain.deviations;
      one.folds_won = gain.folds_won;
    }
  }

  /// Keeps a mean at its value: other numbers of the model stand for it.
  static void pin(fitting::Coordinate& range, double at) {
    constexpr double kPinned = 1e-3;  // of a difference step, which is small by itself
    range.expected = at;
    range.deviation = kPinned * range.step;
  }

  const SearchedIn& in_;
  const AssemblyOptions& by_;
  effects::BenchScale scale_;
  AssemblyDifferences found_;
};

}  // namespace

const Variation* AssemblyDifferences::variation_of(const std::string& parameter) const {
  const auto found =
      std::find_if(varies.begin(), varies.end(), [&](const Variation& one) { return one.parameter == parameter; });
  return found == varies.end() ? nullptr : &*found;
}

AssemblyDifferences differences_of_assemblies(const SearchedIn& in, const AssemblyOptions& options) {
  return Search(in, options).run();
}

std::vector<calib::SingleJoint> without_differences(std::vector<calib::SingleJoint> runs) {
  for (calib::SingleJoint& joint : runs) joint.set_differences({});
  return runs;
}

void set_differences(std::vector<calib::SingleJoint>& runs, const bench::Bench& bench,
                     const AssemblyDifferences& differences) {
  for (calib::SingleJoint& joint : runs) {
    std::vector<bench::AssemblyDifference> differs;
    for (const Variation& one : differences.varies) {
      const std::string name = level_name(bench, joint.run(), one.from);
      for (const LevelValue& level : one.levels) {
        if (level.level == name)
          differs.push_back({one.parameter, level.value.value - one.mean.value, one.lower, one.upper});
      }
    }
    joint.set_differences(std::move(differs));
  }
}

}  // namespace pmg::assembly
