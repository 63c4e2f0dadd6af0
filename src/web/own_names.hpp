// What this computer is called on its networks.
#pragma once

#include <string>
#include <vector>

namespace pmg::web {

/// localhost, the host's name alone and with .local, and the addresses of its interfaces, without those that hold on
/// one link alone.
std::vector<std::string> own_names();

}  // namespace pmg::web
