// The objects of an emulated CANopen node, and its SDO server. It follows CiA 301, not the client's code.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>

#include "drives/message.hpp"

namespace pmg::test {

class ObjectStore {
 public:
  struct Object {
    std::uint32_t value = 0;
    int bytes = 4;
    bool writable = true;
  };

  void add(int index, int subindex, std::uint32_t value, int bytes, bool writable = true) {
    objects_[key(index, subindex)] = {value, bytes, writable};
  }
  void remove(int index, int subindex) { objects_.erase(key(index, subindex)); }
  /// The object must be there.
  std::uint32_t& value(int index, int subindex = 0) { return objects_.at(key(index, subindex)).value; }
  std::uint32_t value(int index, int subindex = 0) const { return objects_.at(key(index, subindex)).value; }
  Object* find(int index, int subindex) {
    const auto found = objects_.find(key(index, subindex));
    return found == objects_.end() ? nullptr : &found->second;
  }

  /// (request) => the 8 bytes of its answer.
  std::array<std::uint8_t, 8> serve(const drives::Message& request) noexcept {
    std::array<std::uint8_t, 8> answer{};
    std::copy_n(request.data.begin() + 1, 3, answer.begin() + 1);
    const int index = request.data[1] | request.data[2] << 8, subindex = request.data[3];
    Object* object = find(index, subindex);
    if (object == nullptr) return abort(answer, has_index(index) ? 0x06090011 : 0x06020000);
    if ((request.data[0] & 0xE0U) == 0x40U) {
      answer[0] = static_cast<std::uint8_t>(0x43 | (4 - object->bytes) << 2);
      put(answer, object->value);
      return answer;
    }
    if ((request.data[0] & 0xE3U) != 0x23U) return abort(answer, 0x05040001);
    if (!object->writable) return abort(answer, 0x06010002);
    if (4 - (request.data[0] >> 2 & 3) != object->bytes) return abort(answer, 0x06070010);
    std::uint32_t wanted = 0;
    for (std::size_t i = 0; i < 4; ++i) wanted |= static_cast<std::uint32_t>(request.data[4 + i]) << 8U * i;
    if (!may_map(index, subindex)) return abort(answer, 0x08000022);
    object->value = wanted;
    answer[0] = 0x60;
    return answer;
  }

 private:
  static std::uint32_t key(int index, int subindex) {
    return static_cast<std::uint32_t>(index) << 8U | static_cast<std::uint32_t>(subindex);
  }
  bool has_index(int index) const {
    const auto next = objects_.lower_bound(key(index, 0));
    return next != objects_.end() && next->first >> 8U == static_cast<std::uint32_t>(index);
  }
  /// A PDO's map changes while the PDO is off, and its entries while their number is zero.
  bool may_map(int index, int subindex) const {
    const bool map = (index & 0xFFF0) == 0x1600 || (index & 0xFFF0) == 0x1A00;
    if (!map) return true;
    return (value(index - 0x200, 1) & 0x80000000U) != 0 && (subindex == 0 || value(index, 0) == 0);
  }
  static void put(std::array<std::uint8_t, 8>& answer, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) answer[4 + i] = static_cast<std::uint8_t>(value >> 8U * i);
  }
  static std::array<std::uint8_t, 8> abort(std::array<std::uint8_t, 8> answer, std::uint32_t code) {
    answer[0] = 0x80;
    put(answer, code);
    return answer;
  }

  std::map<std::uint32_t, Object> objects_;
};

}  // namespace pmg::test
