// pmg_controller: the controller on its own host: real-time threads, wall clock, operators over LCM.
#include "backends.hpp"
#include "controller_program.hpp"

int main(int argc, char** argv) { return pmg::apps::run_controller_program(argc, argv, pmg::apps::backends()); }
