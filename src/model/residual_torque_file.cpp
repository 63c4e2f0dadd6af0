#include "model/residual_torque_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>
#include <stdexcept>

namespace pmg::model {

namespace {

constexpr const char* kGroup = "residual_torque";

ResidualAxis read_axis(files::ConfigReader& reader) {
  std::vector<std::string> names;
  for (const auto& one : residual_quantities()) names.emplace_back(one.name);
  ResidualAxis axis;
  const std::string quantity = reader.one_of("quantity", names);
  const auto found = std::find(names.begin(), names.end(), quantity) - names.begin();
  axis.quantity = residual_quantities()[static_cast<std::size_t>(found)].quantity;
  axis.periodic = reader.optional<bool>("periodic", false);
  axis.low = reader.required<double>("from");
  const bool turn = axis.periodic && axis.quantity == ResidualQuantity::kPosition;
  axis.high = turn ? axis.low + 2.0 * std::numbers::pi : reader.required<double>("to");
  axis.knots = reader.required<int>("knots", files::in_range(axis.periodic ? 1 : 2, ResidualTerm::kMostValues));
  if (axis.quantity == ResidualQuantity::kCommandChange) axis.lag_s = reader.required<double>("lag_s");
  reader.finish();
  return axis;
}

ResidualTerm read_term(files::ConfigReader& reader) {
  ResidualTerm term;
  term.acts_as =
      reader.one_of("acts_as", {"torque", "friction"}) == "torque" ? ResidualActs::kTorque : ResidualActs::kFriction;
  std::vector<files::ConfigReader> axes = reader.maps("over");
  if (axes.empty() || axes.size() > 2) reader.fail("over", "has another number of axes", "one or two");
  for (std::size_t a = 0; a < axes.size(); ++a) term.axes[a] = read_axis(axes[a]);
  if (term.count() > ResidualTerm::kMostValues)
    reader.fail("over", "has too many knots", fmt::format("at most {} values", ResidualTerm::kMostValues));
  const std::vector<double> values = reader.numbers("values_Nm", static_cast<std::size_t>(term.count()));
  std::copy(values.begin(), values.end(), term.values_Nm.begin());
  reader.finish();
  return term;
}

std::string axis_text(const ResidualAxis& axis) {
  if (axis.periodic && axis.quantity == ResidualQuantity::kPosition) {
    return fmt::format("{{quantity: {}, periodic: true, from: {}, knots: {}}}", name(axis.quantity), axis.low,
                       axis.knots);
  }
  const std::string lag = axis.lag_s > 0.0 ? fmt::format(", lag_s: {}", axis.lag_s) : "";
  const char* periodic = axis.periodic ? "periodic: true, " : "";
  return fmt::format("{{quantity: {}, {}from: {}, to: {}, knots: {}{}}}", name(axis.quantity), periodic, axis.low,
                     axis.high, axis.knots, lag);
}

}  // namespace

ResidualTorque read_residual_torque(files::ConfigReader& joint) {
  ResidualTorque torque;
  if (!joint.has(kGroup)) {
    joint.optional<std::string>(kGroup, "");  // a known key
    return torque;
  }
  files::ConfigReader group = joint.map(kGroup);
  std::vector<files::ConfigReader> terms = group.maps("terms");
  if (terms.empty() || terms.size() > ResidualTorque::kMostTerms)
    group.fail("terms", fmt::format("has {} terms", terms.size()), "one or two");
  for (files::ConfigReader& term : terms) torque.terms[static_cast<std::size_t>(torque.count++)] = read_term(term);
  group.finish();
  try {
    check(torque);
  } catch (const std::invalid_argument& error) {
    joint.fail(kGroup, error.what(), "a residual torque that can be simulated");
  }
  return torque;
}

std::string residual_torque_yaml(const ResidualTorque& torque) {
  if (torque.count == 0) return "";
  std::string text = fmt::format("    {}:\n      terms:\n", kGroup);
  for (const ResidualTerm& term : torque.used()) {
    text += fmt::format("        - acts_as: {}\n          over:\n",
                        term.acts_as == ResidualActs::kTorque ? "torque" : "friction");
    for (const ResidualAxis& axis : term.axes) {
      if (axis.knots > 1 || axis.periodic) text += fmt::format("            - {}\n", axis_text(axis));
    }
    const auto* first = term.values_Nm.data();
    text += fmt::format("          values_Nm: [{}]\n", fmt::join(first, first + term.count(), ", "));
  }
  return text;
}

}  // namespace pmg::model
