// Derivative-free minimisation over the unit cube.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "work/progress.hpp"

namespace pmg::calib {

enum class Method { kBobyqa, kSbplx, kCrs2, kCmaes };

/// bobyqa, sbplx, crs2 or cmaes. Throws std::invalid_argument on other names.
Method method_of(const std::string& name);

struct SearchOptions {
  int most_evaluations = 1000;
  double first_step = 0.1;           ///< of the cube's edge
  double relative_tolerance = 1e-4;  ///< of the loss
  unsigned seed = 1;
};

struct Found {
  std::vector<double> point;
  double loss = 0.0;
  int evaluations = 0;
};

using Loss = std::function<double(const std::vector<double>& point)>;

/// (loss, start) => (best point evaluated, also after an interruption). NLopt's BOBYQA and SBPLX are local searches,
/// CRS2 and pagmo's CMA-ES (the paper's) global ones. Same input, same result.
Found search(Method method, const Loss& loss, const std::vector<double>& start, const SearchOptions& options,
             const work::Progress& progress = {});

/// (number of points, dimensions, seed) => (a Latin hypercube: each of `count` rows of each dimension holds one point).
std::vector<std::vector<double>> spread_points(std::size_t count, std::size_t dimensions, unsigned seed);

/// (loss, points) => (the points with their losses, the lowest first; of equal ones in the given order). Does not
/// depend on the number of threads.
std::vector<Found> screened(const Loss& loss, std::vector<std::vector<double>> points, unsigned threads);

/// Lowest loss first.
void sort(std::vector<Found>& found);

/// CMA-ES alone, in a translation unit of its own: pagmo's templates take long to compile.
Found search_cmaes(const Loss& loss, const std::vector<double>& start, const SearchOptions& options);

}  // namespace pmg::calib
