// An example of a backend: a robot whose drives and IMU hang on one board, which speaks UDP.
#pragma once

#include "hal/backend_factory.hpp"

namespace own {

void register_backend(pmg::hal::BackendFactory& factory);

}  // namespace own
