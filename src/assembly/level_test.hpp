// Does a parameter differ from level to level? Likelihood ratio, spread by marginal likelihood, and runs left out.
#pragma once

#include "assembly/level_model.hpp"
#include "assembly/options.hpp"

namespace pmg::assembly {

/// What the runs say of the deviations of one parameter.
struct LevelEvidence {
  double ratio = 0.0;         ///< F: mean square of the levels' deviations over what runs of one level scatter
  double chance = 1.0;        ///< of a larger ratio if all levels have the same value
  double freedom = 0.0;       ///< degrees of freedom of the scatter
  double unit_squares = 0.0;  ///< phi: mean square that counts as one observation [rad^2]
  double spread = 0.0;        ///< tau: standard deviation from level to level [unit]
  double penalty() const { return unit_squares / (spread * spread); }
};

/// What a candidate is tested beside.
struct TestedBeside {
  std::vector<LevelEffect> effects{};  ///< that vary, as found before
  std::vector<Eigen::Index> held{};    ///< columns that take no part
  std::vector<double> load_of_run{};   ///< if given, the candidate's value may follow the load instead
};

/// (equations, beside, candidate) => (evidence).
///
/// The levels' deviations u are those of a mixed model: u ~ N(0, tau^2), one number for all runs of every column, the
/// candidate's too. Runs are the observations: with each level on its own, s_r = d |r|^2 / (2 d value) of run r and
/// a_r its information, phi = sum(s_r^2 / a_r) / (runs - levels), and no less than the same over blocks. F = h^T K^+ h
/// / (rank phi), K and h being information and gradient of u beyond all other numbers; F is the likelihood ratio of
/// free levels against none (R. A. Fisher 1925). tau maximises the marginal likelihood (N. M. Laird, J. H. Ware,
/// Biometrics 38:963, 1982): 2 log L(tau) = sum_i h_i^2 / phi^2 / (k_i / phi + 1 / tau^2) - log(1 + tau^2 k_i / phi)
/// over the eigenvalues k_i of K.
LevelEvidence level_evidence(const RunEquations& equations, const TestedBeside& beside, const LevelEffect& candidate,
                             const AssemblyOptions& options);

/// The largest chance() of the candidate when one run of its levels is left out, whichever that is.
double chance_without_a_run(const RunEquations& equations, const TestedBeside& beside, const LevelEffect& candidate,
                            const AssemblyOptions& options);

/// Folds over runs: each leaves out a quarter of the runs of every level, or one of two or three.
std::vector<fitting::Fold> level_folds(const Grouping& grouping, const std::vector<std::size_t>& run_of_block);

/// (equations, beside, candidate, its levels free or one number for all, folds) => (squares of the blocks left out
/// [rad^2]).
fitting::HeldOut level_held_out(const RunEquations& equations, const TestedBeside& beside, const LevelEffect& candidate,
                                bool levels, const std::vector<fitting::Fold>& folds);

}  // namespace pmg::assembly
