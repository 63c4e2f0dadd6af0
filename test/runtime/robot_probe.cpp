// Links everything that a robot's controller consists of, and runs nothing of it.
#include "runtime/run_info.hpp"

int main() { return *pmg::runtime::software_version() == '\0' ? 1 : 0; }
