// The backend `can`: drives and IMU on CAN buses.
#pragma once

#include "hal/backend_factory.hpp"

namespace pmg::can {

/// No options: robot.yaml describes drives and buses. Its limits: the bus guard damps within 10 bus cycles of the
/// control thread's last command.
void register_backend(hal::BackendFactory& factory);

}  // namespace pmg::can
