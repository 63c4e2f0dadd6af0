// Counts heap allocations of the whole program, Eigen's included: Eigen calls malloc, not operator new.
#pragma once

namespace pmg::test {

/// Calls so far of malloc, calloc, realloc, posix_memalign and aligned_alloc, from any thread. Negative if they can't
/// be counted, because sanitizers bring their own malloc.
long allocation_count() noexcept;

}  // namespace pmg::test

/// First in a test that counts.
#define PMG_SKIP_IF_HEAP_IS_NOT_COUNTED() \
  if (pmg::test::allocation_count() < 0) GTEST_SKIP() << "a sanitizer's malloc isn't counted"
