// Counts heap allocations of the whole program, Eigen's included: Eigen calls malloc, not operator new.
#pragma once

namespace pmg::test {

/// Calls so far of malloc, calloc, realloc, posix_memalign and aligned_alloc, from any thread. Negative if they can't
/// be counted, because sanitizers bring their own malloc.
long allocation_count() noexcept;

}  // namespace pmg::test
