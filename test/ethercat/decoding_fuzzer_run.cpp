// The fuzzer of whole cables with a compiler that has no libFuzzer.
#include "fuzz/seeded_runs.hpp"

int main(int argc, char** argv) {
  return pmg::test::seeded_runs(argc, argv, [](std::mt19937_64& random) {
    std::vector<std::uint8_t> bytes(33 + random() % 200);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    for (std::size_t at = 1; at < 33; at += 4) {  // few lies at a time: most starts end at the first
      if (random() % 4 != 0) bytes[at] |= 0x80U;
    }
    for (std::size_t at = 33; at + 4 <= bytes.size(); at += 4) bytes[at + 2] = static_cast<std::uint8_t>(random() % 4);
    return bytes;
  });
}
