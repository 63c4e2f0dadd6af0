// The fuzzer's entry with a compiler that has no libFuzzer: seeded random inputs, mutated from whole exchanges. Exit
// code 0 when nothing was found; what is found ends the program.
#include <array>
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
    std::vector<std::uint8_t> bytes(random() % 400);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    for (std::size_t at = 0; at + 12 <= bytes.size(); at += 12) {  // most records are replies
      if (random() % 8 == 0) continue;
      bytes[at + 1] = static_cast<std::uint8_t>(random() % 8 == 0 ? 6 + random() % 2 : 8);
      bytes[at + 2] = 0;
      bytes[at + 3] = random() % 6 == 0 ? 0x21 : 0;
      bytes[at + 4] = static_cast<std::uint8_t>(random() % 9);
      if (random() % 2 == 0) continue;  // the messages of CANopen nodes: emergencies, TPDOs, SDO answers, heartbeats
      constexpr std::array<unsigned, 6> kFunctions = {0x080, 0x180, 0x280, 0x580, 0x700, 0x07E};
      const unsigned id = kFunctions[random() % kFunctions.size()] + static_cast<unsigned>(random() % 5);
      bytes[at + 2] = static_cast<std::uint8_t>(id >> 8U);
      bytes[at + 3] = static_cast<std::uint8_t>(id);
      if (random() % 2 == 0) bytes[at + 4] = 0x37;  // operation enabled
    }
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  std::printf("%d inputs, nothing found\n", runs);
  return 0;
}
