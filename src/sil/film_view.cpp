#include "sil/film_view.hpp"

namespace pmg::sil {

std::optional<double> shown_from_deg(const Command& asked) {
  const bool turns = asked[kOmega] != 0.0, leans = asked[kRoll] != 0.0, bends = asked[kPitch] != 0.0;
  const bool ahead = asked[kVx] != 0.0 || asked[kHeight] != 0.0, aside = asked[kVy] != 0.0;
  if (turns || (leans && bends) || (aside && (ahead || bends))) return kFromTheFrontAndLeft_deg;
  if (leans || aside) return kFromTheFront_deg;
  if (ahead || bends) return kFromTheLeft_deg;
  return std::nullopt;
}

}  // namespace pmg::sil
