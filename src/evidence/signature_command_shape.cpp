// Checks of a command's delay and rate limit from the torque balance.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "evidence/signature_checks.hpp"

namespace pmg::evidence {

namespace {

constexpr double kNoShape = std::numeric_limits<double>::quiet_NaN();

Signature too_little(const std::string& effect) {
  return {effect,
          "balance of torques",
          Agreement::kCannotTell,
          {kNoShape, kNoShape, kNoShape},
          "",
          "too little motion was recorded"};
}

Signature delay_check(const FoundShape& shape, double sample_s, const ShapeOptions& options) {
  const Interval& d = shape.delay_s;
  const double unsure_s = std::max<double>(options.least_delay_s, options.least_delay_samples * sample_s);
  Signature s{"delay", "balance of torques", Agreement::kCannotTell, d, "s", ""};
  if (d.low > unsure_s && shape.delay_gain > options.least_gain) {
    s.agreement = Agreement::kAgrees;
  } else if (d.high < unsure_s) {
    s.agreement = Agreement::kDisagrees;
  }
  s.sentence = fmt::format(
      "torques balance best with the command {:.1f} ms late ({:.1f} to {:.1f}); that removes {:.0f} % of what doesn't",
      1e3 * d.value, 1e3 * d.low, 1e3 * d.high, 100.0 * std::max(0.0, shape.delay_gain));
  return s;
}

Signature rate_limit_check(const FoundShape& shape, const ShapeOptions& options) {
  const Interval& r = shape.rate_limit_rad_s;
  Signature s{"rate_limit", "balance of torques", Agreement::kCannotTell, r, "rad/s", ""};
  if (shape.rate_gain.low > options.least_gain) {
    s.agreement = Agreement::kAgrees;
  } else if (shape.rate_gain.high < options.no_limit_gain) {
    s.agreement = Agreement::kDisagrees;
  }
  s.sentence = fmt::format(
      "a command that moves at {:.3g} rad/s at most removes {:.0f} % ({:.0f} to {:.0f}) of what doesn't balance",
      r.value, 100.0 * shape.rate_gain.value, 100.0 * shape.rate_gain.low, 100.0 * shape.rate_gain.high);
  return s;
}

}  // namespace

std::vector<Signature> command_shape_checks(const FoundShape& shape, double sample_s, const ShapeOptions& options) {
  if (!shape.known) return {too_little("delay"), too_little("rate_limit")};
  return {delay_check(shape, sample_s, options), rate_limit_check(shape, options)};
}

}  // namespace pmg::evidence
