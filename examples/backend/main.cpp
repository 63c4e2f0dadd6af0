// pmg_controller with one backend more: --hal udp.
#include "apps/backends.hpp"
#include "apps/controller_program.hpp"
#include "udp_backend.hpp"

int main(int argc, char** argv) {
  pmg::hal::BackendFactory factory = pmg::apps::backends();
  own::register_backend(factory);
  return pmg::apps::run_controller_program(argc, argv, factory);
}
