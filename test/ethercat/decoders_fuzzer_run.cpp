// The decoders' fuzzer with a compiler that has no libFuzzer: seeded random inputs. Exit code 0 when nothing was found;
// what is found ends the program.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::atoi(argv[1]) : 20'000;
  std::mt19937_64 random(1);
  for (int run = 0; run < runs; ++run) {
    std::vector<std::uint8_t> bytes(5 + random() % 300);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random() % 4 == 0 ? random() % 16 : random());
    if (random() % 2 == 0 && bytes.size() > 16) {  // a mailbox with an SDO's answer
      bytes[0] = 10;
      bytes[1] = 0;
      bytes[5] = 0x13;
      bytes[7] = 0x30;
    }
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  std::printf("%d inputs, nothing found\n", runs);
  return 0;
}
