// Backends of this build, and the backends that it lacks.
#pragma once

#include "hal/backend_factory.hpp"

namespace pmg::apps {

hal::BackendFactory backends();

}  // namespace pmg::apps
