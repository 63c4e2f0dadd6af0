#include "residual_torque/extension_report.hpp"

#include <fmt/format.h>

namespace pmg::residual_torque {

namespace {

using Json = nlohmann::ordered_json;

/// Knots of an axis, with a point one spacing beyond on either side, where the term is zero.
std::vector<double> places(const model::ResidualAxis& axis) {
  std::vector<double> found;
  const int beyond = axis.periodic || axis.quantity == model::ResidualQuantity::kBend ? 0 : 1;
  for (int k = -beyond; k < axis.knots + beyond; ++k) found.push_back(axis.low + k * axis.spacing());
  return found;
}

Json axis_json(const model::ResidualAxis& axis) {
  Json json = {{"quantity", name(axis.quantity)},
               {"from", axis.low},
               {"to", axis.high},
               {"knots", axis.knots},
               {"periodic", axis.periodic}};
  if (axis.lag_s > 0.0) json["lag_s"] = axis.lag_s;
  return json;
}

}  // namespace

std::string line(const Extension& extension, const std::string& unit) {
  if (!extension.kept) return "no residual torque: " + extension.why_not;
  return fmt::format("residual {}: error {:.4g} {} without it, {:.4g} {} with it", text(extension.term),
                     1e3 * extension.held_out_before.value, unit, 1e3 * extension.held_out_after.value, unit);
}

Json extension_json(const Extension& extension) {
  Json json = {{"kept", extension.kept},
               {"why_not", extension.why_not},
               {"held_out_error_before", extension.held_out_before.value},
               {"held_out_error_after", extension.held_out_after.value},
               {"held_out_error_before_interval", {extension.held_out_before.low, extension.held_out_before.high}},
               {"held_out_error_after_interval", {extension.held_out_after.low, extension.held_out_after.high}},
               {"deviations", extension.gain.deviations},
               {"folds_won", extension.gain.folds_won},
               {"quantities", Json::array()},
               {"acts_as", nullptr},
               {"over", Json::array()},
               {"values_Nm", Json::array()}};
  if (!extension.kept) return json;
  json["acts_as"] = extension.term.acts_as == model::ResidualActs::kTorque ? "torque" : "friction";
  for (const model::ResidualAxis& axis : extension.term.axes) {
    if (axis.knots == 1) continue;
    json["quantities"].push_back(name(axis.quantity));
    json["over"].push_back(axis_json(axis));
  }
  for (int i = 0; i < extension.term.count(); ++i)
    json["values_Nm"].push_back(extension.term.values_Nm[static_cast<std::size_t>(i)]);
  return json;
}

void show_extension(pages::Page& page, const Extension& extension, const std::string& unit) {
  page.heading("What the model gets in place of a cause");
  if (!extension.kept) {
    page.paragraph(fmt::format("No residual torque: {}.", extension.why_not));
    return;
  }
  const model::ResidualTerm& term = extension.term;
  page.paragraph(fmt::format(
      "No effect explains the rest. So motor.yaml gets a residual {}, which names nothing and holds only for what was "
      "recorded: beyond it falls to zero. Mean absolute error {:.3g} {} without it, {:.3g} {} with it; recordings left "
      "out are better in {:.0f} % of the folds over gain, load and trajectory, the gain is {:.1f} of its deviations.",
      text(term), 1e3 * extension.held_out_before.value, unit, 1e3 * extension.held_out_after.value, unit,
      100.0 * extension.gain.folds_won, extension.gain.deviations));
  const std::vector<double> x = places(term.axes[0]);
  const std::vector<double> others = term.axes[1].knots > 1 ? places(term.axes[1]) : std::vector<double>{0.0};
  std::vector<std::vector<double>> curves;
  constexpr const char* kColours[] = {pages::colour::kBlue, pages::colour::kSky, pages::colour::kGreen,
                                      pages::colour::kOrange, pages::colour::kVermillion};
  pages::Plot plot{.title = fmt::format("residual {} [Nm]", text(term)),
                   .x_name = std::string(name(term.axes[0].quantity)),
                   .lines = {},
                   .show_zero = true};
  // Of a map five rows are enough to see its shape.
  const std::size_t rows = std::min<std::size_t>(others.size(), std::size(kColours));
  curves.reserve(rows);
  for (std::size_t r = 0; r < rows; ++r) {
    const double other = others[rows == 1 ? 0 : r * (others.size() - 1) / (rows - 1)];
    std::vector<double>& curve = curves.emplace_back();
    for (const double at : x) curve.push_back(term.at(at, other).value_Nm);
    plot.lines.push_back({.name = rows == 1 ? "" : fmt::format("{} {:.3g}", name(term.axes[1].quantity), other),
                          .x = x,
                          .y = curve,
                          .colour = kColours[r],
                          .points = true});
  }
  page.plot(plot);
}

}  // namespace pmg::residual_torque
