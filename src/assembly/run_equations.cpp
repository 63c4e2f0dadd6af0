#include "assembly/run_equations.hpp"

#include <algorithm>

namespace pmg::assembly {

Eigen::Index RunEquations::column(const std::string& parameter) const { return calib::place_of(columns, parameter); }

double RunEquations::per_value(Eigen::Index column) const {
  return 1.0 / columns[static_cast<std::size_t>(column)].slope(coordinates[column]);
}

void RunEquations::leave_out(std::size_t run) {
  const fitting::NormalEquations nothing = fitting::NormalEquations::zero(std::ssize(columns));
  of_run[run] = nothing;
  for (std::size_t b = 0; b < of_block.size(); ++b) {
    if (run_of_block[b] == run) of_block[b] = nothing;
  }
}

RunEquations run_equations(const effects::NestedFit& fit, const effects::NestedModel& at) {
  effects::NestedModel linear = at;
  fit.linearise(linear);
  RunEquations found{.columns = linear.unknowns,
                     .coordinates = linear.coordinates,
                     .prior = prior(linear),
                     .of_block = std::move(linear.blocks),
                     .of_run = {},
                     .run_of_block = fit.blocks().run_of_block()};
  found.of_run.assign(fit.runs().size(), fitting::NormalEquations::zero(linear.coordinates.size()));
  for (std::size_t b = 0; b < found.of_block.size(); ++b) found.of_run[found.run_of_block[b]] += found.of_block[b];
  return found;
}

effects::NestedModel with_columns(effects::NestedModel model, const bench::Bench& bench,
                                  const effects::BenchScale& scale, const std::vector<std::string>& parameters) {
  for (const std::string& parameter : parameters) calib::put(model.unknowns, effects::unknown(parameter, bench, scale));
  model.ranges = calib::ranges(model.unknowns);
  model.coordinates = calib::coordinates(model.unknowns, model.model);
  model.blocks.clear();
  return model;
}

}  // namespace pmg::assembly
