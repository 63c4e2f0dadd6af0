#include "diagnosis/assemblies.hpp"

#include <algorithm>
#include <cmath>

#include "effects/strengths.hpp"

namespace pmg::diagnosis {

assembly::AssemblyDifferences told_apart(const bench::Bench& bench, std::vector<calib::SingleJoint>& fitted,
                                         std::vector<calib::SingleJoint>& scored, const effects::NestedModel& model,
                                         const calib::JointModel& neutral, double noise_squares, bool loads_too,
                                         unsigned threads, const assembly::AssemblyOptions& options) {
  fitted = assembly::without_differences(std::move(fitted));
  scored = assembly::without_differences(std::move(scored));
  const effects::NestedFit fit(fitted, threads);
  assembly::AssemblyDifferences found = assembly::differences_of_assemblies({.bench = bench,
                                                                             .fit = fit,
                                                                             .fitted = model,
                                                                             .neutral = neutral,
                                                                             .noise_squares = noise_squares,
                                                                             .loads_too = loads_too},
                                                                            options);
  assembly::set_differences(fitted, bench, found);
  assembly::set_differences(scored, bench, found);
  return found;
}

double usual_rest(const effects::NestedFit& fit, const effects::NestedModel& model, double noise_squares) {
  Eigen::VectorXd squares(std::ssize(model.blocks));
  for (Eigen::Index b = 0; b < squares.size(); ++b) squares[b] = model.blocks[static_cast<std::size_t>(b)].squares;
  const fitting::BlockComparison compare(fit.blocks(), {}, noise_squares);
  return std::max(0.0, std::exp(compare.mean_log_square(squares)) - 2.0 * noise_squares);
}

void leave_out_what_only_differs(Diagnosis& diagnosis, const effects::Forms& forms) {
  std::erase_if(diagnosis.causes, [&](const Cause& cause) {
    const std::vector<std::string> strengths = effects::strengths(cause.effect, forms);
    const bool only_differs = std::all_of(strengths.begin(), strengths.end(), [&](const std::string& name) {
      const assembly::Variation* variation = diagnosis.assemblies.variation_of(name);
      return variation != nullptr && !variation->has_mean;
    });
    if (only_differs)
      diagnosis.rejected.push_back({cause.effect,
                                    "it differs from assembly to assembly, and its mean over them may be nothing",
                                    LookedAt::kFit});
    return only_differs;
  });
}

}  // namespace pmg::diagnosis
