// Counts heap allocations of the whole program, Eigen's own included: it calls malloc, not operator new.
#pragma once

namespace pmg::test {

/// Calls of malloc, calloc, realloc, posix_memalign and aligned_alloc so far, from any thread. Negative where they
/// can't be counted (sanitizers bring their own malloc).
long allocation_count() noexcept;

}  // namespace pmg::test
