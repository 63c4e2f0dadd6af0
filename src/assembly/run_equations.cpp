#include "assembly/run_equations.hpp"

#include <algorithm>

namespace pmg::assembly {

Eigen::Index RunEquations::column(const std::string& parameter) const {
  const auto found =
      std::find_if(columns.begin(), columns.end(), [&](const effects::Unknown& u) { return u.name == parameter; });
  return found == columns.end() ? -1 : found - columns.begin();
}

double RunEquations::per_value(Eigen::Index column) const {
  const effects::Unknown& u = columns[static_cast<std::size_t>(column)];
  return u.logarithmic ? 1.0 / u.value(coordinates[column]) : 1.0;
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
  for (const std::string& parameter : parameters) {
    const effects::Unknown full = effects::unknown(parameter, bench, scale);
    const auto there = std::find_if(model.unknowns.begin(), model.unknowns.end(),
                                    [&](const effects::Unknown& u) { return u.name == parameter; });
    if (there == model.unknowns.end())
      model.unknowns.push_back(full);
    else
      *there = full;
  }
  model.ranges.clear();
  model.coordinates.resize(static_cast<Eigen::Index>(model.unknowns.size()));
  for (std::size_t i = 0; i < model.unknowns.size(); ++i) {
    const effects::Unknown& u = model.unknowns[i];
    model.ranges.push_back(u.range());
    model.coordinates[static_cast<Eigen::Index>(i)] = u.coordinate(calib::value(model.model, u.name));
  }
  model.blocks.clear();
  return model;
}

}  // namespace pmg::assembly
