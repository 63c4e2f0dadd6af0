// Which two effects together may explain what neither explains alone: a look along two lines at once.
#pragma once

#include <string>
#include <vector>

#include "effects/start_screen.hpp"

namespace pmg::effects {

/// A promising start of a fit with one effect.
struct EffectStart {
  const Effect* effect = nullptr;
  ScreenedStart start;
};

struct ScreenedPair {
  const EffectStart *first = nullptr, *second = nullptr;
  double squares = 0.0;  ///< expected with both, the other unknowns refitted [rad^2]
};

/// (screen of the current model with its Jacobian J, starts) => (pairs of starts of different effects, the lowest
/// expected squares first). With r the current residuals and d_i = r(start i) - r, all beyond what J can do, a pair's
/// expected squares are the least |r + a d_1 + b d_2|^2 over 0 <= a, b <= 2. The pairs point to the starts. Costs one
/// rollout of every run for each start.
std::vector<ScreenedPair> screened_pairs(const StartScreen& screen, const std::vector<EffectStart>& starts);

}  // namespace pmg::effects
