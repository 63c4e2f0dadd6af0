#pragma once

#include <string>

namespace pmg::test {

/// The root of the source tree under test, an absolute path. A function and no macro: a path on the compiler's command
/// line would make every test's object its folder's own.
std::string project_folder();

/// Where this build put its programs, an absolute path.
std::string program_folder();

}  // namespace pmg::test
