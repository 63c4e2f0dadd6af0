// Catches threads that must not use heap or locks: replaces malloc, free and the pthread locks of this program.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace pmg::test {

struct Trapped {
  long heap = 0;   ///< calls of the malloc and free families
  long locks = 0;  ///< calls of pthread mutexes, rwlocks and conditions
};

/// False under sanitizers, which replace the same functions, and outside glibc.
bool trap_available() noexcept;
/// From now on counts the calls of these threads (the kernel's numbers).
void arm_trap(const std::vector<pid_t>& threads) noexcept;
void disarm_trap() noexcept;
Trapped trapped() noexcept;
/// While it exists, this thread's calls are counted separately.
class CountedApart {
 public:
  CountedApart() noexcept;
  ~CountedApart();
  CountedApart(const CountedApart&) = delete;
  CountedApart& operator=(const CountedApart&) = delete;
  Trapped so_far() const noexcept;  ///< since the trap was armed or the object was made
};
/// Address of the first call, for debugging.
std::string first_trapped();

}  // namespace pmg::test
