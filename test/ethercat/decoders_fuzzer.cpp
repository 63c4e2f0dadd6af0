// libFuzzer's entry: any bytes for each decoder of the cable by itself, without a cable: frames of the bus cycle,
// blocks of a bridge, a drive's and an IMU's inputs, mailboxes. decoding_fuzzer.cpp has them in their places, with the
// start of all slaves before each input. Nothing may crash, and what they give has the form that it should have.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "drive_protocols/canopen.hpp"
#include "ethercat/bridge_link.hpp"
#include "ethercat/coe_mail.hpp"
#include "ethercat/datagrams.hpp"
#include "ethercat/drive_link.hpp"
#include "ethercat/process_data_imu.hpp"

namespace {

using namespace pmg;

using Bytes = std::span<const std::uint8_t>;

void require(bool promise) {
  if (!promise) std::abort();
}

/// What a link gives after any inputs.
template <typename Link>
void fetch(Link& link) {
  std::array<drives::Message, 16> frames;
  while (const std::size_t count = link.receive(frames)) {
    require(count <= frames.size());
    for (const drives::Message& frame : std::span(frames).first(count)) {
      require(frame.length <= 8 && frame.id <= 0x1FFFFFFF);
      drives::canopen::sdo_answer(frame);
      drives::canopen::sender(frame);
    }
  }
}

void read_frame(Bytes input) {
  ethercat::FrameWriter sent(input[0]);
  std::size_t asked = 0;
  for (std::size_t k = 1; k < 4; ++k) {
    const std::array<std::uint8_t, 64> data{};
    const std::size_t bytes = std::min<std::size_t>(input[k] % 65, data.size());
    if (sent.add(ethercat::Command::kLogicalRead, static_cast<std::uint32_t>(k), Bytes(data).first(bytes)))
      asked += bytes;
  }
  // The frame as it went out, with the input over its end, or the input alone.
  std::vector<std::uint8_t> back(sent.bytes().begin(), sent.bytes().end());
  const Bytes rest = input.subspan(4);
  const std::size_t over = std::min(rest.size(), back.size());
  std::copy_n(rest.begin(), over, back.end() - static_cast<std::ptrdiff_t>(over));
  for (const Bytes frame : {Bytes(back), rest}) {
    ethercat::FrameReader reader(frame, sent.bytes());
    ethercat::Datagram datagram;
    std::size_t got = 0;
    while (reader.next(datagram)) got += datagram.data.size();
    require(got == (reader.valid() ? asked : 0));
  }
}

void bridge_blocks(Bytes input) {
  ethercat::BridgeLink link;
  std::vector<std::uint8_t> outputs(ethercat::block_bytes(8));
  while (!input.empty()) {
    const std::size_t bytes = std::min<std::size_t>(input[0] % 128, input.size() - 1);
    link.take(input.subspan(1, bytes));
    if ((input[0] & 0x80U) != 0) fetch(link);
    link.fill(outputs);
    input = input.subspan(1 + bytes);
  }
  fetch(link);
}

void drive_inputs(Bytes input) {
  ethercat::DriveLink link({1, 2, 126});
  const drives::Message sync = drives::canopen::sync();
  while (!input.empty()) {
    const std::size_t bytes = std::min<std::size_t>(input[0] % 32, input.size() - 1);
    if ((input[0] & 0x80U) != 0) link.send(std::span(&sync, 1));
    link.take(input[0] / 32 % 3, input.subspan(1, bytes));
    input = input.subspan(1 + bytes);
  }
  fetch(link);
}

void imu_inputs(Bytes input) {
  constexpr int kBytes = 44;
  ethercat::ProcessDataImu slave({.slave = 1,
                                  .input_bytes = kBytes,
                                  .counter_at = 0,
                                  .status_at = 2,
                                  .quaternion_at = 4,
                                  .rate_of_turn_at = 20,
                                  .acceleration_at = 32});
  for (; input.size() >= kBytes; input = input.subspan(kBytes)) {
    slave.begin_cycle();
    slave.take(input.first(kBytes));
    slave.take(input.first(input[0] % kBytes));  // too short
    if (slave.age_cycles() > 0) continue;
    const imu::MtiSample& sample = slave.sample();
    require(sample.orientation_WI.coeffs().allFinite() && sample.gyro_rad_s.allFinite() &&
            sample.acceleration_m_s2.allFinite());
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 5) return 0;
  const Bytes input(data, size);
  read_frame(input);
  bridge_blocks(input);
  drive_inputs(input);
  imu_inputs(input);
  if (const auto answer = ethercat::sdo_in_mail(input)) require(answer->id.bytes <= 4);
  return 0;
}
