#include "calib/inverse_dynamics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace pmg::calib {

namespace {

constexpr double kUnresolved = 0.1;  // share of the drive: above it, accelerations are wrong by as much

/// "Viscous friction and dry friction backwards"; empty where there is none of them.
std::string named(const std::vector<ImpossibleEstimate>& estimates, bool significant) {
  std::vector<std::string> names;
  for (const ImpossibleEstimate& estimate : estimates) {
    if (estimate.significant == significant) names.push_back(estimate.what);
  }
  std::string text = fmt::format("{}", fmt::join(names, " and "));
  if (!text.empty()) text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

}  // namespace

std::vector<ImpossibleEstimate> impossible_estimates(const InverseDynamics& found) {
  std::vector<ImpossibleEstimate> impossible;
  const auto check = [&](const char* what, double value, double deviation) {
    if (value < 0.0) impossible.push_back({what, value < -2.0 * deviation});
  };
  check("rotor inertia", found.armature_kg_m2.value, found.armature_kg_m2.deviation);
  check("viscous friction", found.viscous_Nm_s_per_rad.value, found.viscous_Nm_s_per_rad.deviation);
  const double dry_Nm = std::hypot(found.coulomb_Nm.deviation, found.offset_Nm.deviation);
  if (std::max(found.coulomb_forward_Nm(), found.coulomb_backward_Nm()) < 0.0) {
    check("dry friction", found.coulomb_Nm.value, dry_Nm);
  } else {
    check("dry friction forwards", found.coulomb_forward_Nm(), dry_Nm);
    check("dry friction backwards", found.coulomb_backward_Nm(), dry_Nm);
  }
  return impossible;
}

bool possible(const InverseDynamics& found) {
  return std::ranges::none_of(impossible_estimates(found), &ImpossibleEstimate::significant);
}

std::string meaning_of_negative(const InverseDynamics& found) {
  const std::vector<ImpossibleEstimate> impossible = impossible_estimates(found);
  std::string text;
  if (const std::string beyond_noise = named(impossible, true); !beyond_noise.empty()) {
    text = beyond_noise + " below zero: no joint has that. ";
    text += found.unresolved > kUnresolved
                ? fmt::format(
                      "The torque changes too fast for {:g} samples a second: {:.0f} % of it is lost between them. ",
                      found.sample_rate_hz, 100.0 * found.unresolved)
                : "The recorded torque doesn't belong to the recorded motion: it is early or late, its unit is another "
                  "one, or "
                  "the load in bench.yaml is wrong. ";
    text += "The fit needs no torque: go by the fit.";
  }
  if (const std::string noise = named(impossible, false); !noise.empty()) {
    text += fmt::format("{}{} below zero by less than its uncertainty: too small to be seen in these recordings.",
                        text.empty() ? "" : " ", noise);
  }
  return text;
}

}  // namespace pmg::calib
