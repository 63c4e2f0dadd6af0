// Which form of an effect the runs show, and which others they don't tell from it.
#pragma once

#include <string>

#include "effects/extension.hpp"
#include "effects/separation.hpp"
#include "effects/start_screen.hpp"

namespace pmg::effects {

/// Two models are told apart in the recorded runs if one is worse than the other in all these respects
/// (SeenSeparation).
struct ApartLimits {
  double noise_squares = 0.0;  ///< mean square that no model goes below [rad^2]
  double deviations = 0.0, share_of_expected = 0.0, visible_share = 0.0;
  int blocks = 0;
};
bool told_apart(const SeenSeparation& seen, const ApartLimits& limits);

struct FormLimits {
  ApartLimits apart;
  double better_deviations = 0.0;    ///< a form replaces a simpler one that is worse by so many deviations
  double hopeless_deviations = 0.0;  ///< a first fit that is worse by so many on the fitted blocks is not finished
  int first_iterations = 0, most_iterations = 0;
};

/// (extension, a screen of the same without one of its effects) => (extension with the effect in its best form, and the
/// forms that do as well in open_forms). Each other form takes the place of the present one, is fitted from its own
/// best start, and is compared on blocks left out. The simplest form (the earliest in the catalogue) stands unless
/// another is better by better_deviations. A form that has every number of the chosen one, and more, is not open
/// beside it. Costs up to one fit and its folds for each form that these recordings can
/// have.
Extension in_best_form(const ExtensionFits& fits, const Extension& current, const StartScreen& without,
                       const std::string& effect, const FormLimits& limits);

}  // namespace pmg::effects
