#include "runtime/run_info.hpp"

#include "software_version.hpp"

namespace pmg::runtime {

const char* software_version() noexcept { return PMG_SOFTWARE_VERSION; }

}  // namespace pmg::runtime
