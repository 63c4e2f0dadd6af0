#include "runtime/realtime_trap.hpp"

#include <dlfcn.h>
#include <pthread.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstddef>

namespace {

constexpr std::size_t kMostThreads = 4;
std::array<std::atomic<pid_t>, kMostThreads> watched{};
std::atomic<bool> armed{false};
std::atomic<long> heap_calls{0}, lock_calls{0};
std::atomic<void*> first_caller{nullptr};
thread_local pid_t this_thread = 0;
thread_local bool apart = false;
thread_local pmg::test::Trapped counted_apart;

// Under sanitizers nothing calls it.
[[maybe_unused]] void count_if_watched(std::atomic<long>& calls, long pmg::test::Trapped::*kind,
                                       void* caller) noexcept {
  if (!armed.load(std::memory_order_relaxed)) return;
  if (apart) {
    ++(counted_apart.*kind);
    return;
  }
  if (this_thread == 0) this_thread = gettid();
  for (const std::atomic<pid_t>& thread : watched) {
    if (thread.load(std::memory_order_relaxed) != this_thread) continue;
    ++calls;
    void* none = nullptr;
    first_caller.compare_exchange_strong(none, caller);
  }
}

}  // namespace

namespace pmg::test {

void arm_trap(const std::vector<pid_t>& threads) noexcept {
  for (std::size_t i = 0; i < kMostThreads; ++i) watched[i] = i < threads.size() ? threads[i] : -1;
  heap_calls = lock_calls = 0;
  first_caller = nullptr;
  armed = true;
}

void disarm_trap() noexcept { armed = false; }

Trapped trapped() noexcept { return {heap_calls, lock_calls}; }

CountedApart::CountedApart() noexcept {
  counted_apart = {};
  apart = true;
}

CountedApart::~CountedApart() { apart = false; }

Trapped CountedApart::so_far() const noexcept { return counted_apart; }

std::string first_trapped() {
  void* caller = first_caller;
  Dl_info where{};
  if (caller == nullptr || dladdr(caller, &where) == 0) return "nothing";
  const auto offset = static_cast<char*>(caller) - static_cast<char*>(where.dli_fbase);
  return std::string(where.dli_fname) + " +" + std::to_string(offset) +
         (where.dli_sname != nullptr ? std::string(" in ") + where.dli_sname : "");
}

}  // namespace pmg::test

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)

bool pmg::test::trap_available() noexcept { return false; }

#else

bool pmg::test::trap_available() noexcept { return true; }

namespace {

/// glibc's own function of this name, looked up before main, because dlsym itself may use heap and locks.
template <typename Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

using Mutex = int(pthread_mutex_t*);
using RwLock = int(pthread_rwlock_t*);
using Condition = int(pthread_cond_t*);
using Wait = int(pthread_cond_t*, pthread_mutex_t*);
using TimedWait = int(pthread_cond_t*, pthread_mutex_t*, const timespec*);
using ClockWait = int(pthread_cond_t*, pthread_mutex_t*, clockid_t, const timespec*);

}  // namespace

// In glibc, a program that replaces malloc still reaches the original under these names. Locks are looked up at their
// first call, which the main thread makes long before a trap is armed.
extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): glibc's names
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t items, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* memory);
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

#define PMG_HEAP() count_if_watched(heap_calls, &pmg::test::Trapped::heap, __builtin_return_address(0))
#define PMG_LOCK() count_if_watched(lock_calls, &pmg::test::Trapped::locks, __builtin_return_address(0))

void* malloc(std::size_t size) {
  PMG_HEAP();
  return __libc_malloc(size);
}
void* calloc(std::size_t items, std::size_t size) {
  PMG_HEAP();
  return __libc_calloc(items, size);
}
void* realloc(void* memory, std::size_t size) {
  PMG_HEAP();
  return __libc_realloc(memory, size);
}
void free(void* memory) {
  if (memory != nullptr) PMG_HEAP();
  __libc_free(memory);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  PMG_HEAP();
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr;
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  PMG_HEAP();
  return __libc_memalign(alignment, size);
}

int pthread_mutex_lock(pthread_mutex_t* mutex) {
  PMG_LOCK();
  static Mutex* const function = real<Mutex>("pthread_mutex_lock");
  return function(mutex);
}
int pthread_mutex_trylock(pthread_mutex_t* mutex) {
  PMG_LOCK();
  static Mutex* const function = real<Mutex>("pthread_mutex_trylock");
  return function(mutex);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* lock) {
  PMG_LOCK();
  static RwLock* const function = real<RwLock>("pthread_rwlock_rdlock");
  return function(lock);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* lock) {
  PMG_LOCK();
  static RwLock* const function = real<RwLock>("pthread_rwlock_wrlock");
  return function(lock);
}
int pthread_cond_signal(pthread_cond_t* condition) {
  PMG_LOCK();
  static Condition* const function = real<Condition>("pthread_cond_signal");
  return function(condition);
}
int pthread_cond_broadcast(pthread_cond_t* condition) {
  PMG_LOCK();
  static Condition* const function = real<Condition>("pthread_cond_broadcast");
  return function(condition);
}
int pthread_cond_wait(pthread_cond_t* condition, pthread_mutex_t* mutex) {
  PMG_LOCK();
  static Wait* const function = real<Wait>("pthread_cond_wait");
  return function(condition, mutex);
}
int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex, const timespec* until) {
  PMG_LOCK();
  static TimedWait* const function = real<TimedWait>("pthread_cond_timedwait");
  return function(condition, mutex, until);
}
int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock, const timespec* until) {
  PMG_LOCK();
  static ClockWait* const function = real<ClockWait>("pthread_cond_clockwait");
  return function(condition, mutex, clock, until);
}
}

#endif
