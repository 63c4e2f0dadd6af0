#include "ethercat/coe_dictionary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "ethercat/coe_mail.hpp"

namespace pmg::ethercat {

namespace {

constexpr std::uint16_t kReceiveMap = 0x1600, kTransmitMap = 0x1A00, kReceiveAssigned = 0x1C12,
                        kTransmitAssigned = 0x1C13;
constexpr int kOthers = 10;  // messages between request and answer: late answers, emergencies

void map(drives::ObjectDictionary& dictionary, std::uint16_t assigned, std::uint16_t pdo,
         const std::vector<drives::ObjectId>& objects) {
  const auto must_write = [&](const drives::ObjectId& id, std::uint32_t value) {
    if (!dictionary.write(id, value))
      throw std::runtime_error(
          fmt::format("has no object {}; expected a drive whose process data can be mapped", drives::to_string(id)));
  };
  must_write({assigned, 0, 1}, 0);
  must_write({pdo, 0, 1}, 0);
  std::uint8_t subindex = 0;
  for (const drives::ObjectId& object : objects)
    must_write({pdo, ++subindex, 4}, std::uint32_t{object.index} << 16U | std::uint32_t{object.subindex} << 8U |
                                         std::uint32_t{object.bytes} * 8U);
  must_write({pdo, 0, 1}, subindex);
  must_write({assigned, 1, 2}, pdo);
  must_write({assigned, 0, 1}, 1);
}

}  // namespace

// SOEM's own SDO transfers write what a slave sends in segments beyond the end of the caller's number.
std::optional<drives::canopen::SdoAnswer> CoeDictionary::ask(const drives::Message& request,
                                                             const drives::ObjectId& id) {
  ec_mbxbuft mail{};
  ecx_mbxreceive(&context_, slave_, &mail, 0);  // what is left of an earlier start
  std::uint8_t& counter = context_.slavelist[slave_].mbx_cnt;
  counter = static_cast<std::uint8_t>(counter % 7 + 1);
  std::fill(std::begin(mail), std::end(mail), std::uint8_t{0});
  std::ranges::copy(mail_with_sdo(request, counter), std::begin(mail));
  const bool sent = ecx_mbxsend(&context_, slave_, &mail, EC_TIMEOUTTXM) > 0;
  for (int k = 0; sent && k < kOthers; ++k) {
    std::fill(std::begin(mail), std::end(mail), std::uint8_t{0});
    if (ecx_mbxreceive(&context_, slave_, &mail, EC_TIMEOUTRXM) <= 0) break;
    const auto answer = sdo_in_mail(mail);
    if (!answer || answer->id.index != id.index || answer->id.subindex != id.subindex) continue;
    if (!answer->aborted) return answer;
    if (answer->value == drives::canopen::kAbortNoObject || answer->value == drives::canopen::kAbortNoSubindex)
      return std::nullopt;
    throw std::runtime_error(
        fmt::format("refuses object {} with SDO abort 0x{:08X}", drives::to_string(id), answer->value));
  }
  throw std::runtime_error(fmt::format("does not answer about object {}; expected a drive with CANopen over EtherCAT",
                                       drives::to_string(id)));
}

std::optional<std::uint32_t> CoeDictionary::read(const drives::ObjectId& id) {
  const auto answer = ask(drives::canopen::sdo_read(0, id), id);
  if (!answer) return std::nullopt;
  if (!answer->upload || !answer->expedited)
    throw std::runtime_error(fmt::format("gives no number as object {}", drives::to_string(id)));
  return answer->value;
}

bool CoeDictionary::write(const drives::ObjectId& id, std::uint32_t value) {
  return ask(drives::canopen::sdo_write(0, id, value), id).has_value();
}

void map_process_data(drives::ObjectDictionary& dictionary, const drives::Cia402Settings& settings) {
  namespace object = drives::object;
  map(dictionary, kReceiveAssigned, kReceiveMap,
      {object::kControlWord, object::kTargetPosition, object::kTargetTorque});
  std::vector<drives::ObjectId> inputs = {object::kStatusWord, object::kPosition, object::kTorque, object::kVelocity,
                                          object::kErrorCode};
  if (settings.temperature_index != 0) inputs.push_back({settings.temperature_index, settings.temperature_subindex, 2});
  map(dictionary, kTransmitAssigned, kTransmitMap, inputs);
}

}  // namespace pmg::ethercat
