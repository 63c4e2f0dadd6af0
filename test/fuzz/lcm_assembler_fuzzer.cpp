// libFuzzer on LcmAssembler. The input is a sequence of datagrams, each behind its sender (one byte) and its length
// (two bytes). "scripts/fuzz receiver" builds and runs it.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "io/lcm_assembler.hpp"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static pmg::io::LcmAssembler assembler = [] {  // one for all inputs: its memory is what an attacker leaves behind
    pmg::io::LcmAssembler made;
    made.want("COMMAND");
    made.want("MODE");
    return made;
  }();
  pmg::io::Bytes rest(data, size);
  while (rest.size() >= 3) {
    const std::uint64_t sender = rest[0];
    const std::size_t length = std::min<std::size_t>(static_cast<std::size_t>(rest[1]) << 8 | rest[2], rest.size() - 3);
    const std::vector<std::uint8_t> datagram(rest.begin() + 3, rest.begin() + 3 + static_cast<std::ptrdiff_t>(length));
    rest = rest.subspan(3 + length);
    const auto message = assembler.take(sender, datagram);
    if (!message) continue;
    if (message->channel > 1 || message->payload.size() > pmg::io::LcmAssembler::kLargestMessage) std::abort();
    std::uint8_t sum = 0;
    for (const std::uint8_t byte : message->payload)
      sum = static_cast<std::uint8_t>(sum + byte);  // every byte is readable
    static volatile std::uint8_t sink = 0;
    sink = sum;
  }
  return 0;
}
