// An emulated CiA 402 drive that is an EtherCAT slave itself: its objects over CoE, its process data as mapped.
#pragma once

#include "can/cia402_emulator.hpp"
#include "ethercat/emulated_slave.hpp"

namespace pmg::test {

class EmulatedDriveSlave final : public EmulatedSlave {
 public:
  /// Keeps a reference to drive. temperature: it maps one.
  EmulatedDriveSlave(Cia402Emulator& drive, bool temperature)
      : EmulatedSlave({.name = "Drive",
                       .product_code = 0x0402,
                       .output_bytes = 8,
                       .input_bytes = temperature ? 16 : 14,
                       .mailbox = true}),
        drive_(drive) {
    add_objects();
  }
  void power_up() override {
    EmulatedSlave::power_up();
    drive_.power_up();
    add_objects();
  }

 private:
  static constexpr int kMaps[] = {0x1600, 0x1A00};

  void add_objects() {
    ObjectStore& objects = drive_.objects;
    objects.add(0x1C00, 0, 4, 1, false);
    for (int i = 1; i <= 4; ++i) objects.add(0x1C00, i, static_cast<std::uint32_t>(i), 1, false);
    for (int i = 0; i < 2; ++i) {
      objects.add(0x1C12 + i, 0, 1, 1);
      objects.add(0x1C12 + i, 1, static_cast<std::uint32_t>(kMaps[i]), 2);
      for (int k = 5; k <= 8; ++k) objects.add(kMaps[i], k, 0, 4);
      objects.value(0x1400 + 0x400 * i, 1) |= 0x80000000U;  // may always be mapped before safe-operational
    }
  }
  void take(std::span<const std::uint8_t> outputs) override { drive_.take(outputs); }
  void give(std::span<std::uint8_t> inputs, std::span<const std::uint8_t>) override { drive_.give(inputs); }
  void stopped() override { drive_.lose_bus(); }

  std::vector<std::uint8_t> answer_mail(std::span<const std::uint8_t> service) override {
    if (drive_.silent || service.size() < 10 || service[1] >> 4 != 2) return {};  // SDO requests alone
    drives::Message request = drives::Message::of(0x600, service.subspan(2, 8));
    const auto bytes = drive_.serve_objects(request);
    const bool abort = bytes[0] == 0x80;  // an abort is a request to end the transfer, too
    std::vector<std::uint8_t> answer = {0, static_cast<std::uint8_t>(abort ? 0x20 : 0x30)};
    answer.insert(answer.end(), bytes.begin(), bytes.end());
    return answer;
  }
  std::pair<int, int> mapped_bytes() const override {
    const auto bytes = [&](int assigned) {
      int sum = 0;
      const auto map = static_cast<int>(drive_.objects.value(assigned, 1));
      if (drive_.objects.value(assigned, 0) == 0) return 0;
      for (std::uint32_t k = 1; k <= drive_.objects.value(map, 0); ++k)
        sum += static_cast<int>((drive_.objects.value(map, static_cast<int>(k)) & 0xFFU) / 8);
      return sum;
    };
    return {bytes(0x1C12), bytes(0x1C13)};
  }

  Cia402Emulator& drive_;
};

}  // namespace pmg::test
