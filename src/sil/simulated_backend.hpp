// The backend `sil`: MuJoCo in place of the drives, in real time.
#pragma once

#include "hal/backend_factory.hpp"

namespace pmg::sil {

/// Options: gantry, viewer, camera, motor, seed. It offers a hoist (not with gantry, nor for a bench), the truth, and
/// with viewer a window.
void register_backend(hal::BackendFactory& factory);

}  // namespace pmg::sil
