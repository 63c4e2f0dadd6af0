// Whether what a model lacks repeats with time: another user of the bus, a pump, a fan.
#pragma once

#include <optional>

#include "residual_torque/missing_torque.hpp"
#include "residual_torque/options.hpp"

namespace pmg::residual_torque {

/// (missing torque) => (period with which it repeats [s]; none if no period explains enough of it). Time counts from
/// each run's start. For each period of an even grid of frequencies the missing torque is fitted by
///   (a + b c) (waves of one and of two a period),  c = command_change_Nm at the longest lag,
/// and compared with a + b c alone. Costs about as much as the fit of ten candidates.
std::optional<double> repeats_each_s(const MissingTorque& missing, const Options& options);

}  // namespace pmg::residual_torque
