// A start for friction that grows while the joint rests.
#pragma once

#include <optional>

#include "effects/nested_fit.hpp"
#include "residual_torque/torque_fit.hpp"

namespace pmg::residual_torque {

/// (missing torque, fit, its model, typical torque, bound) => (friction over the time at rest that makes the rollouts'
/// squares least; nothing where the joint doesn't rest, or where none makes them less). A contact that rests grows:
/// the breakaway torque rises and levels off (E. Rabinowicz, Proc. Phys. Soc. 71:668, 1958). At rest dry friction takes
/// any torque, so nothing is missing there; how long the joint stays at rest tells, and only rollouts show that. Costs
/// nine rollouts of every run where the joint rests.
std::optional<TorqueFit> rest_start(const MissingTorque& missing, const effects::NestedFit& fit,
                                    const calib::JointModel& model, double torque_Nm, double bound_Nm);

}  // namespace pmg::residual_torque
