// What differs from assembly to assembly: parameters with a value for each level of a column of runs.csv.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "assembly/level_fit.hpp"
#include "assembly/options.hpp"

namespace pmg::assembly {

/// A parameter that differs from level to level of a column.
struct Variation {
  std::string parameter, unit;
  std::vector<std::string> columns{};  ///< more than one: they change together on these runs
  std::vector<std::string> from{};     ///< columns of runs.csv whose cells name a run's level
  double lower = 0.0, upper = 0.0;     ///< range of the parameter
  std::vector<LevelValue> levels{};
  evidence::Interval mean{};  ///< over assemblies, those not recorded included
  double spread = 0.0;        ///< standard deviation from assembly to assembly [unit]
  bool has_mean = true;       ///< false: the mean's interval contains the value that the effect's absence has
  std::vector<std::string> or_instead{};     ///< parameters whose difference explains the runs as well
  std::vector<std::string> or_by{};          ///< columns by which it explains the runs as well
  double chance = 1.0;                       ///< that it is none, all tests counted
  double deviations = 0.0, folds_won = 0.0;  ///< of the gain on runs left out
};

/// A difference that would be significant by itself and is not claimed.
struct NotVarying {
  std::string parameter;
  std::vector<std::string> columns;
  std::string why;
};

struct AssemblyDifferences {
  std::vector<Variation> varies;
  std::vector<NotVarying> not_claimed;
  std::vector<UnusedColumn> unused;  ///< columns of runs.csv
  effects::NestedModel fitted;       ///< with the means, not linearised; unless something varies as given

  const Variation* variation_of(const std::string& parameter) const;  ///< null if it is one number for all
};

struct SearchedIn {
  const bench::Bench& bench;
  const effects::NestedFit& fit;       ///< runs without differences
  const effects::NestedModel& fitted;  ///< the model with one number for all runs
  const calib::JointModel& neutral;    ///< the same without its effects
  double noise_squares = 0.0;          ///< [rad^2]
  bool loads_too = true;               ///< false: columns that follow the load are left for later
};

/// (runs and model) => (what varies). Step by step: all parameters by all columns are tested in the linearised model;
/// of those that pass, the one that predicts runs left out best is taken, until none passes. Then all levels are fitted
/// by rollouts, and what doesn't predict runs left out better leaves again. By a column that follows the load a
/// parameter varies only if it does so beyond load-dependent physics: friction by load, weight, inertia, and the
/// parameter itself in proportion to the load. Costs one rollout of at most `searched_runs` runs for each parameter and
/// each unknown; the fit, where something varies, some 30 rollouts of all runs. Nothing without a usable column.
AssemblyDifferences differences_of_assemblies(const SearchedIn& in, const AssemblyOptions& options);

/// (runs) => (the same without what differs in their assemblies).
std::vector<calib::SingleJoint> without_differences(std::vector<calib::SingleJoint> runs);

/// Sets the differences of runs' assemblies by their levels, of runs outside the fit too. A level that was not fitted
/// has the mean.
void set_differences(std::vector<calib::SingleJoint>& runs, const bench::Bench& bench,
                     const AssemblyDifferences& differences);

/// Adds `varies_by` and `varies_by_not_claimed` to diagnosis.json.
void add_to(nlohmann::ordered_json& json, const AssemblyDifferences& differences);

/// "arm or load, which change together in these recordings".
std::string columns_text(const std::vector<std::string>& columns);
/// "-1.2 (-1.3 to -1.1) degrees".
std::string value_text(const Variation& variation, const evidence::Interval& value);
/// "mean 0.1, standard deviation 1.2 degrees".
std::string spread_text(const Variation& variation);
/// Whether a sentence lists the value of each level, or a table beside it does.
enum class Levels { kListed, kInTable };
/// "The zero offset differs from assembly to assembly, by column arm: b -1.2 (-1.3 to -1.1) degrees, ...".
std::string sentence(const Variation& variation, Levels levels = Levels::kListed);

}  // namespace pmg::assembly
