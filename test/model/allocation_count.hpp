// Counts heap allocations of the whole test binary, so that a test can require zero.
#pragma once

#include <cstddef>

namespace pmg::model {
std::size_t allocation_count() noexcept;
}  // namespace pmg::model
