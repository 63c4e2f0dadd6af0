// How much of a fit's residual the integrator may have made.
#pragma once

#include "effects/nested_fit.hpp"

namespace pmg::effects {

/// (bench, fit, model, its free parameters) => (rms of the part of the residual that the step's error may have made
/// [rad]). Semi-implicit Euler is of first order: its error is e = 2 (reading(h) - reading(h / 2)). A fit takes up what
/// the free parameters can make of it; e' is the rest. Of the residual r, the part along e' counts, c e' with
/// c = r.e' / |e'|^2, 0 <= c <= 1. Infinite where the model can't be simulated with half the step. Costs two rollouts
/// of every run, one of them with half the step, and one for each parameter.
double integration_part_rms(const bench::Bench& bench, const NestedFit& fit, const calib::JointModel& model,
                            const calib::Unknowns& unknowns);

/// (model, its residuals) => (what the integrator's step h adds to them; its error is of first order: 2 (r(h) - r(h /
/// 2))). Empty where the model can't be simulated. Costs a rollout of every run with half the step.
fitting::Residuals integration_residuals(const bench::Bench& bench, const NestedFit& fit,
                                         const calib::JointModel& model, const fitting::Residuals& residuals);

}  // namespace pmg::effects
