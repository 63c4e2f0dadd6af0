// Benches recorded on real joints, which this project doesn't contain.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "folders.hpp"

namespace pmg::test {

/// The folder of such a bench; it may be missing.
inline std::filesystem::path recorded_bench(const std::string& name) {
  const char* named = std::getenv("PMG_BENCHES");  // NOLINT(concurrency-mt-unsafe): tests set no variables
  const std::filesystem::path all = named != nullptr ? std::filesystem::path(named)
                                                     : std::filesystem::path(project_folder()) / "../shared/data/bench";
  return all / name;
}

}  // namespace pmg::test

/// Skips the test, saying so, where the bench isn't here.
#define PMG_NEEDS_BENCH(name)                                                        \
  if (!std::filesystem::exists(pmg::test::recorded_bench(name)))                     \
  GTEST_SKIP() << "NOT TESTED: no recordings at " << pmg::test::recorded_bench(name) \
               << "; PMG_BENCHES names another folder"
