#include <algorithm>
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <utility>

#include "calib/optimizer.hpp"

namespace pmg::calib {

namespace {

/// What pagmo asks of a problem.
struct CubeProblem {
  const Loss* loss = nullptr;
  std::size_t dimensions = 1;
  pagmo::vector_double fitness(const pagmo::vector_double& point) const { return {(*loss)(point)}; }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {pagmo::vector_double(dimensions, 0.0), pagmo::vector_double(dimensions, 1.0)};
  }
};

}  // namespace

Found search_cmaes(const Loss& loss, const std::vector<double>& start, const SearchOptions& options) {
  const auto individuals = static_cast<int>(4 + 4 * start.size());
  const auto generations = static_cast<unsigned>(std::max(1, options.most_evaluations / individuals));
  pagmo::algorithm cmaes{
      pagmo::cmaes(generations, -1, -1, -1, -1, 2.0 * options.first_step, 1e-6, 1e-12, false, true, options.seed)};
  pagmo::population population{pagmo::problem{CubeProblem{&loss, start.size()}}, 0U, options.seed};
  population.push_back(start);
  for (int i = 1; i < individuals; ++i) {
    pagmo::vector_double near = population.random_decision_vector();
    for (std::size_t d = 0; d < near.size(); ++d)
      near[d] = std::clamp(start[d] + 2.0 * options.first_step * (near[d] - 0.5), 0.0, 1.0);
    population.push_back(near);
  }
  population = cmaes.evolve(population);
  return {population.champion_x(), population.champion_f()[0], 0};
}

}  // namespace pmg::calib
