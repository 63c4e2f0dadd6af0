#include "runtime/run_info.hpp"

namespace pmg::runtime {

const char* software_version() noexcept { return PMG_VERSION; }

}  // namespace pmg::runtime
