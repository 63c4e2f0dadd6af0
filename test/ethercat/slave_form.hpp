// An emulated EtherCAT slave's form, as its EEPROM has it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace pmg::test {

/// What a slave says of itself in its EEPROM.
struct SlaveForm {
  std::string name;
  std::uint32_t vendor_id = 0x1234, product_code = 0x5678;
  int output_bytes = 0, input_bytes = 0;
  bool mailbox = false;  ///< CANopen over EtherCAT; its process data are then mapped by objects
  bool clock = false;    ///< a distributed clock

  static constexpr std::uint16_t kMailOut = 0x1000, kMailIn = 0x1080, kMailBytes = 0x80;  ///< where things lie
  static constexpr std::uint16_t kOutputs = 0x1100, kInputs = 0x1800;

  /// Words of the EEPROM (ETG.1000.6, ETG.2010): identity, mailbox, categories.
  std::vector<std::uint16_t> eeprom() const {
    const auto word = [](int value) {
      return std::array{static_cast<std::uint8_t>(value & 0xFF), static_cast<std::uint8_t>(value >> 8 & 0xFF)};
    };
    std::vector<std::uint16_t> words(64, 0);
    words[8] = static_cast<std::uint16_t>(vendor_id);
    words[9] = static_cast<std::uint16_t>(vendor_id >> 16U);
    words[10] = static_cast<std::uint16_t>(product_code);
    words[11] = static_cast<std::uint16_t>(product_code >> 16U);
    if (mailbox) {
      words[0x18] = kMailOut;
      words[0x19] = words[0x1B] = kMailBytes;
      words[0x1A] = kMailIn;
      words[0x1C] = 0x04;  // CoE
    }
    const auto category = [&words](std::uint16_t type, std::vector<std::uint8_t> bytes) {
      if (bytes.size() % 2 != 0) bytes.push_back(0);
      words.push_back(type);
      words.push_back(static_cast<std::uint16_t>(bytes.size() / 2));
      for (std::size_t i = 0; i < bytes.size(); i += 2)
        words.push_back(static_cast<std::uint16_t>(bytes[i] | bytes[i + 1] << 8));
    };
    std::vector<std::uint8_t> strings = {1, static_cast<std::uint8_t>(name.size())};
    strings.insert(strings.end(), name.begin(), name.end());
    category(10, strings);
    std::vector<std::uint8_t> general(32, 0);
    general[3] = 1;                   // name
    general[5] = mailbox ? 0x01 : 0;  // CoE with SDO
    category(30, general);
    std::vector<std::uint8_t> managers;
    const auto manager = [&](int start, int bytes, int control, int type) {
      for (const int part : {start, bytes})
        for (const std::uint8_t byte : word(part)) managers.push_back(byte);
      managers.insert(managers.end(), {static_cast<std::uint8_t>(control), 0, 1, static_cast<std::uint8_t>(type)});
    };
    if (mailbox) {
      manager(kMailOut, kMailBytes, 0x26, 1);
      manager(kMailIn, kMailBytes, 0x22, 2);
    }
    manager(kOutputs, output_bytes, 0x24, 3);  // its watchdog is left off
    manager(kInputs, input_bytes, 0x20, 4);
    category(40, {1, 2});  // FMMU0 outputs, FMMU1 inputs
    category(41, managers);
    if (!mailbox) {
      const auto pdo = [&](int index, int sync_manager, int bytes) {
        std::vector<std::uint8_t> list = {word(index)[0],
                                          word(index)[1],
                                          static_cast<std::uint8_t>(bytes),
                                          static_cast<std::uint8_t>(sync_manager),
                                          0,
                                          0,
                                          0,
                                          0};
        for (int i = 0; i < bytes; ++i)
          list.insert(list.end(), {0x00, 0x20, static_cast<std::uint8_t>(i), 0, 5, 8, 0, 0});
        return list;
      };
      if (output_bytes > 0) category(51, pdo(0x1600, 0, output_bytes));
      if (input_bytes > 0) category(50, pdo(0x1A00, 1, input_bytes));
    }
    words.push_back(0xFFFF);
    return words;
  }
};

}  // namespace pmg::test
