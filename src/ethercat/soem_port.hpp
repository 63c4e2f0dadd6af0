// SOEM over a Wire: the functions of its network driver, without threads' locks.
#pragma once

#include <memory>

#include "ethercat/wire.hpp"

extern "C" {
#include "ethercat.h"
}

namespace pmg::ethercat {

/// SOEM hands its ecx_portt to the driver's functions; the wire stands behind it.
struct SoemPort {
  ecx_portt soem{};
  Wire* wire = nullptr;
  std::uint8_t next_index = 0;
};

/// A port ready for ecx_config_init(). wire outlives it.
std::unique_ptr<SoemPort> make_port(Wire& wire);

}  // namespace pmg::ethercat
