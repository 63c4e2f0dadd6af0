#include "ethercat/datagrams.hpp"

#include <algorithm>

namespace pmg::ethercat {

namespace {

constexpr std::size_t kDatagramHeader = 10;
constexpr std::uint16_t kMore = 0x8000, kLengthBits = 0x07FF;

void put16(std::uint8_t* to, std::uint32_t value) noexcept {
  to[0] = static_cast<std::uint8_t>(value);
  to[1] = static_cast<std::uint8_t>(value >> 8U);
}

std::uint16_t get16(const std::uint8_t* from) noexcept { return static_cast<std::uint16_t>(from[0] | from[1] << 8U); }

}  // namespace

FrameWriter::FrameWriter(std::uint8_t index) noexcept : index_(index) {
  std::fill_n(frame_.begin(), 6, std::uint8_t{0xFF});
  // The sender's address: locally administered, so that the slaves' change of it (bit 1) shows nothing new.
  constexpr std::array<std::uint8_t, 8> kRest = {0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x88, 0xA4};
  std::ranges::copy(kRest, frame_.begin() + 6);
}

bool FrameWriter::add(Command command, std::uint32_t address, std::span<const std::uint8_t> data) noexcept {
  if (data.size() > kLengthBits || size_ + kOverhead + data.size() > frame_.size()) return false;
  if (last_ != 0) put16(&frame_[last_ + 6], get16(&frame_[last_ + 6]) | kMore);
  last_ = size_;
  std::uint8_t* header = &frame_[size_];
  header[0] = static_cast<std::uint8_t>(command);
  header[1] = index_;
  put16(header + 2, address & 0xFFFFU);
  put16(header + 4, address >> 16U);
  put16(header + 6, static_cast<std::uint32_t>(data.size()));
  std::ranges::copy(data, header + kDatagramHeader);
  size_ += kOverhead + data.size();
  put16(&frame_[14], static_cast<std::uint32_t>(size_ - kHeader) | 0x1000U);
  return true;
}

FrameReader::FrameReader(std::span<const std::uint8_t> frame, std::span<const std::uint8_t> sent) noexcept {
  constexpr std::size_t kShortest = 60;  // a network card fills shorter frames up
  if (sent.size() <= FrameWriter::kHeader || frame.size() < sent.size() ||
      frame.size() > std::max(sent.size(), kShortest))
    return;
  if (!std::equal(sent.begin() + 12, sent.begin() + FrameWriter::kHeader, frame.begin() + 12)) return;
  for (std::size_t at = FrameWriter::kHeader; at + FrameWriter::kOverhead <= sent.size();) {
    const std::size_t length = get16(&sent[at + 6]) & kLengthBits;
    // Command, index, and length with its flag "more": slaves change the address of a broadcast.
    if (frame[at] != sent[at] || frame[at + 1] != sent[at + 1] ||
        ((get16(&frame[at + 6]) ^ get16(&sent[at + 6])) & (kMore | kLengthBits)) != 0)
      return;
    at += FrameWriter::kOverhead + length;
  }
  frame_ = frame.first(sent.size());
  valid_ = true;
}

bool FrameReader::next(Datagram& datagram) noexcept {
  if (!valid_ || at_ + FrameWriter::kOverhead > frame_.size()) return false;
  const std::size_t length = get16(&frame_[at_ + 6]) & kLengthBits;
  if (at_ + FrameWriter::kOverhead + length > frame_.size()) return false;
  datagram.data = frame_.subspan(at_ + kDatagramHeader, length);
  datagram.working_counter = get16(&frame_[at_ + kDatagramHeader + length]);
  at_ += FrameWriter::kOverhead + length;
  return true;
}

}  // namespace pmg::ethercat
