// The backends that this build contains, and those that users may ask for in vain.
#pragma once

#include "hal/backend_factory.hpp"

namespace pmg::apps {

hal::BackendFactory backends();

}  // namespace pmg::apps
