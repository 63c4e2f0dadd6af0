// The fuzzer with a compiler that has no libFuzzer: inputs mutated from whole exchanges.
#include <array>

#include "fuzz/seeded_runs.hpp"

int main(int argc, char** argv) {
  return pmg::test::seeded_runs(argc, argv, [](std::mt19937_64& random) {
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
    return bytes;
  });
}
