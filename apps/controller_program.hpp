// pmg_controller's program, for any backends: pmg_controller has those of this build, a project outside it adds its own
// (examples/backend).
#pragma once

#include "hal/backend_factory.hpp"

namespace pmg::apps {

/// The whole program: command line, real-time threads, operators over LCM, log. => its exit code.
int run_controller_program(int argc, char** argv, hal::BackendFactory backends);

}  // namespace pmg::apps
