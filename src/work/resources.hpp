// What this process has used of its machine.
#pragma once

#include <sys/resource.h>

namespace pmg::work {

struct Resources {
  double cpu_s = 0.0;            ///< of all threads, in the program and in the kernel for it
  double peak_memory_MiB = 0.0;  ///< the largest resident set so far
};

inline Resources used_resources() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return {seconds(usage.ru_utime) + seconds(usage.ru_stime), static_cast<double>(usage.ru_maxrss) / 1024.0};
}

}  // namespace pmg::work
