#include "calib/optimizer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlopt.hpp>
#include <numeric>
#include <random>
#include <stdexcept>

#include "work/parallel.hpp"

namespace pmg::calib {

namespace {

nlopt::algorithm nlopt_algorithm(Method method) {
  if (method == Method::kBobyqa) return nlopt::LN_BOBYQA;
  return method == Method::kSbplx ? nlopt::LN_SBPLX : nlopt::GN_CRS2_LM;
}

void search_nlopt(Method method, const Loss& loss, std::vector<double> point, const SearchOptions& options) {
  nlopt::srand(options.seed);
  nlopt::opt optimizer(nlopt_algorithm(method), static_cast<unsigned>(point.size()));
  optimizer.set_lower_bounds(0.0);
  optimizer.set_upper_bounds(1.0);
  optimizer.set_initial_step(options.first_step);
  optimizer.set_maxeval(options.most_evaluations);
  optimizer.set_ftol_rel(options.relative_tolerance);
  optimizer.set_xtol_abs(1e-6);
  optimizer.set_min_objective(
      [](const std::vector<double>& x, std::vector<double>&, void* data) {
        return (*static_cast<const Loss*>(data))(x);
      },
      const_cast<Loss*>(&loss));  // NOLINT(cppcoreguidelines-pro-type-const-cast): NLopt's void*
  double lowest = 0.0;
  try {
    optimizer.optimize(point, lowest);
  } catch (const nlopt::roundoff_limited&) {
  } catch (const nlopt::forced_stop&) {
  }
}

}  // namespace

Method method_of(const std::string& name) {
  if (name == "bobyqa") return Method::kBobyqa;
  if (name == "sbplx") return Method::kSbplx;
  if (name == "crs2") return Method::kCrs2;
  if (name == "cmaes") return Method::kCmaes;
  throw std::invalid_argument(fmt::format("no optimizer '{}'; expected bobyqa, sbplx, crs2 or cmaes", name));
}

Found search(Method method, const Loss& loss, const std::vector<double>& start, const SearchOptions& options,
             const work::Progress& progress) {
  Found best{start, loss(start), 1};
  const Loss watched = [&](const std::vector<double>& point) {
    // Only NLopt's own exceptions can pass through its C core.
    if (progress.interrupted_now()) throw nlopt::forced_stop();
    const double value = loss(point);
    ++best.evaluations;
    if (value < best.loss) best.loss = value, best.point = point;
    return value;
  };
  try {
    if (method == Method::kCmaes)
      search_cmaes(watched, start, options);
    else
      search_nlopt(method, watched, start, options);
  } catch (const nlopt::forced_stop&) {
  }
  return best;
}

std::vector<std::vector<double>> spread_points(std::size_t count, std::size_t dimensions, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::vector<double>> points(count, std::vector<double>(dimensions));
  std::vector<std::size_t> rows(count);
  for (std::size_t d = 0; d < dimensions; ++d) {
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    for (std::size_t i = count; i > 1; --i) std::swap(rows[i - 1], rows[random() % i]);
    for (std::size_t i = 0; i < count; ++i)
      points[i][d] = (static_cast<double>(rows[i]) + 0.5) / static_cast<double>(count);
  }
  return points;
}

std::vector<Found> screened(const Loss& loss, std::vector<std::vector<double>> points, unsigned threads) {
  std::vector<Found> found(points.size());
  work::for_each_in_parallel(points.size(), threads, [&](std::size_t i) {
    const double value = loss(points[i]);
    found[i] = {std::move(points[i]), value, 1};
  });
  sort(found);
  return found;
}

void sort(std::vector<Found>& found) { std::ranges::stable_sort(found, {}, &Found::loss); }

}  // namespace pmg::calib
