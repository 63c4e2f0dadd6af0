#include "folders.hpp"

namespace pmg::test {

std::string project_folder() { return PMG_SOURCE_DIR; }

std::string program_folder() { return PMG_BIN_DIR; }

}  // namespace pmg::test
