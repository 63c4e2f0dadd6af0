// The backend `can`: drives and IMU on CAN buses.
#pragma once

#include "can/bus_setup.hpp"
#include "hal/backend_factory.hpp"

namespace pmg::can {

/// What the control thread is told of these buses: the bus guard damps within 10 bus cycles of its last command.
hal::BackendLimits limits();

/// Drives of the MIT protocol close the position loop with the loop of their current, at some 10 kHz: all the time, for
/// a control tick. What a CiA 402 drive does in position mode isn't known; in torque mode the bus thread closes the
/// loop. Drives answer a cycle's command with their state of that moment, so the command computed from it is the next
/// cycle's.
hal::BackendDescription description(const DriveSetup& setup);

/// No options: robot.yaml describes drives and buses.
void register_backend(hal::BackendFactory& factory);

}  // namespace pmg::can
