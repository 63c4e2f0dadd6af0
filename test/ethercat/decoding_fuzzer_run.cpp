// The fuzzer's entry with a compiler that has no libFuzzer: seeded random inputs. Exit code 0 when nothing was found;
// what is found ends the program.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::atoi(argv[1]) : 200;
  std::mt19937_64 random(1);
  for (int run = 0; run < runs; ++run) {
    std::vector<std::uint8_t> bytes(33 + random() % 200);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    for (std::size_t at = 1; at < 33; at += 4) {  // few lies at a time: most starts end at the first
      if (random() % 4 != 0) bytes[at] |= 0x80U;
    }
    for (std::size_t at = 33; at + 4 <= bytes.size(); at += 4) bytes[at + 2] = static_cast<std::uint8_t>(random() % 4);
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  std::printf("%d inputs, nothing found\n", runs);
  return 0;
}
