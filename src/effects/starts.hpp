// Start values of each form's parameters for a fit.
#pragma once

#include <vector>

#include "effects/catalogue.hpp"
#include "effects/unknowns.hpp"

namespace pmg::effects {

/// (form of an effect, model to extend, scale) => (start values of the form's parameters, in the order of
/// Form::parameters). None where these recordings can't have the form: a sag of the bus without a voltage servo, a
/// thermal drift without temperatures, what a drive's own loop does where commands are torques.
std::vector<std::vector<double>> starts(const Effect& effect, const Form& form, const calib::JointModel& current,
                                        const BenchScale& scale);

}  // namespace pmg::effects
