#include "ethercat/coe_mail.hpp"

#include <algorithm>

namespace pmg::ethercat {

namespace {
constexpr std::size_t kService = 7, kSdo = 8, kSdoBytes = 8;
constexpr std::uint8_t kCoe = 0x03, kSdoRequest = 0x20, kSdoResponse = 0x30;
}  // namespace

std::array<std::uint8_t, kMailBytes> mail_with_sdo(const drives::Message& request, std::uint8_t counter) noexcept {
  std::array<std::uint8_t, kMailBytes> mail{};
  mail[0] = 2 + kSdoBytes;
  mail[5] = static_cast<std::uint8_t>(kCoe | counter << 4U);
  mail[kService] = kSdoRequest;
  std::copy_n(request.data.begin(), kSdoBytes, mail.begin() + kSdo);
  return mail;
}

std::optional<drives::canopen::SdoAnswer> sdo_in_mail(std::span<const std::uint8_t> mail) noexcept {
  if (mail.size() < kMailBytes) return std::nullopt;
  const std::uint8_t service = mail[kService] & 0xF0U;
  const std::size_t length = static_cast<std::size_t>(mail[0] | mail[1] << 8U);
  // An abort is a request to end the transfer; some slaves send it as a response.
  if ((mail[5] & 0x0FU) != kCoe || (service != kSdoResponse && service != kSdoRequest) || length < 2 + kSdoBytes)
    return std::nullopt;
  return drives::canopen::sdo_answer(drives::Message::of(0, mail.subspan(kSdo, kSdoBytes)));
}

}  // namespace pmg::ethercat
