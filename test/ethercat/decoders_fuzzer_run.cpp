// The decoders' fuzzer with a compiler that has no libFuzzer.
#include "fuzz/seeded_runs.hpp"

int main(int argc, char** argv) {
  return pmg::test::seeded_runs(argc, argv, [](std::mt19937_64& random) {
    std::vector<std::uint8_t> bytes(5 + random() % 300);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random() % 4 == 0 ? random() % 16 : random());
    if (random() % 2 == 0 && bytes.size() > 16) {  // a mailbox with an SDO's answer
      bytes[0] = 10;
      bytes[1] = 0;
      bytes[5] = 0x13;
      bytes[7] = 0x30;
    }
    return bytes;
  });
}
