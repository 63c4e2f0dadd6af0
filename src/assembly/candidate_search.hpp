// The search for parameters that differ by a column, in the linearised model.
#pragma once

#include "assembly/level_test.hpp"
#include "assembly/variation.hpp"

namespace pmg::assembly {

/// A candidate that passes: a parameter by a grouping.
struct Passed {
  LevelEffect effect;
  LevelEvidence evidence;
  fitting::Comparison gain;
  fitting::HeldOut held_out;
};

/// (gain on runs left out, mean square of the noise) => (why the gain is none, or "").
std::string refused(const fitting::Comparison& gain, double noise_squares, const AssemblyOptions& by);

/// Refers to what it searches in and to the options: both must outlive it.
class CandidateSearch {
 public:
  /// Costs one rollout of the runs for each unknown of the model and each parameter that assemblies may differ in.
  CandidateSearch(const SearchedIn& in, const AssemblyOptions& options, const effects::BenchScale& scale,
                  const std::vector<calib::SingleJoint>& runs, std::vector<Grouping> groupings);

  /// Adds the best candidate beside those taken before. False if none passes.
  bool take_one(std::vector<Passed>& taken);
  /// True if the model's other numbers can't do what the parameter's mean does.
  bool has_own_mean(const Passed& one) const;
  std::string name_of(const Passed& one) const;
  const std::vector<Variation>& varies() const { return varies_; }  ///< of what was taken; not fitted yet
  const std::vector<NotVarying>& not_claimed() const { return not_claimed_; }

 private:
  double tests() const;
  /// What a candidate is tested beside: the model's numbers, its own and those that vary are free for all runs, and
  /// where asked load-dependent physics.
  TestedBeside beside(const std::vector<Passed>& taken, Eigen::Index column, bool load_physics) const;
  /// Fills the evidence of a candidate. Returns why it doesn't pass, or "".
  std::string tested(const std::vector<Passed>& taken, Passed& one, bool load_physics) const;
  Variation described(const Passed& best, const std::vector<Passed>& passed) const;
  bool apart(const Passed& worse, const Passed& better) const;
  void do_not_claim(const std::string& parameter, const Grouping& grouping, const std::string& why);
  fitting::BlockComparison compared(const std::vector<fitting::Fold>& folds) const;

  const SearchedIn& in_;
  const AssemblyOptions& by_;
  std::vector<Grouping> groupings_;
  std::vector<std::string> candidates_;
  RunEquations equations_;
  fitting::Blocks blocks_;
  std::vector<std::size_t> run_of_block_;
  std::vector<double> load_of_run_;
  std::vector<Variation> varies_;
  std::vector<NotVarying> not_claimed_;
};

}  // namespace pmg::assembly
