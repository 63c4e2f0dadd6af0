// The backend `ethercat`: drives and IMU on CAN buses behind EtherCAT slaves.
#pragma once

#include "can/bus_setup.hpp"
#include "hal/backend_factory.hpp"

namespace pmg::ethercat {

/// As on CAN, but a bridge's answers are a cycle late: a frame brings those that the drives gave to the frame before.
hal::BackendDescription description(const can::DriveSetup& drives);

/// No options: robot.yaml describes interface, bridges and drives.
void register_backend(hal::BackendFactory& factory);

}  // namespace pmg::ethercat
