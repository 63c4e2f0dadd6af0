// Flags of a network interface.
#pragma once

#include <optional>
#include <string>

#include "doctor/host.hpp"

namespace pmg::doctor {

inline constexpr unsigned kInterfaceUp = 1;  ///< IFF_UP of <linux/if.h>

/// As /sys has them; nullopt: no such interface.
std::optional<unsigned> interface_flags(const Host& host, const std::string& interface);

}  // namespace pmg::doctor
