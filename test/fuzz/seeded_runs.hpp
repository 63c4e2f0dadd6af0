// A fuzzer's entry with a compiler that has no libFuzzer: seeded random inputs. What is found ends the program.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace pmg::test {

/// main of such a fuzzer: its argument is the number of inputs. input(random): one of them.
template <typename Input>
int seeded_runs(int argc, char** argv, const Input& input) {
  const int runs = argc > 1 ? std::atoi(argv[1]) : 0;
  if (runs <= 0) {
    std::fprintf(stderr, "expected a number of inputs\n");
    return 2;
  }
  std::mt19937_64 random(1);
  for (int run = 0; run < runs; ++run) {
    const std::vector<std::uint8_t> bytes = input(random);
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  std::printf("%d inputs, nothing found\n", runs);
  return 0;
}

}  // namespace pmg::test
