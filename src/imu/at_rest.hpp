// The first sample of an IMU against gravity.
#pragma once

#include <string>

#include "imu/mti_messages.hpp"

namespace pmg::imu {

/// The robot hangs or stands still, so the specific force is 9.81 +- 2 m/s^2 and points up within 20 degrees. Throws
/// std::runtime_error, one line. who: for messages.
void check_at_rest(const MtiSample& sample, const std::string& who);

}  // namespace pmg::imu
