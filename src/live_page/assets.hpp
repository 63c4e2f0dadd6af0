// The live page's own files.
#pragma once

#include <vector>

#include "web/server.hpp"

namespace pmg::live_page {

std::vector<web::Asset> assets();

}  // namespace pmg::live_page
